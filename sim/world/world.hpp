// The simulated world: the robot, its surroundings and the engine that moves them. It has no topics, reads no files and
// no clock. Two worlds that are built from equal arguments and receive equal commands stay equal bit for bit, also if
// they are advanced alternately in one process.
#pragma once

#include <Eigen/Geometry>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "robot/robot_model.hpp"
#include "sim/scenario_loader/scenario.hpp"
#include "sim/world/contact_finder.hpp"
#include "sim/world/contact_set.hpp"
#include "sim/world/dynamics.hpp"
#include "sim/world/joint_drive.hpp"
#include "sim/world/solver_settings.hpp"
#include "sim/world/state_hash.hpp"

namespace constrictor {

/// The exact values for an inertial unit in the head. Vectors are in the head's frame.
struct ImuTruth {
  Eigen::Quaterniond q_WHead = Eigen::Quaterniond::Identity();
  Eigen::Vector3d angular_velocity_rad_s{0.0, 0.0, 0.0};
  /// [m/s²] in the head's frame, mean over the last advance(); at rest 9.81 along up_W.
  Eigen::Vector3d proper_acceleration_m_s2{0.0, 0.0, 0.0};
  Eigen::Vector3d up_W = Eigen::Vector3d::UnitZ();  ///< against gravity; not the z axis of W on a slope
};

class World {
 public:
  /// Copies its arguments. Does not throw for arguments that load_robot and load_scenario accept.
  World(const RobotModel& robot, const Scenario& scenario, const SolverSettings& settings = {});

  /// Sets the setpoints of all joints; each span has joint_count() entries. The values are clamped to the limits of the
  /// joints and stay in force until the next call. Before the first call the joints hold the angle 0 with their full
  /// torque. A torque limit of 0 relaxes a joint.
  void set_servo(std::span<const double> position_rad, std::span<const double> velocity_rad_s,
                 std::span<const double> torque_limit_nm);
  /// The same with one setpoint for each joint, which may demand a torque instead of an angle.
  void set_servo(std::span<const JointSetpoint> setpoints);
  /// Applies a force (in W) to the centre of an object during the next advance() only. Several forces add up.
  void apply_force(std::size_t object, const Eigen::Vector3d& force_n);
  /// Moves the centre of an object by `by_m` (in W) and ends its motion, as if a person put it down elsewhere.
  void move_object(std::size_t object, const Eigen::Vector2d& by_m);
  /// Integrates round(duration / step) steps, at least one. `after_step`, if it is given, is called after each of them.
  void advance(double duration_s, const std::function<void()>& after_step = {});

  [[nodiscard]] std::size_t joint_count() const { return drives_.size(); }
  [[nodiscard]] std::size_t module_count() const { return robot_.module_count; }
  [[nodiscard]] std::size_t object_count() const { return scenario_.objects.size(); }
  [[nodiscard]] double time_s() const { return static_cast<double>(steps_done_) * settings_.step_s; }

  [[nodiscard]] double joint_angle_rad(std::size_t joint) const { return drives_[joint].angle_rad(); }
  [[nodiscard]] double joint_rate_rad_s(std::size_t joint) const { return drives_[joint].rate_rad_s(); }
  /// Torque about the joint's axis on the module at the head's side, low-pass filtered with the robot's
  /// torque_filter_s.
  [[nodiscard]] double joint_torque_nm(std::size_t joint) const { return drives_[joint].torque_nm(); }
  [[nodiscard]] const JointDrive& joint(std::size_t joint) const { return drives_[joint]; }

  [[nodiscard]] Eigen::Isometry3d module_pose(std::size_t module) const;                  ///< X_WM
  [[nodiscard]] Eigen::Vector3d module_velocity_m_s(std::size_t module) const;            ///< of its centre, in W
  [[nodiscard]] Eigen::Vector3d module_angular_velocity_rad_s(std::size_t module) const;  ///< in W
  [[nodiscard]] Eigen::Isometry3d object_pose(std::size_t object) const;                  ///< X_WO
  [[nodiscard]] Eigen::Vector3d object_velocity_m_s(std::size_t object) const;            ///< of its centre, in W
  [[nodiscard]] Eigen::Vector3d object_angular_velocity_rad_s(std::size_t object) const;  ///< in W
  /// Contacts that the modules felt in the last advance(), in the order of falling force.
  [[nodiscard]] std::vector<ModuleContact> contacts() const { return contacts_.felt(); }
  /// [W] power that the contacts of the last step give to the robot and to the objects that it touches.
  [[nodiscard]] double contact_power_w() const { return contacts_.felt_power_w(*dynamics_); }
  [[nodiscard]] ImuTruth imu() const;

  /// SHA-256 chain. Each advance() appends position, quaternion (w x y z), linear and angular velocity of each module
  /// and of each object, then angle and rate of each joint.
  [[nodiscard]] const StateHash::Digest& state_hash() const { return hash_.digest(); }

  /// The whole memory of the world between two advance(), as bytes. A world that is built from equal arguments and
  /// loads them continues equally, bit for bit. contact_power_w() is 0 until the next advance().
  [[nodiscard]] std::string save() const;
  /// Throws std::runtime_error if the bytes do not belong to a world with this number of bodies and joints, or
  /// cereal::Exception if they end too early.
  void load(const std::string& bytes);

  /// The engine; for measurements.
  [[nodiscard]] const Dynamics& dynamics() const { return *dynamics_; }
  /// The robot as it is in this scene, whose mass may differ from that of the robot file.
  [[nodiscard]] const RobotModel& robot() const { return robot_; }
  [[nodiscard]] const Scenario& scenario() const { return scenario_; }

 private:
  [[nodiscard]] std::size_t object_body(std::size_t object) const { return module_count() + object; }
  void step();
  void extend_hash();
  template <class Archive>
  void serialize_rest(Archive& archive);

  RobotModel robot_;
  Scenario scenario_;
  SolverSettings settings_;
  std::unique_ptr<Dynamics> dynamics_;
  ContactFinder contact_finder_;
  ContactSet contacts_;
  std::vector<JointDrive> drives_;
  std::vector<ServoRow> rows_;
  std::vector<Eigen::Vector3d> pushes_n_;  ///< on each object during the present advance()
  std::int64_t steps_done_ = 0;
  Eigen::Vector3d acceleration_m_s2_{0.0, 0.0, 0.0};  ///< of the head in W, mean over the last advance()
  std::vector<double> hash_values_;
  StateHash hash_;
};

}  // namespace constrictor
