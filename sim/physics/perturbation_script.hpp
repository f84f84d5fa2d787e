// The scripted forces of a scenario: when each begins and ends.
#pragma once

#include <limits>
#include <vector>

#include "sim/world/world.hpp"

namespace constrictor {

class PerturbationScript {
 public:
  explicit PerturbationScript(const Scenario& scenario);

  /// Applies what acts at this time to the world's objects. Called once a tick, before World::advance.
  void apply(World& world, double time_s);

 private:
  std::vector<ScenarioPerturbation> perturbations_;
  std::vector<Eigen::Vector3d> start_m_;   ///< of each object, at the first call
  std::vector<double> began_s_;            ///< by perturbation; NaN: not yet
};

}  // namespace constrictor
