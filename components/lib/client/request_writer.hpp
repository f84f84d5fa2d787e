// The writer of the topic `request/v2`.
#pragma once

#include <cstdint>

#include "constrictor/messages.hpp"
#include "cyclone/entity.hpp"

namespace constrictor {

/// Writes requests to `input`. Its lease decides when `input` regards the source as dead:
/// - `lease_ns` > 0 and `by_hand`: the program must call assert_alive() or write() within each lease, so that a program
///   that hangs also counts as dead.
/// - `lease_ns` > 0 and not `by_hand`: DDS asserts the liveliness while the process runs.
/// - `lease_ns` 0: DDS notices the end of the process when the lease of its participant lapses.
class RequestWriter {
 public:
  RequestWriter(dds_entity_t participant, std::int64_t lease_ns, bool by_hand = true);
  void write(const msg::Request& request) const { dds::check(dds_write(writer_.get(), &request), "dds_write"); }
  void assert_alive() const { dds::check(dds_assert_liveliness(writer_.get()), "dds_assert_liveliness"); }
  /// True if the writer has discovered a reader of `request/v2`: `input`.
  [[nodiscard]] bool heard() const;
  /// Waits until the readers have acknowledged everything that was written, at most `bound_ns`.
  void flush(std::int64_t bound_ns) const { dds_wait_for_acks(writer_.get(), bound_ns); }

 private:
  dds::Entity writer_;
};

}  // namespace constrictor
