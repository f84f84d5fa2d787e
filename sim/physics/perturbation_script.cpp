#include "sim/physics/perturbation_script.hpp"

#include <cmath>

namespace constrictor {

PerturbationScript::PerturbationScript(const Scenario& scenario)
    : perturbations_(scenario.perturbations),
      began_s_(scenario.perturbations.size(), std::numeric_limits<double>::quiet_NaN()) {
  for (const ScenarioObject& object : scenario.objects) {
    start_m_.emplace_back(object.position_m.x(), object.position_m.y(), 0.0);
  }
}

void PerturbationScript::apply(World& world, double time_s) {
  for (std::size_t i = 0; i < perturbations_.size(); ++i) {
    const ScenarioPerturbation& perturbation = perturbations_[i];
    if (std::isnan(began_s_[i])) {
      const Eigen::Vector3d moved =
          world.object_pose(perturbation.object).translation() - start_m_[perturbation.object];
      const bool due = std::isnan(perturbation.at_s) ? moved.head<2>().norm() > perturbation.displaced_m
                                                     : time_s >= perturbation.at_s;
      if (due) {
        began_s_[i] = time_s;
        if (!perturbation.moved_m.isZero()) world.move_object(perturbation.object, perturbation.moved_m);
      }
    }
    // If the perturbation has not begun, its time is NaN and the comparison is false. The subtracted small time
    // prevents a rounding error from adding a tick.
    if (time_s - began_s_[i] < perturbation.duration_s - 1e-9)
      world.apply_force(perturbation.object, perturbation.force_n);
  }
}

}  // namespace constrictor
