#include "ros_bridge/velocity_pilot.hpp"

namespace constrictor::ros_bridge {
namespace {
constexpr double kAfterRefusal_s = 1.0;
constexpr double kAfterSilence_s = 0.5;
}  // namespace

void VelocityPilot::command(const Drive& drive, double now_s) {
  if (task_runs_ && !wanted_ && drive == Drive{}) return;
  commanded_s_ = now_s;
  if (drive == Drive{}) blocked_ = false;
  if (!blocked_) wanted_ = drive;
}

void VelocityPilot::authority(bool holds, bool emergency_stop, double now_s) {
  if (emergency_stop) {
    blocked_ = true;
    wanted_.reset();
    last_ = Last::kNothing;
  } else if (holds_ && !holds && asked_.kind == msg::kRequestMotion) {
    last_ = Last::kRefused;  // another source took authority: wait as after a refusal
    asked_s_ = now_s;
  }
  holds_ = holds;
}

void VelocityPilot::task(bool runs) {
  if (runs && !task_runs_) {
    wanted_.reset();
    last_ = Last::kNothing;
  }
  task_runs_ = runs;
}

void VelocityPilot::answered(bool granted) {
  if (last_ == Last::kUnanswered) last_ = granted ? Last::kGranted : Last::kRefused;
}

bool VelocityPilot::may_ask(const Ask& ask, double now_s) const {
  const bool same = ask.kind == asked_.kind && ask.drive == asked_.drive;
  switch (last_) {
    case Last::kNothing:
      return true;
    case Last::kGranted:
      return !same || (!holds_ && now_s - asked_s_ >= kAfterRefusal_s);
    case Last::kUnanswered:
      return !same || now_s - asked_s_ >= kAfterSilence_s;
    case Last::kRefused:
      return now_s - asked_s_ >= kAfterRefusal_s;
  }
  return false;
}

std::optional<VelocityPilot::Ask> VelocityPilot::next(bool connected, bool steered, double now_s) {
  if (now_s - commanded_s_ > hold_after_s_) {
    blocked_ = false;
    if (wanted_) wanted_ = holds_ ? std::optional(Drive{}) : std::nullopt;
  }
  std::optional<Ask> ask;
  if (!steered && holds_)
    ask = Ask{msg::kRequestRelease, {}};  // the writer of velocities is gone: the planner may go on
  else if (steered && wanted_) ask = Ask{msg::kRequestMotion, *wanted_};
  if (!steered) wanted_.reset();
  if (!ask || !connected || !may_ask(*ask, now_s)) return std::nullopt;
  last_ = Last::kUnanswered;
  asked_ = *ask;
  asked_s_ = now_s;
  return ask;
}

}  // namespace constrictor::ros_bridge
