// Low objects on a zone of their own colour. Object and zone are one region, which does not reach above the horizon.
#pragma once

#include <opencv2/core.hpp>

#include "perception/object_sizes.hpp"
#include "perception/regions.hpp"

namespace constrictor::perception {

/// Finds low objects of known size (`sizes`) that stand on a zone of the same colour. Moves each of them from the
/// region of the zone into a separate region, which is marked as `low` and `on_zone`. Such an object hides the far rim
/// of the zone: the columns in which it rises above the rim are together as wide as the object. `rgb` is the smoothed
/// image.
void split_objects_from_zones(const cv::Mat& rgb, const GroundCamera& camera, const PerceptionConfig& config,
                              const ObjectSizes& sizes, Regions& regions);

}  // namespace constrictor::perception
