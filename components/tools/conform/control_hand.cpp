#include "conform/control_hand.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "constrictor/text.hpp"

namespace constrictor::conform {
namespace {

constexpr std::int64_t kSlowTopics_ticks = 5;

}  // namespace

ControlHand::ControlHand(PartPort& port, const RobotModel& robot) : port_(port), robot_(robot) {
  measured_rad_ = posture(0.2);
  velocity_rad_s_.resize(measured_rad_.size());
  shown_rad_ = measured_rad_;
  authority.level = msg::kAuthorityPlanner;
  set_text(authority.source, "planner");
}

std::vector<double> ControlHand::posture(double scale_rad) const {
  std::vector<double> angles;
  for (std::size_t i = 0; i < robot_.joints.size(); ++i)
    angles.push_back(scale_rad * std::sin(1.0 + 1.7 * static_cast<double>(i)));
  return angles;
}

msg::DesiredTrajectory& ControlHand::begin(const std::string& motion) {
  desired.emplace();
  set_text(desired->motion, motion);
  desired->motion_id = ++motions_;
  return *desired;
}

void ControlHand::begin_epoch() {
  desired.reset();
  motions_ = 0;
  steps_ = 0;
  port_.begin_epoch();
}

void ControlHand::send(std::int64_t count) {
  msg::JointState joints{};
  const std::size_t joint_count = false_joint_count > 0 ? false_joint_count : measured_rad_.size();
  joints.joint_count = static_cast<std::uint16_t>(joint_count);
  for (std::size_t i = 0; i < std::min(joint_count, measured_rad_.size()); ++i) {
    joints.position_rad[i] = measured_rad_[i];
    joints.velocity_rad_s[i] = velocity_rad_s_[i];
  }
  port_.send(topics::kJointState, joints);
  msg::ContactState contacts{};
  contacts.module_count = static_cast<std::uint16_t>(robot_.module_count);
  port_.send(topics::kContactState, contacts);
  msg::ImuState imu{};
  imu.orientation.w = 1.0;
  imu.linear_acceleration_m_s2.z = 9.81;
  port_.send(topics::kImuState, imu);
  port_.send(topics::kRobotPose, msg::RobotPose{});
  if (desired) port_.send(topics::kDesiredTrajectory, *desired);
  if (count % kSlowTopics_ticks != 0) return;
  // More often than `input` writes it, so that a change needs no message of its own.
  port_.send(topics::kAuthority, authority);
  port_.send(topics::kFieldMap, msg::FieldMap{});
  port_.send(topics::kLinePercept, msg::LinePercept{});
  port_.send(topics::kObjectPercepts, msg::ObjectPercepts{});
}

std::vector<ControlStep> ControlHand::run(double seconds) {
  std::vector<ControlStep> steps;
  const auto ticks = std::max(1L, std::lround(seconds / kTick_s));
  for (long i = 0; i < ticks; ++i) {
    send(steps_++);
    const std::vector<double> shown_rad = measured_rad_;
    port_.advance();
    ControlStep step;
    step.tick = port_.tick();
    // The messages that are visible now were written in the previous tick.
    step.measured_rad = std::exchange(shown_rad_, shown_rad);
    for (const auto* command : port_.written(topics::kJointCommand)) step.commands.push_back(*command);
    for (const auto* state : port_.written(topics::kMotionStatus)) step.states.push_back(*state);
    std::fill(velocity_rad_s_.begin(), velocity_rad_s_.end(), 0.0);
    if (!step.commands.empty() && !stuck && step.commands.back().mode == msg::kServoFollow) {
      const msg::JointCommand& command = step.commands.back();
      for (std::size_t j = 0; j < std::min<std::size_t>(measured_rad_.size(), command.joint_count); ++j) {
        if (command.torque_limit_nm[j] <= 0.0) continue;
        const double most_rad = robot_.joints[j].max_speed_rad_s * kTick_s;
        const double way_rad = std::clamp(command.position_rad[j] - measured_rad_[j], -most_rad, most_rad);
        measured_rad_[j] += way_rad;
        velocity_rad_s_[j] = way_rad / kTick_s;
      }
    }
    steps.push_back(std::move(step));
  }
  return steps;
}

}  // namespace constrictor::conform
