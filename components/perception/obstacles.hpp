// Obstacles: what stands on the ground and has no colour of interest, such as grey pegs and walls.
#pragma once

#include <opencv2/core.hpp>

#include "perception/few.hpp"
#include "perception/ground_camera.hpp"
#include "perception/perception_config.hpp"
#include "perception/regions.hpp"

namespace constrictor::perception {

using Obstacles = Few<Eigen::Vector2d, msg::kMaxPerceptObstacles>;

/// Points [m] of frame V at which obstacles stand on the ground, from left to right in the image; at most
/// kMaxPerceptObstacles.
///
/// Flat ground never reaches above the horizon, so that what hides the horizon stands upright. In each column of the
/// image, the shade at the horizon is followed upwards and downwards to where it changes: that is the upper edge, and
/// the foot. Sky has no upper edge, and distant ground has its "foot" at the horizon, out of range. The walk ends
/// without a foot at something coloured that stands in front, at the robot's own body, and at the border of the image.
/// `rgb`: the smoothed image.
/// Limits: an obstacle that is lower than the camera, that has the shade of the ground, or of which the border of the
/// image cuts the upper edge or the foot, is not found.
[[nodiscard]] Obstacles find_obstacles(const cv::Mat& rgb, const Regions& regions, const GroundCamera& camera,
                                       const PerceptionConfig& config);

}  // namespace constrictor::perception
