// The processed picture: what perception found, drawn over the dimmed image.
#pragma once

#include <opencv2/core.hpp>

#include "perception/ground_camera.hpp"

namespace constrictor::perception {

/// Dimmed `rgb` with the pixels of known colours, the horizon, the line's points and end, the blobs' boxes with kind and
/// range.
cv::Mat draw_percepts(const cv::Mat& rgb, const cv::Mat& labels, const GroundCamera& camera, const msg::LinePercept& line,
                      const msg::ObjectPercepts& objects);

}  // namespace constrictor::perception
