// Whether the plant has latched an emergency stop of this client, from the plant's messages.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "client/newest_epoch.hpp"
#include "constrictor/messages.hpp"
#include "constrictor/text.hpp"

namespace constrictor {

/// Pure: no DDS, no clock.
class StopTracker {
 public:
  /// Ignores messages of another run and of earlier epochs.
  void take(const msg::StopState& state) {
    const auto is = present_.take(state.header.run_id, state.header.epoch);
    if (is == NewestEpoch::Is::kOther) return;
    if (is == NewestEpoch::Is::kNew) number_.reset();
    if (asked_ && state.stopped) {
      // The plant counts each tick in which a stop arrived, also while one is in force. If nothing was known when this
      // client asked, the first message may be an old one, unless it names this client.
      const bool newer = number_ ? state.number > asked_after_ : source_ == text_of(state.source);
      latched_ = latched_ || newer;
    }
    if (!number_) asked_after_ = state.number;
    number_ = state.number;
  }
  /// To be called when this client orders a stop under this name.
  void stop_asked(const std::string& source) {
    source_ = source;
    asked_ = true;
    asked_after_ = number_.value_or(0);
    latched_ = false;
  }
  [[nodiscard]] bool stop_latched() const { return latched_; }

 private:
  NewestEpoch present_;
  std::string source_;
  std::optional<std::uint64_t> number_;  ///< of the newest message; empty before the first of the epoch
  std::uint64_t asked_after_ = 0;
  bool asked_ = false;
  bool latched_ = false;
};

}  // namespace constrictor
