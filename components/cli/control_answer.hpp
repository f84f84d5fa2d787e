// What a RunState says about a command on `run_control`, and for how long an answer is waited for. Pure.
#pragma once

#include <chrono>
#include <cstdint>
#include <string>

#include "constrictor/messages.hpp"

namespace constrictor::cli {

enum class ControlAnswer {
  kNone,       ///< it tells of another command, or of none
  kObeyed,
  kRefused,    ///< RunState.refusal says why
  kOvertaken,  ///< a later command under the same name was answered: what became of this one is not told any more
};

inline ControlAnswer answer_to(const msg::RunControl& command, const msg::RunState& state) {
  if (std::string(state.control_source) != command.source || state.control_sequence < command.sequence_number) return ControlAnswer::kNone;
  if (state.control_sequence > command.sequence_number) return ControlAnswer::kOvertaken;
  return *state.refusal ? ControlAnswer::kRefused : ControlAnswer::kObeyed;
}

/// Ends a wait. For an answer the bound is fixed: a run that goes on and does not answer never will. For ticks that were asked for it
/// counts from the newest tick that was heard of.
class WaitBound {
 public:
  using Time = std::chrono::steady_clock::time_point;
  enum class For { kAnswer, kTicks };
  WaitBound(For what, std::chrono::seconds bound, Time now) : what_(what), bound_(bound), end_(now + bound) {}
  /// A RunState arrived that tells `tick` as the next one.
  void heard(std::int64_t tick, Time now) {
    if (what_ == For::kTicks && tick != next_tick_) end_ = now + bound_;
    next_tick_ = tick;
  }
  [[nodiscard]] bool over(Time now) const { return now > end_; }
  [[nodiscard]] std::int64_t next_tick() const { return next_tick_; }  ///< -1: no RunState arrived

 private:
  For what_;
  std::chrono::seconds bound_;
  Time end_;
  std::int64_t next_tick_ = -1;
};

}  // namespace constrictor::cli
