// From regions of colour to objects and zones: bearing, range, width.
#pragma once

#include <opencv2/core.hpp>
#include <vector>

#include "perception/regions.hpp"

namespace constrictor::perception {

/// Objects and zones of `regions`, the largest first, at most msg::kMaxBlobs. `rgb` is the smoothed image: edges are
/// placed between pixels where the colour has faded by half.
///
/// A region that reaches above the horizon is an object, another is a zone, whatever its size; one region may be both (an
/// object that stands on a zone of its colour). The range follows from the lower edge by projection on the ground; from
/// the upper edge and the known height of objects where the lower one is hidden; it is NaN where neither is seen.
std::vector<msg::Blob> find_blobs(const cv::Mat& rgb, const Regions& regions, const GroundCamera& camera,
                                  const PerceptionConfig& config, std::uint8_t line_colour);

}  // namespace constrictor::perception
