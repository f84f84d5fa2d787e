// Edges of coloured regions, located between the pixels.
#pragma once

#include <cstdint>
#include <functional>
#include <opencv2/core.hpp>
#include <optional>

#include "perception/ground_camera.hpp"
#include "perception/regions.hpp"

namespace constrictor::perception {

enum class EdgeState { kNone, kSeen, kCut, kHidden };

/// The place at which a straight walk through the image leaves a region.
struct Edge {
  EdgeState state = EdgeState::kNone;
  Eigen::Vector2d pixel = Eigen::Vector2d::Zero();
};

/// Amount of `colour` in the smoothed RGB image at a point, -255 to 255: zero for any grey, linear in the mixture.
double colour_strength(const cv::Mat& rgb, std::uint8_t colour, const Eigen::Vector2d& pixel);

/// Walks from `start` in `direction` (unit vector) and finds the last pixel of region `id`, then the point around it
/// where half of the colour is left. Up to `max_gap` pixels that do not belong to the region are passed over. Cut: the
/// image ends there, or the robot's own body begins. Hidden: another standing region, or glare, begins there.
Edge find_edge(const cv::Mat& rgb, const Regions& regions, const GroundCamera& camera, std::uint8_t id,
               const Eigen::Vector2d& start, const Eigen::Vector2d& direction, double max_gap);

}  // namespace constrictor::perception
