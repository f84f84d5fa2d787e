// Finds the rotation of the camera between two images.
#pragma once

#include <Eigen/Core>
#include <opencv2/core.hpp>

#include "constrictor/messages.hpp"

namespace constrictor::conform {

struct ImageMotion {
  double angle_rad = 0.0;  ///< of the head about the axis
  double likeness = 0.0;   ///< correlation of the images after this rotation, -1 to 1
  double at_rest = 0.0;    ///< without any rotation
};

/// The rotation of the head about `axis_H`, up to `most_rad` in both directions, that explains `after` best. Grey
/// images (CV_32FC1) of the size in `info`. The upper half of the image counts twice: near objects, which are in the
/// lower half, move differently because the camera also changes its position.
[[nodiscard]] ImageMotion image_motion(const cv::Mat& before, const cv::Mat& after, const msg::CameraInfo& info,
                                       const Eigen::Vector3d& axis_H, double most_rad);

}  // namespace constrictor::conform
