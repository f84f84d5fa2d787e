// The processed image: the percepts, drawn over the dimmed camera image.
#pragma once

#include <opencv2/core.hpp>

#include "perception/ground_camera.hpp"

namespace constrictor::perception {

/// Draws into `picture` the dimmed `rgb` with the pixels of known colours, the horizon, the points and the end of the
/// line, and the boxes of the blobs with kind and range. The memory of `picture` is used again.
void draw_percepts(const cv::Mat& rgb, const cv::Mat& labels, const GroundCamera& camera, const msg::LinePercept& line,
                   const msg::ObjectPercepts& objects, cv::Mat& picture);

}  // namespace constrictor::perception
