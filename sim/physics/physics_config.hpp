// The parameters of the simulated plant: one row each. physics.yaml and the table in README.md follow from the rows.
#pragma once

#include <cmath>
#include <cstdint>
#include <vector>

#include "plant/plant_parameters.hpp"
#include "sim/world/solver_settings.hpp"

namespace constrictor {

struct PhysicsConfig : PlantParameters {
  double control_period_s = add(control_period_s, "period_s", 0.02, "s", {0.001, 0.2}, kAtStart,
                                "Length of a tick; a multiple of solver.step_s");
  SolverSettings solver{
      add(solver.engine, "solver.engine", SolverSettings{}.engine, {kEngineOde, kEngineChain},
          "Engine: `chain` solves for the robot in generalised coordinates, exactly; `ode` is ODE's QuickStep"),
      add(solver.step_s, "solver.step_s", SolverSettings{}.step_s, "s", {0.0001, 0.02}, kAtStart,
          "Step of the solver. A coarser step is faster and less exact; ode was tuned for 0.004"),
      add(solver.iterations, "solver.iterations", SolverSettings{}.iterations, "", {1, 10000}, kAtStart,
          "ode: iterations of QuickStep in a step. Fewer are faster, but the robot grasps less reliably"),
      add(solver.over_relaxation, "solver.over_relaxation", SolverSettings{}.over_relaxation, "", {0.1, 1.9}, kAtStart,
          "ode: W of QuickStep"),
      add(solver.erp, "solver.erp", SolverSettings{}.erp, "", {0.0, 1.0}, kAtStart,
          "Share of an error that a step corrects. ode: position of a hinge; chain: angle beyond its limit"),
      add(solver.cfm, "solver.cfm", SolverSettings{}.cfm, "m/(N s)", {1e-9, 0.1}, kAtStart,
          "Softness. ode: of the hinges; chain: of the stops at the limits of the joint angles"),
      add(solver.contact_stiffness_n_m, "solver.contact_stiffness_n_m", SolverSettings{}.contact_stiffness_n_m, "N/m",
          {100.0, 1e9}, Changes::kAtStart, "Stiffness of each contact"),
      add(solver.contact_damping_n_s_m, "solver.contact_damping_n_s_m", SolverSettings{}.contact_damping_n_s_m, "N s/m",
          {0.0, 1e6}, Changes::kAtStart, "Damping of each contact"),
      add(solver.creep_resistance_n_s_m, "solver.creep_resistance_n_s_m", SolverSettings{}.creep_resistance_n_s_m,
          "N s/m", {100.0, 1e9}, Changes::kAtStart,
          "chain: a force F that friction can hold lets the body creep at F / (value of this parameter)"),
      add(solver.surface_layer_m, "solver.surface_layer_m", SolverSettings{}.surface_layer_m, "m", {0.0, 0.01},
          kAtStart, "Depth at which contacts may rest without correction"),
      add(solver.max_correcting_velocity_m_s, "solver.max_correcting_velocity_m_s",
          SolverSettings{}.max_correcting_velocity_m_s, "m/s", {0.001, 1000.0}, kAtStart,
          "Greatest velocity at which bodies that overlap leave each other"),
      add(solver.one_ground_contact_a_joint, "solver.one_ground_contact_a_joint",
          SolverSettings{}.one_ground_contact_a_joint,
          "true: at a joint only the module behind it touches the ground, to save CPU time (see README.md)"),
      add(solver.elliptic_friction, "solver.elliptic_friction", SolverSettings{}.elliptic_friction,
          "chain: true: an ellipse bounds the skin's friction along and across, as of scales; false: a rectangle, as "
          "of "
          "wheels")};
  GateLimits command = add_gate_limits(command);
  std::vector<double> stop_at_ticks =
      add(stop_at_ticks, "stop_at_ticks", {}, "ticks", {1, 1e9}, {0, 64},
          "Ticks of emergency stops, in rising order, to repeat the stops of a run (emergency_stop/state)");

  [[nodiscard]] std::int64_t period_ns() const { return std::llround(control_period_s * 1e9); }
  /// [s] the period of the run's ticks: `period_s` rounded to whole nanoseconds.
  [[nodiscard]] double period_s() const { return static_cast<double>(period_ns()) * 1e-9; }

  [[nodiscard]] std::vector<std::int64_t> stop_ticks() const { return {stop_at_ticks.begin(), stop_at_ticks.end()}; }

  /// Checks that a tick is a whole number of solver steps; otherwise the world's time would drift from that of the
  /// ticks. Also checks that stop_at_ticks are whole numbers in rising order, and that the engine has the law of
  /// friction. Throws ConfigurationError.
  void complete(const Configuration& root) const {
    for (std::size_t i = 0; i < stop_at_ticks.size(); ++i) {
      if (stop_at_ticks[i] != std::floor(stop_at_ticks[i]) || (i > 0 && stop_at_ticks[i] <= stop_at_ticks[i - 1]))
        throw root.error("stop_at_ticks",
                         "found numbers that are not whole, or not in rising order, accepted whole ticks in rising "
                         "order");
    }
    if (solver.elliptic_friction && solver.engine == kEngineOde)
      throw root.error("solver.elliptic_friction",
                       "found true with the engine ode, accepted only with chain: ode bounds friction by a rectangle");
    const double steps = control_period_s / solver.step_s;
    if (steps >= 0.5 && std::abs(steps - std::round(steps)) <= 1e-6) return;
    throw root.error("period_s", "found a period that is no multiple of solver.step_s, accepted a multiple");
  }
};

}  // namespace constrictor
