// Matrices of the camera and of the light, into OpenGL's clip space. The first row of the framebuffer is the top of the
// image.
#pragma once

#include <Eigen/Core>

#include "sim/render/renderer.hpp"
#include "sim/render/scene.hpp"

namespace constrictor {

/// Clip space from the world for a pin-hole camera. Because the first row of the framebuffer is the top of the image,
/// front faces appear clockwise.
Eigen::Matrix4f clip_from_world(const PinholeCamera& camera, double near_m, double far_m);

/// Orthographic clip space of the light that covers the region. It moves in whole texels, so that shadows do not
/// shimmer.
Eigen::Matrix4f shadow_from_world(const Eigen::Vector3d& to_light, const ShadowRegion& region, int map_size);

}  // namespace constrictor
