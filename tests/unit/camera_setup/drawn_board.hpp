// Pictures of a chessboard, drawn ray by ray through a distorted lens: independent of OpenCV's projection.
#pragma once

#include <Eigen/Geometry>
#include <cmath>
#include <opencv2/core.hpp>
#include <vector>

#include "camera_setup/board.hpp"
#include "video/calibration.hpp"

namespace constrictor::camera_setup {

/// The direction (x, y, 1) of the ray through a pixel (centres at +0.5). Undoes the distortion by
/// repetition.
inline Eigen::Vector3d ray_of(const video::CameraCalibration& c, double u, double v) {
  const auto k = [&](std::size_t i) { return i < c.distortion.size() ? c.distortion[i] : 0.0; };
  const auto bend = [&](const Eigen::Vector2d& p) -> Eigen::Vector2d {
    const double r2 = p.squaredNorm();
    const double radial = 1.0 + k(0) * r2 + k(1) * r2 * r2 + k(4) * r2 * r2 * r2;
    return {p.x() * radial + 2 * k(2) * p.x() * p.y() + k(3) * (r2 + 2 * p.x() * p.x()),
            p.y() * radial + k(2) * (r2 + 2 * p.y() * p.y()) + 2 * k(3) * p.x() * p.y()};
  };
  const Eigen::Vector2d seen((u - c.cx) / c.fx, (v - c.cy) / c.fy);
  Eigen::Vector2d p = seen;
  for (int i = 0; i < 12; ++i) p += seen - bend(p);
  return {p.x(), p.y(), 1.0};
}

/// Draws boards for one camera. The rays, which cost the time, are computed once.
class BoardPainter {
 public:
  explicit BoardPainter(const video::CameraCalibration& camera) : width_(camera.width), height_(camera.height) {
    for (int row = 0; row < height_; ++row) {
      for (int column = 0; column < width_; ++column) {
        for (int i = 0; i < kRays * kRays; ++i) {
          const int right = i % kRays, down = i / kRays;
          rays_.push_back(ray_of(camera, column + (right + 0.5) / kRays, row + (down + 0.5) / kRays));
        }
      }
    }
  }

  /// `X_CB`: the board in the camera's frame; its origin is the first inner corner. The world around it is grey.
  [[nodiscard]] cv::Mat draw(const camera_setup::Board& board, const Eigen::Isometry3d& X_CB) const {
    cv::Mat picture(height_, width_, CV_8UC3);
    const Eigen::Isometry3d X_BC = X_CB.inverse();
    const Eigen::Matrix3d R = X_BC.linear();
    const Eigen::Vector3d p_BC = X_BC.translation();
    auto ray = rays_.begin();
    for (int row = 0; row < height_; ++row) {
      for (int column = 0; column < width_; ++column) {
        double light = 0.0;
        for (int i = 0; i < kRays * kRays; ++i) light += light_of(board, p_BC, R * *ray++);
        const auto grey = static_cast<std::uint8_t>(std::lround(light / (kRays * kRays)));
        picture.at<cv::Vec3b>(row, column) = {grey, grey, grey};
      }
    }
    return picture;
  }

 private:
  static constexpr int kRays = 2;  // in each direction of a pixel

  static double light_of(const camera_setup::Board& board, const Eigen::Vector3d& p_BC, const Eigen::Vector3d& d_B) {
    const double s = -p_BC.z() / d_B.z();
    const double x = (p_BC.x() + s * d_B.x()) / board.square_m + 1.0;
    const double y = (p_BC.y() + s * d_B.y()) / board.square_m + 1.0;
    if (s <= 0.0 || x < -0.7 || y < -0.7 || x > board.columns + 1.7 || y > board.rows + 1.7) return 150.0;
    if (x < 0.0 || y < 0.0 || x > board.columns + 1.0 || y > board.rows + 1.0) return 230.0;
    return (static_cast<int>(x) + static_cast<int>(y)) % 2 == 0 ? 25.0 : 230.0;
  }

  int width_, height_;
  std::vector<Eigen::Vector3d> rays_;
};

}  // namespace constrictor::camera_setup
