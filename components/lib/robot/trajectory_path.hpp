// The path of a desired trajectory: pieces of arcs by arc length, in the frame H of the head.
#pragma once

#include "constrictor/messages.hpp"
#include "robot/planar.hpp"

namespace constrictor {

/// Makes the path an arc of this curvature [1/m] that begins at the head, straight ahead.
void set_arc(double curvature_1_m, msg::DesiredTrajectory& desired);

/// Whether all numbers of the path are finite and its arc lengths rise from point to point.
[[nodiscard]] bool has_valid_path(const msg::DesiredTrajectory& desired);

/// Position and heading in H of the path at this arc length [m]. Before the first point, the first piece continues
/// backwards; without points, the path is the x axis of H. The path must be valid.
[[nodiscard]] PlanarPose pose_at(const msg::DesiredTrajectory& desired, double arc_m);

/// [1/m] curvature of the arc that touches the x axis of H at the head and leads to the point of the path that is
/// `lookahead_m` after its first point. For a path that is an arc from the head, this is the curvature of the arc. The
/// path must be valid. Source: R. C. Coulter, "Implementation of the pure pursuit path tracking algorithm", 1992.
[[nodiscard]] double pursuit_curvature_1_m(const msg::DesiredTrajectory& desired, double lookahead_m);

}  // namespace constrictor
