#include "conform/image_motion.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>

namespace constrictor::conform {
namespace {

constexpr int kWidth = 160;  // [pixel] at which images are compared
constexpr int kSteps = 40;   // hypotheses to each side

/// Correlation of two images where the mask is set.
double correlation(const cv::Mat& a, const cv::Mat& b, const cv::Mat& mask) {
  cv::Scalar mean_a, sd_a, mean_b, sd_b;
  cv::meanStdDev(a, mean_a, sd_a, mask);
  cv::meanStdDev(b, mean_b, sd_b, mask);
  if (sd_a[0] < 1e-6 || sd_b[0] < 1e-6) return 0.0;
  const double mean_product = cv::mean((a - mean_a[0]).mul(b - mean_b[0]), mask)[0];
  return mean_product / (sd_a[0] * sd_b[0]);
}

}  // namespace

ImageMotion image_motion(const cv::Mat& before, const cv::Mat& after, const msg::CameraInfo& info,
                         const Eigen::Vector3d& axis_H, double most_rad) {
  const double scale = static_cast<double>(kWidth) / before.cols;
  const cv::Size size(kWidth, std::max(8, static_cast<int>(std::lround(scale * before.rows))));
  cv::Mat from, to, warped;
  cv::resize(before, from, size, 0, 0, cv::INTER_AREA);
  cv::resize(after, to, size, 0, 0, cv::INTER_AREA);
  cv::GaussianBlur(from, from, {0, 0}, 1.0);
  cv::GaussianBlur(to, to, {0, 0}, 1.0);
  Eigen::Matrix3d K;
  K << scale * info.fx, 0, scale * info.cx - 0.5, 0, scale * info.fy, scale * info.cy - 0.5, 0, 0, 1;
  const auto& q = info.X_HC.orientation;
  const Eigen::Vector3d axis_C = Eigen::Quaterniond(q.w, q.x, q.y, q.z).normalized().inverse() * axis_H;
  ImageMotion best;
  best.likeness = -2.0;
  for (int i = -kSteps; i <= kSteps; ++i) {
    const double angle_rad = most_rad * i / kSteps;
    // In the view of a turning camera, a scene at rest turns the other way.
    const Eigen::Matrix3d H = K * Eigen::AngleAxisd(-angle_rad, axis_C).toRotationMatrix() * K.inverse();
    cv::Mat transform(3, 3, CV_64F), seen;
    for (int row = 0; row < 3; ++row) {
      for (int column = 0; column < 3; ++column) transform.at<double>(row, column) = H(row, column);
    }
    cv::warpPerspective(from, warped, transform, size, cv::INTER_LINEAR, cv::BORDER_CONSTANT, -1.0);
    cv::compare(warped, 0.0, seen, cv::CMP_GE);
    if (cv::countNonZero(seen) < size.area() / 5) continue;
    cv::Mat upper = cv::Mat::zeros(size, CV_8U);
    seen.rowRange(0, size.height / 2).copyTo(upper.rowRange(0, size.height / 2));
    const double whole = correlation(warped, to, seen), far = correlation(warped, to, upper);
    const double likeness = 0.5 * (whole + far);
    if (i == 0) best.at_rest = likeness;
    if (likeness <= best.likeness) continue;
    best.likeness = likeness;
    best.angle_rad = angle_rad;
  }
  return best;
}

}  // namespace constrictor::conform
