// Bearing, range and width of objects and zones, from the regions of one colour.
#pragma once

#include <opencv2/core.hpp>
#include <vector>

#include "perception/regions.hpp"

namespace constrictor::perception {

/// Objects and zones of `regions`, the largest first, at most msg::kMaxBlobs. `rgb` is the smoothed image: edges are
/// located between pixels, where half of the colour is left.
///
/// A region that reaches above the horizon is an object; every other region is a zone, whatever its size. One region
/// may be both: an object on a zone of its own colour. The range follows from the lower edge by projection onto the
/// ground. If the lower edge is hidden, it follows from the upper edge and the known height of objects. If neither edge
/// is visible, it is NaN.
std::vector<msg::Blob> find_blobs(const cv::Mat& rgb, const Regions& regions, const GroundCamera& camera,
                                  const PerceptionConfig& config, std::uint8_t line_colour);

}  // namespace constrictor::perception
