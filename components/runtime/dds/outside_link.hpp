// The topic `request` as the latch of outside requests: what anybody writes, and who of them is gone.
#pragma once

#include <cstdint>
#include <functional>
#include <string>

#include "runtime/dds/endpoint.hpp"
#include "runtime/outside_requests.hpp"

namespace constrictor::dds {

/// Topic on which operators and external planners ask.
inline constexpr const char* kRequestTopic = "request";

/// Reads `request`: reliable, keep-all, volatile, so that nobody acts on what was asked before. It accepts a writer's own
/// liveliness, whatever its kind and lease: DDS tells when the last writer of a source ended, was killed, or missed its lease.
class OutsideLink {
 public:
  OutsideLink(dds_entity_t participant, std::uint16_t robot_id);
  /// Moves what arrived into `outside`. Requests to another robot are not ours; `refused(reason)` is called for those whose
  /// values are outside their ranges.
  void take(OutsideRequests& outside, const std::function<void(const std::string&)>& refused) const;
  [[nodiscard]] dds_entity_t get() const { return reader_.get(); }

 private:
  std::uint16_t robot_id_;
  Entity reader_;
};

/// A writer of requests. With a lease > 0 its liveliness is asserted by assert_alive() or by writing (manual by topic): if that
/// stops for so long, the source counts as dead. With 0 it lives as long as the process does.
class RequestWriter {
 public:
  RequestWriter(dds_entity_t participant, std::int64_t lease_ns);
  void write(const msg::Request& request) const { check(dds_write(writer_.get(), &request), "dds_write"); }
  void assert_alive() const { check(dds_assert_liveliness(writer_.get()), "dds_assert_liveliness"); }
  /// True if somebody (`input`) reads what is written.
  [[nodiscard]] bool heard() const;
  /// Waits until what was written has been received, at most so long.
  void flush(std::int64_t bound_ns) const { dds_wait_for_acks(writer_.get(), bound_ns); }

 private:
  Entity writer_;
};

}  // namespace constrictor::dds
