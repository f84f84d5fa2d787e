// Matrices of the camera and of the light. Clip space is OpenGL's; rows of the framebuffer run from the image's top.
#pragma once

#include <Eigen/Core>

#include "sim/render/renderer.hpp"
#include "sim/render/scene.hpp"

namespace constrictor {

/// Clip space from the world for a pin-hole camera. Window row 0 is the image's first row, so front faces appear clockwise.
Eigen::Matrix4f clip_from_world(const PinholeCamera& camera, double near_m, double far_m);

/// Orthographic light space that covers the region; it moves in whole texels, so that shadows do not shimmer.
Eigen::Matrix4f shadow_from_world(const Eigen::Vector3d& to_light, const ShadowRegion& region, int map_size);

}  // namespace constrictor
