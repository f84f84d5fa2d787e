// How ODE's QuickStep is run. The defaults are the ones with which the whole task was studied.
#pragma once

#include <cstdint>

namespace constrictor {

struct SolverSettings {
  double step_s = 0.002;
  int iterations = 50;
  double over_relaxation = 1.3;             ///< QuickStep's W
  double erp = 0.2;                         ///< share of a joint's error corrected in a step
  double cfm = 1e-5;                        ///< [m/(N s) or rad/(Nm s)] softness of joints
  double contact_erp = 0.2;
  double contact_cfm = 1e-5;
  double surface_layer_m = 0.001;           ///< depth to which contacts may rest without correction
  double max_correcting_velocity_m_s = 1.0;
  /// Neighbouring modules' caps coincide at their joint. True: only the front one touches the ground there, a third faster.
  bool one_ground_contact_a_joint = false;
  std::uint32_t reorder_seed = 1;           ///< of QuickStep's random reordering of constraints
};

}  // namespace constrictor
