#include "sim/physics/physics_config.hpp"

#include <cmath>

#include "configuration/configuration.hpp"

namespace constrictor {

PhysicsConfig load_physics_config(const std::filesystem::path& file) {
  Configuration root = Configuration::load(file);
  PhysicsConfig config;
  const double period_s = root.number("period_s", {0.001, 0.2});
  config.period_ns = std::llround(period_s * 1e9);

  Configuration solver = root.section("solver");
  SolverSettings& settings = config.solver;
  settings.step_s = solver.number("step_s", {0.0001, 0.02});
  settings.iterations = static_cast<int>(solver.integer("iterations", 1, 10000));
  settings.over_relaxation = solver.number("over_relaxation", {0.1, 1.9}, settings.over_relaxation);
  settings.erp = solver.number("erp", {0.0, 1.0}, settings.erp);
  settings.cfm = solver.number("cfm", {0.0, 0.1}, settings.cfm);
  settings.contact_erp = solver.number("contact_erp", {0.0, 1.0}, settings.contact_erp);
  settings.contact_cfm = solver.number("contact_cfm", {0.0, 0.1}, settings.contact_cfm);
  settings.surface_layer_m = solver.number("surface_layer_m", {0.0, 0.01}, settings.surface_layer_m);
  settings.max_correcting_velocity_m_s =
      solver.number("max_correcting_velocity_m_s", {0.001, 1000.0}, settings.max_correcting_velocity_m_s);
  settings.one_ground_contact_a_joint =
      solver.flag("one_ground_contact_a_joint", settings.one_ground_contact_a_joint);
  solver.finish();
  // A tick is a whole number of steps: time must not drift from the ticks.
  const double steps = period_s / settings.step_s;
  if (steps < 0.5 || std::abs(steps - std::round(steps)) > 1e-6) {
    throw root.error("period_s", "found a period that is no multiple of solver.step_s, accepted a multiple");
  }

  Configuration command = root.section("command", false);
  config.command.stale_after_ticks =
      command.integer("stale_after_ticks", 1, 100000, config.command.stale_after_ticks);
  config.command.relax_after_ticks =
      command.integer("relax_after_ticks", 1, 1000000, config.command.relax_after_ticks);
  command.finish();
  root.finish();
  return config;
}

}  // namespace constrictor
