// The component: turns the desired trajectory into servo setpoints, by the method that the trajectory names.
#pragma once

#include <cereal/types/string.hpp>
#include <memory>
#include <string>
#include <vector>

#include "component/component.hpp"
#include "component/parameters.hpp"
#include "component/robot_views.hpp"
#include "control/control_method.hpp"
#include "control/moving_limits.hpp"
#include "robot/safety_gate.hpp"

namespace constrictor {

struct ControlState {
  BodyState body;
  LimiterState limiter;
  GateState gate;
  std::string method;  ///< of the present motion; empty before the first motion
  std::uint64_t motion_id = 0;
  ParameterState parameters;
  template <class Archive>
  void serialize(Archive& archive) {
    archive(body, limiter, gate, method, motion_id, parameters);
  }
};

/// Reads DesiredTrajectory and JointState, and for the methods the other senses of the robot. Publishes JointCommand
/// and MotionStatus in every tick, once a JointState of this robot has arrived. Control holds the posture before the
/// first trajectory, with a trajectory that no method accepts, and with one older than `hold_after_ticks`. It relaxes
/// the joints when the trajectory is older than `relax_after_ticks`. Every command passes the safety gate: during an
/// emergency stop, and while no source has authority after one has had it, the gate holds the posture.
class Control : public TunableComponent<ControlState, ControlConfig>, public RobotJudge {
 public:
  Control(Wiring& wiring, const Setup& setup, MethodRegistry methods = {});
  [[nodiscard]] bool has_short_steps() const override { return true; }
  void step(const Tick& tick) override;
  [[nodiscard]] CheckVerdict judge_robot() const override { return judge_joints(robot_, config_); }

 private:
  /// What control does in this tick.
  struct Choice {
    msg::DesiredTrajectory desired{};
    const ControlMethod* method = nullptr;  ///< never null
    bool known = false;                     ///< the trajectory is fresh, and its method accepts it
  };
  /// The method for the motion of the trajectory: the one that the parameters name, or undulation if that one does not
  /// accept the trajectory (a body that holds an object). Null: there is none.
  [[nodiscard]] const ControlMethod* method_for(const msg::DesiredTrajectory& desired) const;
  /// The trajectory to follow now, by the rules on age and validity, and its method.
  [[nodiscard]] Choice choose() const;
  [[nodiscard]] Perceived perceived() const;
  /// The command for the servos: `wanted` after the safety gate.
  [[nodiscard]] msg::JointCommand gated(const msg::JointCommand& wanted, const JointArray& measured_rad,
                                        const JointArray& rate_rad_s, const Tick& tick);

  RobotModel robot_;
  YawChain chain_;
  JointLimiter limiter_;
  SafetyGate gate_;
  MethodRegistry registry_;
  Latest<msg::DesiredTrajectory> trajectory_in_ = wiring_.latest(topics::kDesiredTrajectory);
  BodyView body_{wiring_};
  FieldView field_{wiring_};
  Latest<msg::Authority> authority_in_ = wiring_.latest(topics::kAuthority);
  Latest<msg::ImuState> imu_in_ = wiring_.latest(topics::kImuState);
  Output<msg::JointCommand> command_out_ = wiring_.output(topics::kJointCommand);
  Output<msg::MotionStatus> status_out_ = wiring_.output(topics::kMotionStatus);
};

ComponentFactory make_control_factory();

/// The same with additional control methods, for a program with methods of its own. The makers are called for each
/// component that the factory creates.
using MethodMaker = std::unique_ptr<ControlMethod> (*)();
ComponentFactory make_control_factory(std::vector<MethodMaker> more);

}  // namespace constrictor
