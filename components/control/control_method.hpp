// The interface of control methods. They compute joint setpoints from the desired trajectory and from the sensors.
#pragma once

#include <array>
#include <memory>
#include <string_view>
#include <vector>

#include "control/control_config.hpp"
#include "control/joint_limiter.hpp"
#include "control/motion_gait.hpp"
#include "control/yaw_chain.hpp"

namespace constrictor {

/// The state of sliding mode control between ticks. Serialisable.
struct SlidingState {
  bool started = false;
  JointArray reference_rad{};   ///< of the previous tick
  JointArray reference2_rad{};  ///< of the tick before
  JointArray rate_rad_s{};      ///< measured at the previous tick
  JointArray exerted_nm{};      ///< MethodInput::exerted_nm of the previous tick
  JointArray unknown_nm{};      ///< estimated torque of friction, gravity and whatever else the model lacks

  template <class Archive>
  void serialize(Archive& archive) {
    archive(started);
    for (JointArray* values : {&reference_rad, &reference2_rad, &rate_rad_s, &exerted_nm, &unknown_nm}) {
      for (double& value : *values) archive(value);
    }
  }
};

/// The present motion of the body. All methods share this state, so that one method continues where another one left
/// off. Serialisable.
struct BodyState {
  Wave wave;
  double frequency_hz = 0.0;
  LinkArray shape_rad{};            ///< posture, one angle for each yaw joint
  JointArray residual_rad{};        ///< remainder of an earlier posture; it is added to the setpoints and fades
  JointArray lift_rad{};            ///< part of the setpoints that raises the base of a U
  JointArray held_rad{};            ///< posture that "hold" keeps
  SlidingState sliding;             ///< begins anew when a motion starts
  std::array<double, 8> scratch{};  ///< for the method's own use; zero when a motion starts

  template <class Archive>
  void serialize(Archive& archive) {
    archive(wave.amplitude_rad, wave.wavelength_m, wave.curvature_1_m, wave.phase_rad, wave.field, frequency_hz);
    for (double& value : shape_rad) archive(value);
    for (double& value : residual_rad) archive(value);
    for (double& value : lift_rad) archive(value);
    for (double& value : held_rad) archive(value);
    archive(sliding);
    for (double& value : scratch) archive(value);
  }
};

/// The newest message of each sense, for methods that adapt to obstacles, grip or terrain. Null before the first
/// message. `header.tick` shows the age of a message.
struct Perceived {
  const msg::ContactState* contacts = nullptr;
  const msg::ImuState* imu = nullptr;
  const msg::LinePercept* line = nullptr;
  const msg::ObjectPercepts* objects = nullptr;
  const msg::RobotPose* pose = nullptr;
  const msg::FieldMap* map = nullptr;
};

/// The input of a method at each step.
struct MethodInput {
  const RobotModel& robot;
  const YawChain& chain;
  const ControlConfig& config;
  const msg::DesiredTrajectory& desired;
  const Gait& gait;                 ///< what the path and the velocity of `desired` demand of the wave
  const JointArray& measured_rad;   ///< joint positions
  const JointArray& torque_nm;      ///< joint torques
  const JointArray& commanded_rad;  ///< previous setpoints
  double dt_s;                      ///< > 0
  Perceived around{};
  JointArray rate_rad_s{};  ///< measured rates of the joints
  JointArray exerted_nm{};  ///< torques of the previous command, after the safety gate; 0 if it demanded none

  /// The same input with another gait, for a method that varies the gait of another one. `varied` must outlive it.
  [[nodiscard]] MethodInput with_gait(const Gait& varied) const {
    return {robot,     chain,         config, desired, varied,     measured_rad,
            torque_nm, commanded_rad, dt_s,   around,  rate_rad_s, exerted_nm};
  }
};

struct MethodProgress {
  bool done = false;
  double progress = 0.0;  ///< 0..1
};

/// A control method. The object itself keeps no state: whatever must survive a step is in BodyState (`scratch` is the
/// method's own part). So the method can change, and the process can restart, in the middle of a motion. Setpoints may
/// exceed the robot's limits: JointLimiter enforces them.
///
/// To add a method: write methods/NAME.cpp, which defines `std::unique_ptr<ControlMethod> make_NAME()`, and add NAME to
/// DRIVE_METHODS or OTHER_METHODS in CMakeLists.txt. A program of one's own can instead pass its methods to
/// make_control_factory.
class ControlMethod {
 public:
  virtual ~ControlMethod() = default;
  [[nodiscard]] virtual std::string_view name() const = 0;
  /// Whether the robot knows its pose while this method moves it: the odometry of guidance assumes that links slide
  /// along their axes more than across. `constrictor check` warns of a mission with a method that loses the pose.
  [[nodiscard]] virtual bool keeps_pose() const { return false; }
  /// True if the method can follow this trajectory. If it cannot, control holds the posture.
  [[nodiscard]] virtual bool accepts(const msg::DesiredTrajectory& desired, const YawChain& chain) const;
  /// Called before the first step of a motion: when motion_id or the method has changed.
  virtual void start(const MethodInput& input, BodyState& body) const;
  /// Writes the setpoints of the joints that the method moves. Before the call, `setpoints` holds the previous command
  /// and the robot's own torque limit for every joint, so that a joint that the method leaves out keeps its posture. A
  /// method that sets `torque_mode` writes a torque for every joint instead; a joint that it leaves out exerts none.
  virtual MethodProgress step(const MethodInput& input, BodyState& body, Setpoints& setpoints) const = 0;
};

/// The methods of DRIVE_METHODS and OTHER_METHODS in CMakeLists.txt.
std::vector<std::unique_ptr<ControlMethod>> built_in_methods();

/// All methods by name.
class MethodRegistry {
 public:
  /// Holds the built-in methods.
  MethodRegistry();
  /// Adds a method. It replaces an earlier one of the same name.
  void add(std::unique_ptr<ControlMethod> method);
  /// Returns null if there is no method of this name.
  [[nodiscard]] const ControlMethod* find(std::string_view name) const;
  [[nodiscard]] std::vector<std::string_view> names() const;

 private:
  std::vector<std::unique_ptr<ControlMethod>> methods_;
};

/// Moves `value` towards `target` by at most `step`.
double approach(double value, double target, double step);

}  // namespace constrictor
