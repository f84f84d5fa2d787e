// The same robot with the same commands in MuJoCo. Built only if MuJoCo is installed; no_mujoco.cpp otherwise.
#include <fmt/format.h>

#include "bench/engines/engine_run.hpp"
#include "bench/validation/checks.hpp"
#include "support/project.hpp"

namespace constrictor::validation {
namespace {

struct MujocoGround {
  const char* name;
  GroundContact contact;
  bool elliptic;  ///< compared with the simulation whose skin has an elliptic bound on its friction, as MuJoCo's has
  bool empty_required, loaded_required;
};

constexpr double kMujocoLimit = 0.1;

}  // namespace

Section check_mujoco() {
  Section section{
      "The same robot in MuJoCo",
      fmt::format("The simulation with its default settings, and MuJoCo {} with a step of 0.5 ms and 100 iterations, "
                  "receive the same commands, without feedback. Empty: undulation; loaded: the body closes around an "
                  "object of 0.4 kg and carries it. \"Rectangle\" is MuJoCo's model with the bound on the friction "
                  "that the simulation has by default. \"Lasting\" has an ellipse, and is compared with the simulation "
                  "with `solver.elliptic_friction`. So is \"exported\", the model of `constrictor robot export`, whose "
                  "modules leave the ground again and again. Torque is the root mean square of the yaw joints.",
                  mj_versionString()),
      {},
      {},
      {}};
  Table table{"Speed, torque and tracking error:",
              {"motion", "engine", "speed [m/s]", "rms torque [Nm]", "tracking error [mrad]"},
              {}};
  const RobotModel robot = load_robot(testing::robot_path("mamba"));
  const auto add_row = [&table](const char* motion, const std::string& engine, const EngineMeasurement& found) {
    table.rows.push_back(
        {motion, engine, shown(found.speed_m_s), shown(found.torque_rms_nm), shown(1e3 * found.tracking_rad)});
  };
  for (const char* motion : {"empty", "loaded"}) {
    const EngineSettings world{SolverSettings{}, {}};
    EngineSettings elliptic = world;
    elliptic.world->elliptic_friction = true;
    const EngineMeasurement usual = measure_engine(robot, motion, world);
    const EngineMeasurement on_ellipse = measure_engine(robot, motion, elliptic);
    add_row(motion, "simulation", usual);
    add_row(motion, "simulation, 0.5 ms", measure_engine(robot, motion, converged(world)));
    add_row(motion, "simulation, ellipse", on_ellipse);
    add_row(motion, "simulation, ellipse, 0.5 ms", measure_engine(robot, motion, converged(elliptic)));
    for (const auto& [name, contact, with_ellipse, empty_required, loaded_required] :
         {MujocoGround{"rectangle", GroundContact::kRectangle, false, true, true},
          MujocoGround{"lasting", GroundContact::kLasting, true, true, false},
          MujocoGround{"exported", GroundContact::kExported, true, false, false}}) {
      const bool required = motion == std::string("empty") ? empty_required : loaded_required;
      const EngineMeasurement& simulated = with_ellipse ? on_ellipse : usual;
      EngineSettings mujoco{{}, MujocoSettings{}};
      mujoco.mujoco->ground = contact;
      const EngineMeasurement other = measure_engine(robot, motion, converged(mujoco));
      add_row(motion, fmt::format("MuJoCo, {}", name), other);
      section.cases.push_back({fmt::format("{}, MuJoCo {}: speed", motion, name), "m/s", other.speed_m_s,
                               simulated.speed_m_s, kMujocoLimit, true, required});
      section.cases.push_back({fmt::format("{}, MuJoCo {}: rms torque", motion, name), "Nm", other.torque_rms_nm,
                               simulated.torque_rms_nm, kMujocoLimit, true, required});
    }
  }
  section.tables.push_back(table);
  return section;
}

}  // namespace constrictor::validation
