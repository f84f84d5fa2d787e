// The dynamics of a scene: bodies, hinges with their servos, and contacts, which one step moves on. Two engines
// implement it: OdeDynamics and ChainDynamics. They receive the same forces, servo rows and contacts, and World does
// everything else, so that an engine can be replaced by another one.
#pragma once

#include <Eigen/Geometry>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <memory>
#include <span>
#include <vector>

#include "robot/robot_model.hpp"
#include "sim/world/collision.hpp"
#include "sim/world/servo.hpp"
#include "sim/world/solver_settings.hpp"

namespace constrictor {

/// Stands in place of the number of a body for the ground or an obstacle.
inline constexpr std::size_t kFixed = std::numeric_limits<std::size_t>::max();

/// A rigid body as it is built, at rest.
struct RigidBody {
  double mass_kg = 1.0;
  Eigen::Vector3d inertia_kg_m2{1.0, 1.0, 1.0};  ///< principal moments about the centre; the axes are those of the body
  Eigen::Isometry3d X_WB = Eigen::Isometry3d::Identity();
};

/// The system that an engine simulates. The bodies have numbers: first the modules from head to tail, then the objects.
struct Mechanism {
  std::vector<RigidBody> modules;  ///< straight, all joints at the angle 0
  std::vector<JointModel> joints;  ///< joint i is between the modules i and i + 1
  double half_length_m = 0.0;      ///< from the centre of a module to each of its joints, along its x axis
  double radius_m = 0.0;           ///< of the modules, which are capsules
  std::vector<RigidBody> objects;
  Eigen::Vector3d gravity_m_s2{0.0, 0.0, -9.81};  ///< in W
};

/// A body B at the end of a step. Vectors are in W.
struct BodyMotion {
  Eigen::Vector3d position_m{0.0, 0.0, 0.0};  ///< of its centre
  Eigen::Quaterniond q_WB = Eigen::Quaterniond::Identity();
  Eigen::Matrix3d R_WB = Eigen::Matrix3d::Identity();
  Eigen::Vector3d velocity_m_s{0.0, 0.0, 0.0};  ///< of its centre
  Eigen::Vector3d angular_velocity_rad_s{0.0, 0.0, 0.0};

  [[nodiscard]] Eigen::Isometry3d pose() const;  ///< X_WB
  /// Velocity in W of the point of the body that is at `p_W`.
  [[nodiscard]] Eigen::Vector3d velocity_at(const Eigen::Vector3d& p_W) const;
};

/// Coulomb friction of a pair of bodies.
struct Friction {
  double along = 0.0;   ///< coefficient
  double across = 0.0;  ///< coefficient across `direction`; equal to `along` if the friction is isotropic
  bool isotropic = true;
  Eigen::Vector3d direction{1.0, 0.0, 0.0};  ///< direction in which `along` acts, in W, perpendicular to the normal

  static Friction equal(double coefficient) { return {coefficient, coefficient, true, Eigen::Vector3d::UnitX()}; }
};

/// A contact point between two bodies, one of which may be kFixed.
struct SolverContact {
  TouchPoint touch;  ///< its normal points into `first`
  Friction friction;
  std::size_t first = kFixed;
  std::size_t second = kFixed;
};

class Dynamics {
 public:
  Dynamics(const Mechanism& mechanism, const SolverSettings& settings);
  virtual ~Dynamics() = default;
  Dynamics(const Dynamics&) = delete;
  Dynamics& operator=(const Dynamics&) = delete;

  [[nodiscard]] std::span<const BodyMotion> bodies() const { return bodies_; }
  [[nodiscard]] const BodyMotion& body(std::size_t body) const { return bodies_[body]; }
  [[nodiscard]] double angle_rad(std::size_t joint) const { return angles_rad_[joint]; }
  [[nodiscard]] double rate_rad_s(std::size_t joint) const { return rates_rad_s_[joint]; }
  /// Torque about the joint's axis on the module at the head's side, mean over the last step.
  [[nodiscard]] double torque_nm(std::size_t joint) const { return torques_nm_[joint]; }
  /// Force in W on the first body of a contact of the last step, mean over this step.
  [[nodiscard]] const Eigen::Vector3d& contact_force_n(std::size_t contact) const { return forces_n_[contact]; }

  /// Adds a force at the centre of a body, or a torque, both in W. They act during the next step only.
  void add_force(std::size_t body, const Eigen::Vector3d& force_n) { external_[body].force_n += force_n; }
  void add_torque(std::size_t body, const Eigen::Vector3d& torque_nm) { external_[body].torque_nm += torque_nm; }
  /// Puts the centre of an object elsewhere and ends the motion of the object. `body` is not a module.
  virtual void move(std::size_t body, const Eigen::Vector3d& by_m) = 0;

  /// Integrates one step with these servo rows, one for each joint, and these contacts. Throws std::runtime_error if
  /// the engine fails.
  virtual void step(std::span<const ServoRow> rows, std::span<const SolverContact> contacts) = 0;

  /// How often, since the engine was built, a step ended before its equations were solved to the engine's tolerance. An
  /// engine without a tolerance returns 0.
  [[nodiscard]] virtual std::int64_t unsolved() const { return 0; }

  /// The whole memory between two steps. An engine that is built from equal arguments and loads it continues equally,
  /// bit for bit. The forces of the last step are not part of it.
  [[nodiscard]] virtual std::vector<double> save() const = 0;
  /// Throws std::runtime_error if the memory is not that of such an engine.
  virtual void load(std::span<const double> memory) = 0;

 protected:
  struct External {
    Eigen::Vector3d force_n{0.0, 0.0, 0.0};
    Eigen::Vector3d torque_nm{0.0, 0.0, 0.0};
  };

  [[nodiscard]] std::size_t module_count() const { return module_count_; }
  /// Throws std::runtime_error if a memory to be loaded has another size.
  static void check_size(std::size_t found, std::size_t accepted);

  SolverSettings settings_;
  std::vector<BodyMotion> bodies_;
  std::vector<double> angles_rad_;
  std::vector<double> rates_rad_s_;
  std::vector<double> torques_nm_;
  std::vector<Eigen::Vector3d> forces_n_;
  std::vector<External> external_;  ///< on each body; the engine clears it in step()

 private:
  std::size_t module_count_;
};

/// The engine that the settings name. Throws std::invalid_argument if there is none of this name.
[[nodiscard]] std::unique_ptr<Dynamics> make_dynamics(const Mechanism& mechanism, const SolverSettings& settings);

}  // namespace constrictor
