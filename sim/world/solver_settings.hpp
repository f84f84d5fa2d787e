// Settings of the simulated dynamics. The whole task was studied with these defaults; physics.yaml has the same values.
#pragma once

#include <cstdint>
#include <string>

namespace constrictor {

/// The engines that can solve for the motion in each step: OdeDynamics and ChainDynamics.
inline constexpr const char* kEngineOde = "ode";
inline constexpr const char* kEngineChain = "chain";

struct SolverSettings {
  std::string engine = kEngineChain;
  double step_s = 0.005;
  int iterations = 50;           ///< ode
  double over_relaxation = 1.7;  ///< ode: W of QuickStep, no unit
  double erp = 0.2;   ///< of a joint's position error that a step corrects; chain: only beyond a limit of the angle
  double cfm = 1e-5;  ///< [m/(N s) or rad/(Nm s)] softness of joints
  double contact_stiffness_n_m = 20000.0;
  double contact_damping_n_s_m = 50.0;
  double creep_resistance_n_s_m = 1e4;  ///< chain: friction within its bound for the velocity of creeping
  double surface_layer_m = 0.001;       ///< [m] depth at which contacts may rest without correction
  double max_correcting_velocity_m_s = 1.0;
  /// The caps of two neighbouring modules coincide at their joint. If true, only the front cap of the module behind
  /// the joint touches the ground there; a module then turns without friction, and odometry is less exact. The README
  /// of sim/physics says how much CPU time that saves.
  bool one_ground_contact_a_joint = false;
  bool elliptic_friction = false;  ///< chain: an ellipse bounds the friction of the skin; otherwise a rectangle does
  std::uint32_t reorder_seed = 1;  ///< ode: seed of QuickStep's random order of constraints
};

}  // namespace constrictor
