// Which words of `input` on `authority` are news: a restarted `input` says its last ones again, oldest first. Pure.
#pragma once

#include <cstdint>
#include <optional>
#include <tuple>

#include "cli/newest_epoch.hpp"
#include "constrictor/messages.hpp"

namespace constrictor::cli {

class AuthorityWatch {
 public:
  /// What is of another run, of an earlier epoch, or not after the newest one counts for nothing.
  void take(const msg::Authority& authority) {
    const auto is = present_.take(authority.header.run_id, authority.header.epoch);
    if (is == NewestEpoch::Is::kOther) return;
    if (is == NewestEpoch::Is::kPresent && newest_ && !(order(*newest_) < order(authority))) return;
    newest_ = authority;
    if (!stop_asked_after_) stop_asked_after_ = moment(authority);
    stop_latched_ = stop_latched_ || (authority.emergency_stop && moment(authority) > *stop_asked_after_);
  }
  [[nodiscard]] const std::optional<msg::Authority>& newest() const { return newest_; }

  /// An emergency stop is being asked for: what is known of until now, or what is heard first, cannot be the answer.
  void stop_asked() {
    stop_latched_ = false;
    stop_asked_after_.reset();
    if (newest_) stop_asked_after_ = moment(*newest_);
  }
  /// True if a word of a later tick than that said that a stop is latched.
  [[nodiscard]] bool stop_latched() const { return stop_latched_; }

 private:
  using Moment = std::tuple<std::uint32_t, std::int64_t>;
  static Moment moment(const msg::Authority& authority) { return {authority.header.epoch, authority.header.tick}; }
  /// Within an epoch. A newer incarnation may do its predecessor's last tick again.
  static std::tuple<std::int64_t, std::uint64_t, std::uint32_t> order(const msg::Authority& authority) {
    return {authority.header.tick, authority.header.sequence_number, authority.header.incarnation};
  }
  NewestEpoch present_;
  std::optional<msg::Authority> newest_;
  std::optional<Moment> stop_asked_after_;
  bool stop_latched_ = false;
};

}  // namespace constrictor::cli
