#include "video/rectifier.hpp"

#include <algorithm>
#include <opencv2/imgproc.hpp>
#include <stdexcept>
#include <utility>

namespace constrictor::video {

Eigen::Vector2d distorted(const CameraCalibration& real, const CameraCalibration& ideal, const Eigen::Vector2d& pixel) {
  const double x = (pixel.x() - ideal.cx) / ideal.fx;
  const double y = (pixel.y() - ideal.cy) / ideal.fy;
  const auto k = [&](std::size_t i) { return i < real.distortion.size() ? real.distortion[i] : 0.0; };
  const double r2 = x * x + y * y;
  const double radial = (1.0 + ((k(4) * r2 + k(1)) * r2 + k(0)) * r2) / (1.0 + ((k(7) * r2 + k(6)) * r2 + k(5)) * r2);
  const double u = x * radial + 2.0 * k(2) * x * y + k(3) * (r2 + 2.0 * x * x);
  const double v = y * radial + k(2) * (r2 + 2.0 * y * y) + 2.0 * k(3) * x * y;
  return {real.fx * u + real.cx, real.fy * v + real.cy};
}

Rectifier::Rectifier(CameraCalibration calibration, int width, int height)
    : calibration_(std::move(calibration)),
      model_(
          calibration_.scaled_to(width > 0 ? width : calibration_.width, height > 0 ? height : calibration_.height)) {
  model_.distortion.clear();
}

void Rectifier::prepare(cv::Size size) {
  const CameraCalibration real = calibration_.scaled_to(size.width, size.height);
  const bool straight = std::all_of(real.distortion.begin(), real.distortion.end(), [](double k) { return k == 0.0; });
  same_ = straight && size.width == model_.width && size.height == model_.height;
  prepared_ = size;
  if (same_) return;
  map_x_.create(model_.height, model_.width, CV_32FC1);
  map_y_.create(model_.height, model_.width, CV_32FC1);
  for (int row = 0; row < model_.height; ++row) {
    for (int column = 0; column < model_.width; ++column) {
      const Eigen::Vector2d at = distorted(real, model_, {column + 0.5, row + 0.5});
      map_x_.at<float>(row, column) = static_cast<float>(at.x() - 0.5);
      map_y_.at<float>(row, column) = static_cast<float>(at.y() - 0.5);
    }
  }
}

const cv::Mat& Rectifier::rectify(const cv::Mat& bgr) {
  if (bgr.type() != CV_8UC3) throw std::invalid_argument("found an image that has not three channels of 8 bit");
  if (!prepared_ || *prepared_ != bgr.size()) prepare(bgr.size());
  if (same_) {
    cv::cvtColor(bgr, rgb_, cv::COLOR_BGR2RGB);
  } else {
    cv::remap(bgr, moved_, map_x_, map_y_, cv::INTER_LINEAR, cv::BORDER_CONSTANT);
    cv::cvtColor(moved_, rgb_, cv::COLOR_BGR2RGB);
  }
  return rgb_;
}

}  // namespace constrictor::video
