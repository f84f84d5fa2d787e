// The project's control with the faults that controls have.
#pragma once

#include <cmath>
#include <memory>
#include <string>
#include <vector>

#include "constrictor/text.hpp"
#include "control/control.hpp"
#include "support/faulty_part.hpp"
#include "support/named_fault.hpp"

namespace constrictor::testing {

/// Each with the check of `constrictor conform control` that must name it.
inline std::vector<NamedFault> control_faults() {
  return {{"silent", "arrives", "no joint_command within 2 s"},
          {"mute", "arrives", "no motion_status"},
          {"few_joints", "joint_count", "22 joints"},
          {"skips", "every_tick", "45 commands"},
          {"straightens", "first_command", "from the measured posture"},
          {"drifts", "rests", "in the first second"},
          {"accepts_all", "unknown_motion", "accepted"},
          {"forgets_motion", "echo", "motion 0"},
          {"late", "echo", "after"},
          {"refuses_bend", "bend", "not accepted"},
          {"swapped", "order", "yaw joint 3 has the angle of yaw joint 4"},
          {"sign", "sign", "yaw joint 5 is bent the other way"},
          {"degrees", "unit", "0.02 times"},
          {"gain", "gain", "yaw joint 6 at"},
          {"ignores_shape_rate", "shape_rate", "rad/s demanded"},
          {"done_early", "done", "to go"},
          {"never_done", "done", "done is never set"},
          {"ignores_squeeze_limit", "squeeze", "6.0 Nm"},
          {"wrong_period", "period", "1.00 Hz stated"},
          {"one_speed", "speed", "at half the speed"},
          {"only_backwards", "forwards", "travels to the head"},
          {"only_forwards", "backwards", "travels to the tail"},
          {"bends_right", "curvature", "the other way"},
          {"curvature_in_degrees", "curvature", "demanded"},
          {"hides_method", "echo", "with the method ''"},
          {"keeps_torque", "relax", "keep their torque"},
          {"ignores_silence", "silence", "after the last trajectory"},
          {"relaxes_at_once", "silence", "relaxed at once"},
          {"ignores_authority", "authority", "after the source has gone"},
          {"stays_at_setpoint", "takeover", "from the measured posture"},
          {"ignores_stop", "stop", "during the stop"},
          {"counts_nothing", "wrong_joints", "nothing is counted"},
          {"ignores_limit", "position_limit", "0.4"},
          {"too_fast", "rate_limit", "of joint 6"},
          {"strong", "torque_limit", "2.00 Nm beyond"},
          {"velocity_in_degrees", "velocity", "100 %"},
          {"remembers_motion", "epoch", "goes on"},
          {"random", "repeatable", "another command"},
          {"forgets", "restart", "another command"},
          {"jumps_after_restart", "restart", "another command"}};
}

/// The fault of this name; empty: none. `memory` outlives the epochs.
inline PartFault control_fault(const std::string& name, const std::shared_ptr<std::uint64_t>& memory) {
  PartFault fault;
  const auto command = [&](auto change) { fault.writes = changing(topics::kJointCommand, change); };
  const auto state = [&](auto change) { fault.writes = changing(topics::kMotionStatus, change); };
  const auto trajectory = [&](auto change) { fault.reads = changing(topics::kDesiredTrajectory, change); };
  constexpr double kDegrees = 180.0 / M_PI;
  const auto is = [&](const char* one) { return name == one; };
  if (is("silent")) command([](msg::JointCommand&) { return false; });
  if (is("mute")) state([](msg::MotionStatus&) { return false; });
  if (is("few_joints")) command([](msg::JointCommand& c) { return (--c.joint_count, true); });
  if (is("skips")) command([n = 0](msg::JointCommand&) mutable { return ++n % 10 != 0; });
  if (is("straightens"))
    command([n = 0](msg::JointCommand& c) mutable {
      if (++n <= 10) std::fill_n(c.position_rad, c.joint_count, 0.0);
      return true;
    });
  if (is("drifts")) command([n = 0](msg::JointCommand& c) mutable { return (c.position_rad[7] += 0.001 * ++n, true); });
  if (is("accepts_all")) state([](msg::MotionStatus& s) { return (s.accepted = true); });
  if (is("forgets_motion")) state([](msg::MotionStatus& s) { return (s.motion_id = 0, true); });
  if (is("late")) fault.late_ticks = 25;
  if (is("refuses_bend"))
    state([](msg::MotionStatus& s) {
      if (text_of(s.method) == "bend") s.accepted = false;
      return true;
    });
  if (is("swapped")) trajectory([](msg::DesiredTrajectory& d) { std::swap(d.shape_rad[3], d.shape_rad[4]); });
  if (is("sign")) trajectory([](msg::DesiredTrajectory& d) { d.shape_rad[5] = -d.shape_rad[5]; });
  if (is("degrees"))
    trajectory([](msg::DesiredTrajectory& d) {
      for (double& angle : d.shape_rad) angle /= kDegrees;
    });
  if (is("gain")) trajectory([](msg::DesiredTrajectory& d) { d.shape_rad[6] *= 1.3; });
  if (is("ignores_shape_rate")) trajectory([](msg::DesiredTrajectory& d) { d.shape_rate_rad_s *= 3.0; });
  if (is("done_early")) state([](msg::MotionStatus& s) { return (s.done = true); });
  if (is("never_done")) state([](msg::MotionStatus& s) { return (s.done = false, true); });
  if (is("ignores_squeeze_limit")) trajectory([](msg::DesiredTrajectory& d) { d.torque_limit_nm = 0.0; });
  if (is("wrong_period")) state([](msg::MotionStatus& s) { return (s.period_s *= 0.5, true); });
  if (is("one_speed"))
    trajectory(
        [](msg::DesiredTrajectory& d) { d.speed_m_s = d.speed_m_s != 0.0 ? std::copysign(0.45, d.speed_m_s) : 0.0; });
  if (is("only_backwards")) trajectory([](msg::DesiredTrajectory& d) { d.speed_m_s = -std::abs(d.speed_m_s); });
  if (is("only_forwards")) trajectory([](msg::DesiredTrajectory& d) { d.speed_m_s = std::abs(d.speed_m_s); });
  if (is("bends_right")) trajectory([](msg::DesiredTrajectory& d) { d.points[0].curvature_1_m *= -1.0; });
  if (is("curvature_in_degrees")) trajectory([](msg::DesiredTrajectory& d) { d.points[0].curvature_1_m /= kDegrees; });
  if (is("hides_method"))
    state([](msg::MotionStatus& s) {
      set_text(s.method, "");
      return true;
    });
  if (is("keeps_torque"))
    command([](msg::JointCommand& c) {
      c.mode = msg::kServoFollow;
      for (int j = 0; j < c.joint_count; ++j) c.torque_limit_nm[j] = std::max(c.torque_limit_nm[j], 0.5);
      return true;
    });
  if (is("ignores_silence")) fault.never_old = true;
  if (is("relaxes_at_once")) {
    auto silent_ticks = std::make_shared<int>(0);
    fault.reads = [silent_ticks](const TopicInfo& topic, void*, std::int64_t) {
      if (topic.id == topics::kJointState.id) ++*silent_ticks;
      if (topic.id == topics::kDesiredTrajectory.id) *silent_ticks = 0;
      return true;
    };
    command([silent_ticks](msg::JointCommand& c) {
      if (*silent_ticks > 5) c.mode = msg::kServoRelaxed;
      return true;
    });
  }
  if (is("stays_at_setpoint")) {
    auto level = std::make_shared<std::uint8_t>(msg::kAuthorityPlanner);
    fault.reads = changing(topics::kAuthority, [level](const msg::Authority& read) { *level = read.level; });
    command([level, held = msg::JointCommand{}](msg::JointCommand& c) mutable {
      if (*level == msg::kAuthorityNone) held = c;
      if (*level == msg::kAuthorityOperator && held.joint_count > 0) c = held;
      return true;
    });
  }
  if (is("ignores_authority"))
    fault.reads =
        changing(topics::kAuthority, [](const msg::Authority& read) { return read.level != msg::kAuthorityNone; });
  if (is("ignores_stop"))
    fault.reads = changing(topics::kAuthority, [](const msg::Authority& read) { return !read.emergency_stop; });
  if (is("counts_nothing"))
    fault.reads = changing(topics::kJointState, [](const msg::JointState& read) { return read.joint_count == 23; });
  if (is("ignores_limit"))
    command([](msg::JointCommand& c) {
      if (std::abs(c.position_rad[6]) > 1.0) c.position_rad[6] *= 1.3;
      return true;
    });
  if (is("too_fast"))
    command([](msg::JointCommand& c) {
      if (c.position_rad[6] > 0.9) c.position_rad[6] = 1.5;
      return true;
    });
  if (is("strong"))
    command([](msg::JointCommand& c) {
      for (int j = 0; j < c.joint_count; ++j)
        if (c.torque_limit_nm[j] > 5.0) c.torque_limit_nm[j] += 2.0;
      return true;
    });
  if (is("velocity_in_degrees"))
    command([](msg::JointCommand& c) {
      for (double& rate : c.velocity_rad_s) rate *= kDegrees;
      return true;
    });
  if (is("remembers_motion"))
    state([memory](msg::MotionStatus& s) { return (s.motion_id = *memory = std::max(*memory, s.motion_id), true); });
  if (is("forgets")) fault.forgets = true;
  if (is("jumps_after_restart"))
    command([restarted = fault.restarted](msg::JointCommand& c) {
      if (*restarted) std::fill_n(c.position_rad, c.joint_count, 0.0);
      return true;
    });
  if (is("falls_silent")) command([memory](msg::JointCommand&) { return ++*memory < 300; });
  if (is("loses_its_state")) state([memory](msg::MotionStatus&) { return ++*memory < 300; });
  if (is("random"))
    command([memory](msg::JointCommand& c) {
      c.position_rad[0] += 1e-12 * static_cast<double>(++*memory);
      return true;
    });
  return fault;
}

inline ComponentFactory faulty_control(const std::string& name) {
  auto memory = std::make_shared<std::uint64_t>(0);
  return faulty(make_control_factory(), [name, memory] { return control_fault(name, memory); });
}

}  // namespace constrictor::testing
