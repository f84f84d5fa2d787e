// A physics engine that simulates the robot, and this project's engine.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <functional>
#include <optional>
#include <vector>

#include "sim/world/world.hpp"

namespace constrictor {

/// The setpoints of all joints at the end of a tick.
struct ServoCommand {
  std::vector<double> position_rad;
  std::vector<double> velocity_rad_s;
  std::vector<double> torque_limit_nm;
};

class Engine {
 public:
  virtual ~Engine() = default;
  /// Simulates one tick. `after_step` is called after each step of the solver.
  virtual void tick(const ServoCommand& command, double period_s, const std::function<void()>& after_step) = 0;
  [[nodiscard]] virtual double joint_angle_rad(std::size_t joint) const = 0;
  [[nodiscard]] virtual double step_torque_nm(std::size_t joint) const = 0;  ///< mean over the last step
  [[nodiscard]] virtual Eigen::Vector3d module_position_m(std::size_t module) const = 0;
  [[nodiscard]] virtual Eigen::Vector3d object_position_m() const = 0;  ///< only if there is an object
};

/// This project's physics: sim/world.
class WorldEngine : public Engine {
 public:
  WorldEngine(const RobotModel& robot, const SolverSettings& settings, const std::optional<ScenarioObject>& object)
      : world_(robot, scenario_of(object), settings) {}
  void tick(const ServoCommand& command, double period_s, const std::function<void()>& after_step) override {
    world_.set_servo(command.position_rad, command.velocity_rad_s, command.torque_limit_nm);
    world_.advance(period_s, after_step);
  }
  [[nodiscard]] double joint_angle_rad(std::size_t joint) const override { return world_.joint_angle_rad(joint); }
  [[nodiscard]] double step_torque_nm(std::size_t joint) const override { return world_.joint(joint).step_torque_nm(); }
  [[nodiscard]] Eigen::Vector3d module_position_m(std::size_t module) const override {
    return world_.module_pose(module).translation();
  }
  [[nodiscard]] Eigen::Vector3d object_position_m() const override { return world_.object_pose(0).translation(); }

 private:
  static Scenario scenario_of(const std::optional<ScenarioObject>& object) {
    Scenario scenario;
    if (object) scenario.objects.push_back(*object);
    return scenario;
  }
  World world_;
};

}  // namespace constrictor
