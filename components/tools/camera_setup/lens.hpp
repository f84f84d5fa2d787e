// The lens of a camera from several views of a board.
#pragma once

#include <string>
#include <vector>

#include "camera_setup/board.hpp"
#include "video/calibration.hpp"

namespace constrictor::camera_setup {

struct LensResult {
  video::CameraCalibration calibration;  ///< lens and reprojection error; its mount is the identity
  std::vector<double> view_errors_px;    ///< root mean square of each view
  std::vector<std::string> warnings;     ///< reasons to doubt the result, one line each
};

inline constexpr std::size_t kFewestViews = 6;

/// Throws std::invalid_argument if there are fewer than kFewestViews views, or if the views do not determine the lens.
[[nodiscard]] LensResult calibrate_lens(const std::vector<Corners>& views, const Board& board, cv::Size picture);

}  // namespace constrictor::camera_setup
