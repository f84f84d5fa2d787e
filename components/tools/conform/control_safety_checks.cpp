// Checks of the functions that keep the robot safe: relaxing, silence of navigation, authority, stops, joints of
// another robot, epochs.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <functional>

#include "conform/control_conformance.hpp"
#include "conform/part_restart.hpp"

namespace constrictor::conform {
namespace {

/// Whether the plant takes the torque away when it obeys this command.
bool is_relaxed(const msg::JointCommand& command) {
  if (command.mode == msg::kServoRelaxed) return true;
  return std::all_of(command.torque_limit_nm, command.torque_limit_nm + command.joint_count,
                     [](double limit_nm) { return limit_nm <= 0.0; });
}

}  // namespace

void ControlConformance::check_relax() {
  hand_.begin("relax");
  const Steps steps = go(0.5);
  const msg::MotionStatus* state = last_state(steps);
  const bool relaxed = is_relaxed(*last_command(steps));
  // A person picks the relaxed body up and bends it.
  const std::vector<double> posture_rad = hand_.posture(0.3);
  hand_.displace(posture_rad);
  previous_rad_.clear();
  go(0.2);
  hand_.stuck = true;
  hand_.begin("stand");
  const double far_rad = strayed_rad(go(0.5), posture_rad, 0.1);
  hand_.stuck = false;
  const bool accepted = state != nullptr && state->accepted;
  report_.judge("relax", !accepted || !relaxed || far_rad > profile_.posture_rad,
                !accepted  ? std::string("not accepted")
                : !relaxed ? std::string("the joints keep their torque")
                           : fmt::format("relaxed; then held {:.3f} rad from the measured posture", far_rad),
                "set the mode to relaxed, and let the setpoints follow the measured angles meanwhile");
}

void ControlConformance::check_silence() {
  travel(profile_.speed_m_s, 0.0);
  go(2.0);
  hand_.desired.reset();
  const Steps steps = go(profile_.hold_within_s + 1.0);
  const double moved = moved_rad(steps, profile_.hold_within_s);
  const bool early = is_relaxed(*last_command(steps));
  const Steps later = go(profile_.relax_within_s);
  const bool relaxed = is_relaxed(*last_command(later));
  report_.judge("silence", moved > profile_.posture_rad || early || !relaxed,
                moved > profile_.posture_rad
                    ? fmt::format("the setpoints move by {:.2f} rad, {} s after the last trajectory", moved,
                                  profile_.hold_within_s)
                : early    ? std::string("the joints are relaxed at once")
                : !relaxed ? fmt::format("the joints are not relaxed after {} s", profile_.relax_within_s)
                           : std::string("held, then relaxed"),
                "count the ticks since the newest trajectory; hold soon, relax after some seconds");
}

void ControlConformance::check_authority() {
  travel(profile_.speed_m_s, 0.0);
  go(2.0);
  hand_.authority.level = msg::kAuthorityNone;
  set_text(hand_.authority.source, "");
  const Steps steps = go(profile_.hold_within_s + 1.0);
  const double moved = moved_rad(steps, profile_.hold_within_s);
  const bool relaxed = is_relaxed(*last_command(steps));
  report_.judge("authority", moved > profile_.posture_rad || relaxed,
                relaxed ? std::string("the joints are relaxed")
                        : fmt::format("the setpoints move by {:.3f} rad, {} s after the source has gone", moved,
                                      profile_.hold_within_s),
                "hold while authority.level is none (SafetyGate of robot/safety_gate.hpp does it)");
  // The held body is bent by a load; then another source takes over.
  std::vector<double> posture_rad = hand_.measured_rad();
  for (const std::size_t joint : yaw_) posture_rad[joint] += posture_rad[joint] > 0.0 ? -0.3 : 0.3;
  hand_.stuck = true;
  hand_.displace(posture_rad);
  go(0.2);
  hand_.authority.level = msg::kAuthorityOperator;
  set_text(hand_.authority.source, "person.1");
  hand_.begin("stand");
  judges_rate_ = false;      // the setpoints jump to the measured angles
  double nearest_rad = 1e9;  // of the ticks after the takeover
  for (const auto& step : go(0.5)) nearest_rad = std::min(nearest_rad, strayed_rad({step}, posture_rad));
  const double step_rad = 4.0 * kTick_s;  // the first command may already move on
  report_.judge("takeover", nearest_rad > step_rad + profile_.posture_rad,
                fmt::format("begins {:.3f} rad from the measured posture", nearest_rad),
                "begin at the measured angles when another source takes over; a loaded joint is not at its setpoint");
  hand_.stuck = false;
  judges_rate_ = true;
  previous_rad_.clear();
}

void ControlConformance::check_stop() {
  travel(profile_.speed_m_s, 0.0);
  go(2.0);
  hand_.authority.emergency_stop = true;
  hand_.authority.level = msg::kAuthorityEmergencyStop;
  go(0.2);
  travel(2.0 * profile_.speed_m_s, 0.0);
  const Steps steps = go(profile_.hold_within_s + 1.0);
  const double moved = moved_rad(steps, profile_.hold_within_s);
  const bool relaxed = is_relaxed(*last_command(steps));
  hand_.authority.emergency_stop = false;
  hand_.authority.level = msg::kAuthorityOperator;
  previous_rad_.clear();
  go(1.0);
  const double again_rad = moved_rad(go(2.0), 0.0);
  const bool stuck = travels_ && again_rad < 0.02;
  report_.judge("stop", moved > profile_.posture_rad || relaxed || stuck,
                relaxed ? std::string("the joints are relaxed: a snake that has climbed would fall")
                : stuck ? std::string("nothing moves after the stop was cleared")
                        : fmt::format("the setpoints move by {:.3f} rad during the stop", moved),
                "hold while authority.emergency_stop is true, and obey trajectories afterwards");
}

void ControlConformance::check_wrong_joints() {
  hand_.begin("stand");
  go(1.0);
  const std::vector<double> posture_rad = hand_.measured_rad();
  const std::uint64_t before = port_.refused();
  hand_.false_joint_count = robot_.joints.size() - 1;
  const Steps wrong = go(0.6);
  hand_.false_joint_count = 0;
  const Steps again = go(kTick_s * PartPort::kStatusTicks);
  const double far_rad = std::max(strayed_rad(wrong, posture_rad), strayed_rad(again, posture_rad));
  bool sized = true;
  for (const auto& step : wrong) {
    for (const auto& command : step.commands) sized = sized && command.joint_count == robot_.joints.size();
  }
  const std::uint64_t refused = port_.refused() - before;
  report_.judge("wrong_joints", far_rad > profile_.posture_rad || !sized || refused == 0,
                !sized         ? std::string("commands of another size follow")
                : refused == 0 ? std::string("nothing is counted as refused")
                               : fmt::format("{} refused, the setpoints move by {:.3f} rad", refused, far_rad),
                "compare joint_count with the robot file, do not use such a message, and count it (count_refusal)");
}

void ControlConformance::check_epoch() {
  /// The commands of a short motion from the start of an epoch on.
  const std::vector<double> posture_rad = hand_.posture(0.25);
  const auto play = [&](const std::function<void()>& disturb) {
    hand_.begin_epoch();
    hand_.displace(posture_rad);
    previous_rad_.clear();
    Steps steps = go(0.5);
    travel(profile_.speed_m_s, 0.5 * profile_.curvature_1_m);
    for (auto& step : go(1.0)) steps.push_back(std::move(step));
    disturb();
    for (auto& step : go(1.0)) steps.push_back(std::move(step));
    return steps;
  };
  arrived_ = false;  // silence is judged here
  const Steps first = play([] {});
  const double far_rad = [&] {
    for (const auto& step : first) {
      if (!step.commands.empty()) return strayed_rad({step}, posture_rad);
    }
    return 1e9;
  }();
  const msg::MotionStatus* state = last_state(first);
  const bool remembers = state != nullptr && state->motion_id != hand_.desired->motion_id;
  const bool silent = far_rad > 1e8;
  report_.judge("epoch", silent || remembers || far_rad > profile_.posture_rad,
                silent      ? std::string("no commands in the new epoch")
                : remembers ? fmt::format("motion {} of the last epoch goes on", state->motion_id)
                            : fmt::format("the first command is {:.3f} rad from the measured posture", far_rad),
                "construct the component anew at each EpochStart");
  const auto difference = [&](const Steps& second) -> std::string {
    for (std::size_t i = 0; i < std::min(first.size(), second.size()); ++i) {
      if (first[i].commands.size() != second[i].commands.size())
        return fmt::format("another number of commands at tick {}", second[i].tick);
      if (!first[i].commands.empty() &&
          std::memcmp(first[i].commands.back().position_rad, second[i].commands.back().position_rad,
                      sizeof(double) * robot_.joints.size()) != 0)
        return fmt::format("another command at tick {}", second[i].tick);
    }
    return {};
  };
  const Repeat repeat = [&](const std::function<void()>& disturb) { return difference(play(disturb)); };
  judge_repetitions(report_, port_, repeat([] {}), repeat, fmt::format("{} ticks are equal", first.size()));
}

}  // namespace constrictor::conform
