// Low objects on a zone of their own colour. Object and zone are one region, which does not reach above the horizon.
#pragma once

#include <opencv2/core.hpp>

#include "perception/object_sizes.hpp"
#include "perception/regions.hpp"

namespace constrictor::perception {

/// Gives each low object of known size (`sizes`) that stands on a zone of its own colour a region of its own, marked as
/// `low` and `on_zone`. Such an object hides the far rim of the zone and rises above it: the columns in which it does
/// so are as wide as the object. `rgb` is the smoothed image.
void split_objects_from_zones(const cv::Mat& rgb, const GroundCamera& camera, const PerceptionConfig& config,
                              const ObjectSizes& sizes, Regions& regions);

}  // namespace constrictor::perception
