// The topic `request` as the latch of outside requests: what anybody writes, and who of them is gone.
#pragma once

#include <chrono>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <string>
#include <utility>
#include <vector>

#include "runtime/dds/endpoint.hpp"
#include "runtime/outside_requests.hpp"

namespace constrictor::dds {

/// Topic on which operators and external planners ask.
inline constexpr const char* kRequestTopic = "request";

/// Which writers that the reader of `request` has met are alive. DDS says the end of a source only if the reader has taken a
/// sample of it; a restarted process has none of those that were there before, and must follow the writers themselves.
class WriterWatch {
 public:
  /// `grace`: how long after its start a writer that was never met may still be found.
  explicit WriterWatch(std::chrono::milliseconds grace) : grace_(grace) {}
  /// From any thread: a writer came to life or ceased to.
  void note(dds_instance_handle_t writer, bool alive);
  /// Takes in what was noted.
  void catch_up(dds_entity_t reader);
  /// Its GUID; zeros if it has gone.
  [[nodiscard]] WriterId id_of(dds_entity_t reader, dds_instance_handle_t writer);
  [[nodiscard]] bool lives(dds_entity_t reader, const WriterId& writer);

 private:
  std::chrono::steady_clock::time_point since_ = std::chrono::steady_clock::now();
  std::chrono::milliseconds grace_;
  std::mutex mutex_;
  std::vector<std::pair<dds_instance_handle_t, bool>> news_;
  std::map<dds_instance_handle_t, WriterId> ids_;
  std::map<WriterId, bool> alive_;
};

/// How long after the start of `input`'s process the writer of a source that is known from before may take to be found. It is a time
/// on the wall, as leases are: deaths are latched at a tick like any word from outside.
inline constexpr std::chrono::milliseconds kWriterGrace{3000};

/// Reads `request`: reliable, keep-all, volatile, so that nobody acts on what was asked before. It accepts a writer's own
/// liveliness, whatever its kind and lease: DDS tells when the last writer of a source ended, was killed, or missed its lease.
class OutsideLink {
 public:
  OutsideLink(dds_entity_t participant, std::uint16_t robot_id, std::chrono::milliseconds grace = kWriterGrace);
  /// Lets `outside` ask which writers live; as long as this object does.
  void watch(OutsideRequests& outside) const;
  /// Moves what arrived into `outside`. Requests to another robot are not ours; `refused(reason)` is called for those whose
  /// values are outside their ranges.
  void take(OutsideRequests& outside, const std::function<void(const std::string&)>& refused) const;
  [[nodiscard]] dds_entity_t get() const { return reader_.get(); }

 private:
  std::uint16_t robot_id_;
  std::unique_ptr<WriterWatch> watch_;  // before the reader, whose listener calls it
  Entity reader_;
};

/// A writer of requests. With a lease > 0 its liveliness is asserted by assert_alive() or by writing (`by_hand`), so that a hung
/// program counts as dead too, or by DDS itself while the process runs: if that stops for so long, the source counts as dead. With 0
/// the end of the process is noticed when its participant's lease lapses.
class RequestWriter {
 public:
  RequestWriter(dds_entity_t participant, std::int64_t lease_ns, bool by_hand = true);
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
