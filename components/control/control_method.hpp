// The interface of control methods: desired trajectory and what the body feels in, joint setpoints out.
#pragma once

#include <array>
#include <memory>
#include <string_view>
#include <vector>

#include "control/control_config.hpp"
#include "control/joint_limiter.hpp"
#include "control/yaw_chain.hpp"

namespace constrictor {

/// What the body does now: the common state of all methods, so that one continues where another left off. Serialisable.
struct BodyState {
  Wave wave;
  double frequency_hz = 0.0;
  LinkArray shape_rad{};          ///< posture, by yaw joint
  JointArray residual_rad{};      ///< what is left of an earlier posture, added to the method's own; fades
  JointArray held_rad{};          ///< posture of "hold"
  std::array<double, 8> scratch{};  ///< of the present motion's method; zero when a motion starts

  template <class Archive>
  void serialize(Archive& archive) {
    archive(wave.amplitude_rad, wave.wavelength_m, wave.curvature_1_m, wave.phase_rad, wave.field, frequency_hz);
    for (double& value : shape_rad) archive(value);
    for (double& value : residual_rad) archive(value);
    for (double& value : held_rad) archive(value);
    for (double& value : scratch) archive(value);
  }
};

/// What the robot perceives, for methods that adapt to it (obstacles, grip, terrain). Newest message of each; null before the
/// first. `header.tick` tells how old it is.
struct Perceived {
  const msg::ContactState* contacts = nullptr;
  const msg::ImuState* imu = nullptr;
  const msg::LinePercept* line = nullptr;
  const msg::ObjectPercepts* objects = nullptr;
  const msg::RobotPose* pose = nullptr;
  const msg::FieldMap* map = nullptr;
};

/// What a method is given at each step.
struct MethodInput {
  const RobotModel& robot;
  const YawChain& chain;
  const ControlConfig& config;
  const msg::DesiredTrajectory& desired;
  const JointArray& measured_rad;   ///< joint positions
  const JointArray& torque_nm;      ///< joint torques
  const JointArray& commanded_rad;  ///< last setpoints
  double dt_s;                      ///< > 0
  Perceived around{};
};

struct MethodProgress {
  bool done = false;
  double progress = 0.0;  ///< 0..1
};

/// A control method. It keeps nothing itself: whatever must survive a step is in BodyState (its own part is `scratch`), so a
/// method can be changed, and a process restarted, in the middle of a motion. Setpoints need not respect the robot's limits:
/// JointLimiter sees to that. A new one is registered in method_registry.cpp, or given to make_control_factory by a program of its own.
class ControlMethod {
 public:
  virtual ~ControlMethod() = default;
  [[nodiscard]] virtual std::string_view name() const = 0;
  /// Whether the trajectory's parameters make sense to this method. One that does not is answered by holding the posture.
  [[nodiscard]] virtual bool accepts(const msg::DesiredTrajectory& desired, const YawChain& chain) const;
  /// Called at the first step of a motion (new motion_id or another method before it).
  virtual void start(const MethodInput& input, BodyState& body) const;
  /// Fills every joint of `setpoints`.
  virtual MethodProgress step(const MethodInput& input, BodyState& body, Setpoints& setpoints) const = 0;
};

/// Every method there is, by name.
class MethodRegistry {
 public:
  MethodRegistry();
  /// Adds one; of two with one name the newer counts.
  void add(std::unique_ptr<ControlMethod> method);
  /// Null if there is none of that name.
  [[nodiscard]] const ControlMethod* find(std::string_view name) const;
  [[nodiscard]] std::vector<std::string_view> names() const;

 private:
  std::vector<std::unique_ptr<ControlMethod>> methods_;
};

/// Moves `value` towards `target` by at most `step`.
double approach(double value, double target, double step);

}  // namespace constrictor
