// The perturbations of a scenario: scripted forces, and objects that are carried away.
#pragma once

#include <cereal/types/vector.hpp>
#include <limits>
#include <vector>

#include "sim/world/world.hpp"

namespace constrictor {

class PerturbationScript {
 public:
  explicit PerturbationScript(const Scenario& scenario);

  /// Applies the forces that act at this time, and moves the objects that are carried away now. Call it once a tick,
  /// before World::advance.
  void apply(World& world, double time_s);

  /// The memory of the script: when each perturbation began.
  template <class Archive>
  void serialize(Archive& archive) {
    archive(began_s_);
  }

 private:
  std::vector<ScenarioPerturbation> perturbations_;
  std::vector<Eigen::Vector3d> start_m_;  ///< position of each object at the start, in W
  std::vector<double> began_s_;           ///< [s] time at which each perturbation began; NaN: it has not begun
};

}  // namespace constrictor
