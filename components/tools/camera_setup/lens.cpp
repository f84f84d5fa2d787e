#include "camera_setup/lens.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <opencv2/calib3d.hpp>
#include <stdexcept>

namespace constrictor::camera_setup {
namespace {

constexpr double kDoubtful_px = 1.0;
constexpr double kWidestUnseen = 0.25;  // of the picture's width or height, on each side

}  // namespace

LensResult calibrate_lens(const std::vector<Corners>& views, const Board& board, cv::Size picture) {
  if (views.size() < kFewestViews)
    throw std::invalid_argument(
        fmt::format("found {} views of the board, accepted {} or more", views.size(), kFewestViews));
  const std::vector<std::vector<cv::Point3f>> points(views.size(), board.corners());
  cv::Mat matrix, distortion;
  std::vector<cv::Mat> rotations, translations;
  LensResult result;
  double error_px = 0.0;
  try {
    error_px = cv::calibrateCamera(points, views, picture, matrix, distortion, rotations, translations);
  } catch (const cv::Exception&) {
    throw std::invalid_argument("the views do not determine the lens: show the board slanted, near and far");
  }
  video::CameraCalibration& c = result.calibration;
  c.width = picture.width;
  c.height = picture.height;
  c.fx = matrix.at<double>(0, 0);
  c.fy = matrix.at<double>(1, 1);
  c.cx = matrix.at<double>(0, 2) + 0.5;  // OpenCV's pixel centres lie at whole numbers
  c.cy = matrix.at<double>(1, 2) + 0.5;
  c.distortion.assign(distortion.begin<double>(), distortion.end<double>());
  c.reprojection_error_px = error_px;
  if (!std::isfinite(error_px) || !(c.fx > 0.1 * picture.width) || !(c.fx < 100.0 * picture.width))
    throw std::invalid_argument("the views do not determine the lens: show the board slanted, near and far");
  cv::Point2d least(1e9, 1e9), most(-1e9, -1e9);
  for (std::size_t i = 0; i < views.size(); ++i) {
    Corners seen;
    cv::projectPoints(points[i], rotations[i], translations[i], matrix, distortion, seen);
    result.view_errors_px.push_back(cv::norm(seen, views[i], cv::NORM_L2) /
                                    std::sqrt(static_cast<double>(seen.size())));
    for (const cv::Point2d corner : views[i]) {
      least = {std::min(least.x, corner.x), std::min(least.y, corner.y)};
      most = {std::max(most.x, corner.x), std::max(most.y, corner.y)};
    }
  }
  if (error_px > kDoubtful_px)
    result.warnings.push_back(fmt::format(
        "the error is larger than {} pixel: is the board flat, the number of corners right, the picture sharp?",
        kDoubtful_px));
  const auto unseen = [&](double share, const char* side) {
    if (share > kWidestUnseen)
      result.warnings.push_back(
          fmt::format("no view shows the board in the {} {:.0f} % of the picture", side, 100 * share));
  };
  unseen(least.x / picture.width, "left");
  unseen(1.0 - most.x / picture.width, "right");
  unseen(least.y / picture.height, "upper");
  unseen(1.0 - most.y / picture.height, "lower");
  return result;
}

}  // namespace constrictor::camera_setup
