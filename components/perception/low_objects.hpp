// Objects that are not higher than the camera: they do not reach above the horizon, and so look like zones at first.
#pragma once

#include <opencv2/core.hpp>

#include "perception/regions.hpp"

namespace constrictor::perception {

/// Marks the regions that rise from the ground below the horizon (`Region::low`), and those of which too little is in
/// view to decide (`Region::doubtful`).
///
/// A zone is a disc on the ground. So the lowest edge of a region and its two sides determine where its farthest edge
/// must be. If the farthest edge is seen beyond, the region rises: the height follows from the difference. A region
/// that is wider than the largest object is a zone. `rgb` is the smoothed image.
void mark_low_objects(const cv::Mat& rgb, const GroundCamera& camera, const PerceptionConfig& config, Regions& regions);

}  // namespace constrictor::perception
