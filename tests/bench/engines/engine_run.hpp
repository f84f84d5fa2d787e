// What the robot does in an engine: the measurements of bench_engines, of validate_physics and of a test.
#pragma once

#include <memory>
#include <optional>
#include <string>

#include "bench/engines/engine.hpp"
#include "bench/engines/mujoco_engine.hpp"
#include "bench/engines/tasks.hpp"

namespace constrictor {

inline constexpr double kEnginePeriod_s = 0.02;  ///< of the commands

/// Exactly one of the two is set.
struct EngineSettings {
  std::optional<SolverSettings> world;
  std::optional<MujocoSettings> mujoco;
};

/// The same engine with a step of 0.5 ms, and MuJoCo with 100 iterations: finer settings hardly change the results.
[[nodiscard]] EngineSettings converged(EngineSettings settings);

[[nodiscard]] std::unique_ptr<Engine> make_engine(const RobotModel& robot, const EngineSettings& settings,
                                                  const Motion& motion);

/// `name` is `empty` or `loaded`.
[[nodiscard]] std::unique_ptr<Motion> make_motion(const std::string& name, const RobotModel& robot);

struct EngineMeasurement {
  double speed_m_s = 0.0;                  ///< way of the robot's centre, divided by the time
  double torque_rms_nm = 0.0;              ///< of the yaw joints, from the mean torques of the ticks
  double tracking_rad = 0.0;               ///< rms of setpoint minus angle of the yaw joints, at the end of each tick
  std::optional<double> object_to_base_m;  ///< loaded: distance of the object from the middle of the bend
};

[[nodiscard]] EngineMeasurement measure_engine(const RobotModel& robot, const std::string& name,
                                               const EngineSettings& settings);

}  // namespace constrictor
