// The robot in MuJoCo.
#pragma once

#include <mujoco/mujoco.h>

#include <Eigen/Core>
#include <functional>
#include <optional>
#include <vector>

#include "bench/engines/engine.hpp"
#include "robot/joint_limits.hpp"
#include "robot/robot_model.hpp"
#include "sim/scenario_loader/scenario.hpp"
#include "support/mujoco_model.hpp"

namespace constrictor {

/// How the modules touch the ground.
enum class GroundContact {
  kExported,  ///< as `constrictor robot export` writes it: MuJoCo's default softness; elliptic bound on the friction
  kLasting,   ///< springs of about 20 kN/m with less damping, so that sliding modules stay on the ground
  /// The same, and two contacts at each place: one with the friction along the module and one with that across it. The
  /// bound on the friction is then a rectangle, as in sim/world.
  kRectangle,
};

/// Names as in MuJoCo. The defaults are those of `constrictor robot export`.
struct MujocoSettings {
  double step_s = 0.002;
  int solver = mjSOL_CG;
  int iterations = 20;
  double tolerance = 1e-4;
  GroundContact ground = GroundContact::kExported;
};

/// Compiles the model that `constrictor robot export` writes. Throws std::runtime_error with MuJoCo's message.
class MujocoEngine : public Engine {
 public:
  /// Rigid joints only; the robot must have no series-elastic elements. `object`, if there is one, is a cylinder.
  MujocoEngine(const RobotModel& robot, const MujocoSettings& settings, const std::optional<ScenarioObject>& object);

  void tick(const ServoCommand& command, double period_s, const std::function<void()>& after_step) override;
  [[nodiscard]] double joint_angle_rad(std::size_t joint) const override;
  /// Torque that the gear gave to the joint in the last step, without what accelerates the rotor.
  [[nodiscard]] double step_torque_nm(std::size_t joint) const override { return step_torque_nm_[joint]; }
  [[nodiscard]] Eigen::Vector3d module_position_m(std::size_t module) const override;
  [[nodiscard]] Eigen::Vector3d object_position_m() const override;

 private:
  void stand_on_bellies();
  void step(double u0, double u1, double period_s);

  RobotModel robot_;
  MujocoSettings settings_;
  testing::MujocoModel model_;
  testing::MujocoData data_;
  std::vector<int> dof_, angle_, body_;  ///< of each joint, joint and module: indices into MuJoCo's arrays
  int object_body_ = -1;
  std::vector<JointSetpoint> from_, to_;
  std::vector<double> rate_before_;
  std::vector<double> step_torque_nm_;
};

}  // namespace constrictor
