// Control: the desired trajectory to servo setpoints, by the method that the trajectory names.
#pragma once

#include <cereal/types/string.hpp>
#include <memory>
#include <string>
#include <vector>

#include "control/control_method.hpp"
#include "robot/safety_gate.hpp"
#include "runtime/component.hpp"
#include "runtime/parameters.hpp"

namespace constrictor {

struct ControlState {
  BodyState body;
  LimiterState limiter;
  GateState gate;
  std::string method;         ///< of the present motion; empty before the first
  std::uint64_t motion_id = 0;
  ParameterState parameters;
  template <class Archive>
  void serialize(Archive& archive) {
    archive(body, limiter, gate, method, motion_id, parameters);
  }
};

/// Reads DesiredTrajectory and JointState (and for the methods what the robot perceives), writes JointCommand and MotionStatus every tick. Before the first trajectory, with one
/// that no method accepts, and with one older than `hold_after_ticks` the posture is held; older than `relax_after_ticks` the
/// joints are let go. Without a JointState of this robot it writes nothing. Every command passes the safety gate: while nobody has
/// authority after somebody had it, and during an emergency stop, the posture is held whatever the trajectory says.
class Control : public StatefulComponent<ControlState> {
 public:
  Control(Wiring& wiring, const Setup& setup, MethodRegistry methods = {});
  void step(const Tick& tick) override;

 private:
  /// The trajectory to obey now, after the rules on age and validity.
  [[nodiscard]] msg::DesiredTrajectory choose(const ControlMethod*& method, bool& known) const;
  [[nodiscard]] Perceived perceived() const;
  /// What goes to the servos of a command that control wants.
  [[nodiscard]] msg::JointCommand gated(const msg::JointCommand& wanted, const JointArray& measured_rad, const Tick& tick);

  RobotModel robot_;
  ControlConfig config_;
  Parameters parameters_;  ///< of config_
  YawChain chain_;
  JointLimiter limiter_;
  SafetyGate gate_;
  Wiring& wiring_;
  MethodRegistry registry_;
  Latest<msg::DesiredTrajectory> trajectory_in_;
  Latest<msg::JointState> joints_in_;
  Latest<msg::Authority> authority_in_;
  Latest<msg::ContactState> contacts_in_;
  Latest<msg::ImuState> imu_in_;
  Latest<msg::LinePercept> line_in_;
  Latest<msg::ObjectPercepts> objects_in_;
  Latest<msg::RobotPose> pose_in_;
  Latest<msg::FieldMap> map_in_;
  Output<msg::JointCommand> command_out_;
  Output<msg::MotionStatus> status_out_;
};

ComponentFactory make_control_factory();

/// The same with more control methods, for a program with methods of its own (`ComponentFactory` makes one component at a time, but
/// maybe several: each gets new ones).
using MethodMaker = std::unique_ptr<ControlMethod> (*)();
ComponentFactory make_control_factory(std::vector<MethodMaker> more);

}  // namespace constrictor
