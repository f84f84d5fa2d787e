// Checks of a control before it receives a trajectory that it must follow: commands in every tick, the measured
// posture, and trajectories that it must refuse.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "configuration/counted.hpp"
#include "conform/control_conformance.hpp"
#include "conform/part_restart.hpp"

namespace constrictor::conform {

std::vector<Check> control_checks() {
  return {
      {"arrives", "joint_command and motion_status begin soon after the first joint_state", {}, {}, {}},
      {"joint_count", "each command is for the joints of the robot file", {}, {}, {}},
      {"every_tick", "one joint_command and one motion_status in each tick", {}, {}, {}},
      {"first_command", "the first command is the measured posture", {}, {}, {}},
      {"rests", "the posture is held before the first trajectory", {}, {}, {}},
      {"unknown_motion", "a motion that does not exist is not accepted, and the posture is held", {}, {}, {}},
      {"wrong_posture", "a posture with too many joints is not accepted, and the posture is held", {}, {}, {}},
      {"echo", "motion_status names method and motion_id of the trajectory soon", {}, {}, {}},
      {"bend", "the motion bend is accepted", {}, {}, {}},
      {"order", "shape_rad[k] is for the k-th yaw joint from the head", {}, {}, {}},
      {"sign", "a positive angle bends the head side to the left", {}, {}, {}},
      {"unit", "angles are in radians", {}, {}, {}},
      {"gain", "the yaw joints reach shape_rad", {}, {}, {}},
      {"shape_rate", "the posture changes by shape_rate_rad_s at most", {}, {}, {}},
      {"done", "done is set when the posture is reached, and not before; progress rises from 0 to 1", {}, {}, {}},
      {"squeeze", "the base of the posture closes by squeeze_rad, with at most torque_limit_nm", {}, {}, {}},
      {"travel", "the motion travel is accepted and moves the yaw joints", {}, {}, {}},
      {"method", "motion_status names the method that moves the robot", {}, {}, {}},
      {"period", "the joints undulate once in motion_status.period_s", {}, {}, {}},
      {"speed", "a greater speed_m_s moves the joints faster", {}, {}, {}},
      {"forwards", "with a positive speed the wave travels to the tail", {}, {}, {}},
      {"backwards", "with a negative speed the wave travels to the head", {}, {}, {}},
      {"curvature", "on a path that bends to the left the body bends to the left, by the same curvature", {}, {}, {}},
      {"stand", "the motion stand keeps the posture", {}, {}, {}},
      {"relax", "the motion relax takes the torque away; the next motion begins at the measured posture", {}, {}, {}},
      {"silence", "without trajectories the posture is held, later the joints are relaxed", {}, {}, {}},
      {"authority", "the posture is held while no source has authority, after one had it", {}, {}, {}},
      {"takeover", "after a change of authority the motion begins at the measured posture", {}, {}, {}},
      {"stop", "during an emergency stop the posture is held, until the stop is cleared", {}, {}, {}},
      {"wrong_joints", "joint_state of another robot moves nothing, and is counted as refused", {}, {}, {}},
      {"position_limit", "no setpoint is beyond the joint's limits, whatever is demanded", {}, {}, {}},
      {"rate_limit", "no setpoint moves faster than its joint can", {}, {}, {}},
      {"torque_limit", "no torque limit is beyond the joint's own", {}, {}, {}},
      {"velocity", "velocity_rad_s is the rate of position_rad, or 0", {}, {}, {}},
      {"epoch", "a new epoch begins at the measured posture, without memory", {}, {}, {}},
      {"repeatable", "the same inputs give the same commands in the next epoch, bit for bit", {}, {}, {}},
      restart_check(),
  };
}

void ControlConformance::run() {
  if (!check_arrival()) {
    report_.skip_rest("control writes nothing that could be checked");
    return;
  }
  check_refusals();
  check_bend();
  check_squeeze();
  check_wave();
  check_stand();
  check_relax();
  check_silence();
  check_authority();
  check_stop();
  check_wrong_joints();
  check_limits();
  check_epoch();
}

ControlConformance::Steps ControlConformance::go(double seconds) {
  Steps steps = hand_.run(seconds);
  refuse_silence(steps);
  for (const auto& step : steps) {
    for (const auto& command : step.commands) {
      const std::size_t count = std::min<std::size_t>(command.joint_count, robot_.joints.size());
      const bool follows = previous_rad_.size() == count && command.mode == msg::kServoFollow;
      for (std::size_t j = 0; j < count; ++j) {
        const JointModel& joint = robot_.joints[j];
        const double angle_rad = command.position_rad[j];
        beyond_rad_ = std::max({beyond_rad_, angle_rad - joint.max_rad, joint.min_rad - angle_rad});
        beyond_nm_ = std::max({beyond_nm_, command.torque_limit_nm[j] - joint.max_torque_nm});
        if (!follows || !judges_rate_ || command.torque_limit_nm[j] <= 0.0) continue;
        const double rate_rad_s = (angle_rad - previous_rad_[j]) / kTick_s;
        if (std::abs(rate_rad_s) / joint.max_speed_rad_s > largest_rate_) {
          largest_rate_ = std::abs(rate_rad_s) / joint.max_speed_rad_s;
          fastest_ = j;
        }
        if (command.velocity_rad_s[j] == 0.0 || std::abs(rate_rad_s) < 0.05) continue;
        ++compared_;
        if (std::abs(command.velocity_rad_s[j] / rate_rad_s - 1.0) > 0.5) ++unlike_;
      }
      const bool relaxed = command.mode != msg::kServoFollow || (count > 0 && command.torque_limit_nm[0] <= 0.0);
      previous_rad_.clear();
      if (!relaxed) previous_rad_.assign(command.position_rad, command.position_rad + count);
    }
  }
  return steps;
}

void ControlConformance::refuse_silence(const Steps& steps) const {
  const double seconds = kTick_s * static_cast<double>(steps.size());
  if (!arrived_ || seconds < kSilence_s) return;
  const char* missing = last_command(steps) == nullptr ? "joint_command"
                        : last_state(steps) == nullptr ? "motion_status"
                                                       : nullptr;
  if (missing != nullptr)
    throw PartGone(fmt::format("control has stopped writing {}: none came for {:.1f} s", missing, seconds));
}

double ControlConformance::strayed_rad(const Steps& steps, const std::vector<double>& posture_rad, double from_s) {
  double most_rad = 0.0;
  for (std::size_t i = static_cast<std::size_t>(from_s / kTick_s); i < steps.size(); ++i) {
    for (const auto& command : steps[i].commands) {
      for (std::size_t j = 0; j < std::min<std::size_t>(command.joint_count, posture_rad.size()); ++j)
        most_rad = std::max(most_rad, std::abs(command.position_rad[j] - posture_rad[j]));
    }
  }
  return most_rad;
}

const msg::JointCommand* ControlConformance::last_command(const Steps& steps) {
  for (auto step = steps.rbegin(); step != steps.rend(); ++step) {
    if (!step->commands.empty()) return &step->commands.back();
  }
  return nullptr;
}

const msg::MotionStatus* ControlConformance::last_state(const Steps& steps) {
  for (auto step = steps.rbegin(); step != steps.rend(); ++step) {
    if (!step->states.empty()) return &step->states.back();
  }
  return nullptr;
}

double ControlConformance::moved_rad(const Steps& steps, double from_s) {
  const auto first = static_cast<std::size_t>(from_s / kTick_s);
  for (std::size_t i = first; i < steps.size(); ++i) {
    if (steps[i].commands.empty()) continue;
    const msg::JointCommand& command = steps[i].commands.front();
    return strayed_rad(steps, {command.position_rad, command.position_rad + command.joint_count}, from_s);
  }
  return 0.0;
}

bool ControlConformance::check_arrival() {
  const std::vector<double> posture_rad = hand_.measured_rad();
  hand_.stuck = true;
  Steps steps;
  const auto begun = [&] { return last_command(steps) != nullptr && last_state(steps) != nullptr; };
  for (double waited_s = 0.0; waited_s < profile_.patience_s && !begun(); waited_s += kTick_s) {
    for (auto& step : go(kTick_s)) steps.push_back(std::move(step));
  }
  const msg::JointCommand* first = last_command(steps);
  const bool arrived = begun();
  report_.judge("arrives", !arrived,
                arrived            ? "after " + counted(steps.size(), "tick")
                : first == nullptr ? fmt::format("no joint_command within {} s", profile_.patience_s)
                                   : fmt::format("no motion_status within {} s", profile_.patience_s),
                "write both in every tick from the first joint_state on; the run refuses values that are not finite or "
                "out of range, and its log names them");
  if (!arrived) return false;
  const bool right_count = first->joint_count == robot_.joints.size();
  report_.judge("joint_count", !right_count, counted(first->joint_count, "joint"),
                fmt::format("write all {} joints of the robot, the one next to the head first", robot_.joints.size()));
  if (!right_count) return false;
  const msg::JointCommand begin = *first;
  const double far_rad = strayed_rad(steps, posture_rad);

  const Steps later = go(1.0);
  std::size_t commands = 0, states = 0;
  for (const auto& step : later) {
    commands += step.commands.size();
    states += step.states.size();
  }
  report_.judge("every_tick", commands != later.size() || states != later.size(),
                fmt::format("{} commands and {} states in {} ticks", commands, states, later.size()),
                "write each topic once in every step");
  const bool follows = begin.mode == msg::kServoFollow;
  report_.judge("first_command", far_rad > profile_.posture_rad || !follows,
                follows ? fmt::format("{:.3f} rad from the measured posture", far_rad) : "the joints are relaxed",
                "begin with the angles of the first joint_state; a jump breaks gears");
  const double drift_rad = strayed_rad(later, posture_rad);
  report_.judge("rests", drift_rad > std::max(profile_.posture_rad, far_rad + 1e-6),
                fmt::format("{:.3f} rad from it in the first second", drift_rad),
                "hold the posture until a trajectory arrives");
  hand_.stuck = false;
  arrived_ = true;
  return true;
}

void ControlConformance::check_refusals() {
  const auto refuses = [&](const char* name, const char* todo) {
    const Steps before_it = go(kSilence_s);
    const msg::JointCommand* before = last_command(before_it);
    const Steps steps = go(1.0);
    const double far_rad = strayed_rad(steps, {before->position_rad, before->position_rad + before->joint_count});
    const bool accepted = last_state(steps)->accepted;
    report_.judge(name, accepted || far_rad > profile_.posture_rad,
                  accepted ? "accepted" : fmt::format("not accepted, the setpoints move by {:.3f} rad", far_rad), todo);
  };
  hand_.begin("no_such_motion");
  hand_.desired->shape_count = 1;
  hand_.desired->shape_rad[0] = 0.5;
  refuses("unknown_motion", "set motion_status.accepted to false, and hold");
  if (yaw_.size() >= msg::kMaxJoints) return report_.skip("wrong_posture", "no message can name more joints");
  hand_.begin("bend");
  hand_.desired->shape_count = static_cast<std::uint16_t>(yaw_.size() + 1);
  std::fill_n(hand_.desired->shape_rad, yaw_.size() + 1, 0.3);
  refuses("wrong_posture", "compare shape_count with the number of yaw joints");
}

}  // namespace constrictor::conform
