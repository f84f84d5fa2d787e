// Whether a camera can tell what lies flat on the ground from the ground.
#pragma once

#include <Eigen/Core>

#include "component/mission.hpp"
#include "configuration/configuration.hpp"

namespace constrictor {

/// Throws a ConfigurationError that names `ground_colour` if the line, or a zone that the mission needs, has the hue
/// and the saturation of the ground: brightness alone does not tell paint from a shadow. Objects may have them, because
/// they rise from the ground. `root`: the scenario file; `has_line`: whether the scene has a line.
void check_contrast(const Configuration& root, const Eigen::Vector3d& ground, bool has_line, const Mission& mission);

}  // namespace constrictor
