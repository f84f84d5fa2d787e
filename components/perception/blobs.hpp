// Bearing, range and width of objects and zones, from the regions of one colour.
#pragma once

#include <opencv2/core.hpp>

#include "perception/few.hpp"
#include "perception/object_sizes.hpp"
#include "perception/regions.hpp"

namespace constrictor::perception {

using Blobs = Few<msg::Blob, msg::kMaxBlobs>;

/// Objects and zones of `regions`, the largest first, at most msg::kMaxBlobs. `rgb` is the smoothed image: edges are
/// located between pixels, where half of the colour is left.
///
/// A region that reaches above the horizon, or that mark_low_objects() has marked, is an object; every other region is
/// a zone, or undecided. One region may be both: an object on a zone of its own colour. The range follows from the
/// lower edge by projection onto the ground. If the lower edge is hidden, it follows from the width, or from the upper
/// edge, of an object of the known size (`sizes`). If too little is visible, it is NaN. `measured`: what this image
/// shows of the size of objects.
[[nodiscard]] Blobs find_blobs(const cv::Mat& rgb, const Regions& regions, const GroundCamera& camera,
                               const PerceptionConfig& config, std::uint8_t line_colour, const ObjectSizes& sizes,
                               MeasuredSizes& measured);

}  // namespace constrictor::perception
