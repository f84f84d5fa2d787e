// The source that has authority, from the messages of `input`.
#pragma once

#include <cstdint>
#include <optional>
#include <tuple>

#include "client/newest_epoch.hpp"
#include "constrictor/messages.hpp"

namespace constrictor {

/// Keeps the newest Authority message. A restarted `input` publishes its last messages again, the oldest first; the
/// tracker ignores those that are not newer than the newest one. Pure: no DDS, no clock.
class AuthorityTracker {
 public:
  /// Ignores messages of another run, of an earlier epoch, and those that are not newer than the newest one.
  void take(const msg::Authority& authority) {
    const auto is = present_.take(authority.header.run_id, authority.header.epoch);
    if (is == NewestEpoch::Is::kOther) return;
    if (is == NewestEpoch::Is::kPresent && newest_ && !(order(*newest_) < order(authority))) return;
    newest_ = authority;
    if (!stop_asked_after_) stop_asked_after_ = moment(authority);
    stop_latched_ = stop_latched_ || (authority.emergency_stop && moment(authority) > *stop_asked_after_);
  }
  /// Empty before the first message.
  [[nodiscard]] const std::optional<msg::Authority>& newest() const { return newest_; }

  /// To be called when an emergency stop is requested. From then on, only a message of a later tick than the newest
  /// message can confirm the stop; if no message has arrived, only a message of a later tick than the first one.
  void stop_asked() {
    stop_latched_ = false;
    stop_asked_after_.reset();
    if (newest_) stop_asked_after_ = moment(*newest_);
  }
  /// True if such a message has reported a latched emergency stop since stop_asked().
  [[nodiscard]] bool stop_latched() const { return stop_latched_; }

 private:
  using Moment = std::tuple<std::uint32_t, std::int64_t>;
  static Moment moment(const msg::Authority& authority) { return {authority.header.epoch, authority.header.tick}; }
  /// Order within an epoch. A newer incarnation may repeat the last tick of its predecessor.
  static std::tuple<std::int64_t, std::uint64_t, std::uint32_t> order(const msg::Authority& authority) {
    return {authority.header.tick, authority.header.sequence_number, authority.header.incarnation};
  }
  NewestEpoch present_;
  std::optional<msg::Authority> newest_;
  std::optional<Moment> stop_asked_after_;
  bool stop_latched_ = false;
};

}  // namespace constrictor
