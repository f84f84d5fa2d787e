// Projection between the pixels of a pin-hole camera of the robot and the ground plane.
#pragma once

#include <Eigen/Geometry>
#include <optional>

#include "constrictor/messages.hpp"
#include "perception/own_body.hpp"

namespace constrictor::perception {

/// The head module as a capsule along its x axis: the camera sees part of it. With radius 0 it sees nothing of it.
struct HeadShape {
  double half_length_m = 0.0;  ///< of the capsule's straight part
  double radius_m = 0.0;
};

/// An error of the attitude of 2 degrees misplaces the horizon by fewer rows. What reaches farther above it is no
/// ground, and what lies farther below it is no sky.
inline constexpr int kHorizonErrorPixels = 6;

/// A pin-hole camera at a known height and attitude above flat ground. Frame G: origin on the ground below the head's
/// centre, x forward along the head's yaw, y left, z up. For a further camera, the frame V of its view takes the place
/// of G: origin on the ground below the camera, x along the direction in which it looks, y left, z up. Pixel
/// coordinates (u, v) are continuous: the centre of the first pixel is (0.5, 0.5).
class GroundCamera {
 public:
  /// `orientation`: of the head (ImuState); its yaw is ignored. `head_height_m`: height of the head's centre.
  /// `body`: the modules behind the head that may be in view.
  GroundCamera(const msg::CameraInfo& info, const msg::Quaternion& orientation, double head_height_m,
               const HeadShape& head = {}, OwnBody body = {});
  /// A further camera at X_VC, which sees the modules of `body`.
  GroundCamera(const msg::CameraInfo& info, const Eigen::Isometry3d& X_VC, OwnBody body);

  /// Direction of the ray through a pixel, in G, not normalised.
  [[nodiscard]] Eigen::Vector3d ray(double u, double v) const {
    return R_GC_ * Eigen::Vector3d((u - cx_) / fx_, (v - cy_) / fy_, 1.0);
  }

  /// Whether the robot's own head or another of its modules covers a pixel, or a place within about two pixels of it.
  [[nodiscard]] bool own_body(double u, double v) const;
  /// Whether modules other than the head may be in view, and hide one side of an object or zone.
  [[nodiscard]] bool sees_body() const { return !body_.empty(); }

  /// Ground point seen at a pixel; none at or above the horizon, or beyond `max_range_m` from the camera.
  [[nodiscard]] std::optional<Eigen::Vector2d> ground(double u, double v, double max_range_m = 20.0) const;

  /// Pixel of a point of G; none if it lies behind the camera. The pixel may lie outside the image.
  [[nodiscard]] std::optional<Eigen::Vector2d> pixel(const Eigen::Vector3d& p_G) const;
  [[nodiscard]] std::optional<Eigen::Vector2d> pixel(const Eigen::Vector2d& ground_point) const {
    return pixel(Eigen::Vector3d(ground_point.x(), ground_point.y(), 0.0));
  }

  /// Row of the horizon at column u; +-1e9 if the camera looks straight up or down.
  [[nodiscard]] double horizon_row(double u) const;
  /// The pixel of a column of the image in which the horizon lies; +-1e6 if that is far outside the image.
  [[nodiscard]] int horizon_pixel(int column) const;

  /// [m] size of a pixel on the ground at a range: across the line of sight, and along it.
  [[nodiscard]] double pixel_across_m(double range_m) const { return range_m / fx_; }
  [[nodiscard]] double pixel_along_m(double range_m) const {
    return (range_m * range_m + height_m() * height_m()) / (fy_ * height_m());
  }

  [[nodiscard]] const Eigen::Vector3d& position() const { return p_GC_; }
  [[nodiscard]] Eigen::Vector2d position_on_ground() const { return p_GC_.head<2>(); }
  [[nodiscard]] double height_m() const { return p_GC_.z(); }
  [[nodiscard]] double focal_pixels() const { return fy_; }
  [[nodiscard]] int width() const { return width_; }
  [[nodiscard]] int height() const { return height_; }
  [[nodiscard]] bool inside(const Eigen::Vector2d& pixel) const {
    return pixel.x() >= 0.0 && pixel.y() >= 0.0 && pixel.x() < width_ && pixel.y() < height_;
  }

 private:
  /// A camera without a place.
  GroundCamera(const msg::CameraInfo& info, const HeadShape& head, OwnBody body);
  void find_clear_side();
  /// [m] a ray that passes the axis of the head at this distance or farther misses the head.
  [[nodiscard]] double head_reach_m() const { return head_.radius_m + 0.2 / fx_; }  // two pixels at 0.1 m

  int width_;
  int height_;
  double fx_;
  double fy_;
  double cx_;
  double cy_;
  Eigen::Matrix3d R_GC_ = Eigen::Matrix3d::Identity();
  Eigen::Vector3d p_GC_ = Eigen::Vector3d::Zero();
  Eigen::Matrix3d R_HC_ = Eigen::Matrix3d::Identity();
  Eigen::Vector3d p_HC_ = Eigen::Vector3d::Zero();
  HeadShape head_;
  OwnBody body_;
  /// A pixel (u, v) with clear_·((u - cx) / fx, (v - cy) / fy, 1) > 0 does not show the head. Zero: there is no such
  /// test.
  Eigen::Vector3d clear_ = Eigen::Vector3d::Zero();
};

}  // namespace constrictor::perception
