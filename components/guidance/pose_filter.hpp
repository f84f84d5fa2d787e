// Extended Kalman filter for the pose of the head and for landmarks that are seen from it.
#pragma once

#include <Eigen/Core>
#include <cereal/types/vector.hpp>
#include <optional>
#include <vector>

#include "robot/planar.hpp"

namespace constrictor::guidance {

/// Transforms a point from the frame at `pose` to the parent frame, like PlanarPose::to_parent. The order of its
/// additions differs and must stay, because the hashes of recorded runs depend on the rounding.
inline Eigen::Vector2d to_parent(const PlanarPose& pose, const Eigen::Vector2d& p) {
  return pose.p + turned(p, pose.yaw_rad);
}

/// State of the filter: x, y, yaw of the head in M, then x, y of each landmark; and its covariance, row-major.
struct PoseFilterState {
  std::vector<double> mean{0.0, 0.0, 0.0};
  std::vector<double> covariance = std::vector<double>(9, 0.0);
  template <class Archive>
  void serialize(Archive& archive) {
    archive(mean, covariance);
  }
};

/// Simultaneous localisation and mapping with full covariance. Landmarks are numbered from 0; removing one renumbers
/// those after it. Source: Smith, Self and Cheeseman, "Estimating uncertain spatial relationships in robotics", 1990.
class PoseFilter {
 public:
  explicit PoseFilter(PoseFilterState& state) : state_(state) {}

  [[nodiscard]] PlanarPose pose() const { return {{state_.mean[0], state_.mean[1]}, state_.mean[2]}; }
  [[nodiscard]] Eigen::Matrix3d pose_covariance() const;
  [[nodiscard]] std::size_t landmark_count() const { return (state_.mean.size() - 3) / 2; }
  [[nodiscard]] Eigen::Vector2d landmark(std::size_t index) const;
  [[nodiscard]] Eigen::Matrix2d landmark_covariance(std::size_t index) const;

  /// Motion `step_m` in the head's frame, turn `turn_rad`; `noise` is their covariance.
  void predict(const Eigen::Vector2d& step_m, double turn_rad, const Eigen::Matrix3d& noise);

  /// Whether a percept at `z_m` in the head's frame shows this landmark: the squared Mahalanobis distance, and the
  /// natural logarithm of the determinant of the innovation's covariance [m4]. The landmark with the least sum is the
  /// likeliest one.
  struct Match {
    double distance2, log_spread;
  };
  [[nodiscard]] Match match(std::size_t index, const Eigen::Vector2d& z_m, const Eigen::Matrix2d& noise) const;
  void observe(std::size_t index, const Eigen::Vector2d& z_m, const Eigen::Matrix2d& noise);
  /// Adds a landmark at `z_m` in the head's frame. Its number is the previous landmark_count().
  void add(const Eigen::Vector2d& z_m, const Eigen::Matrix2d& noise);
  void remove(std::size_t index);
  /// Increases the variance of a landmark that may have been moved by `variance_m2`, up to 0.25 m2.
  void loosen(std::size_t index, double variance_m2);

  /// Corrects the pose by a known line with unit normal `normal` (in M): a point of it that was seen at `arm_m` (in M)
  /// from the head is `residual_m` away from the line. The correction reduces this residual.
  void observe_line(double residual_m, const Eigen::Vector2d& normal, const Eigen::Vector2d& arm_m, double variance_m2);

 private:
  using Vector = Eigen::VectorXd;
  using Matrix = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
  [[nodiscard]] Eigen::Index size() const { return static_cast<Eigen::Index>(state_.mean.size()); }
  [[nodiscard]] Eigen::Map<Vector> mean() const { return {state_.mean.data(), size()}; }
  [[nodiscard]] Eigen::Map<Matrix> covariance() const { return {state_.covariance.data(), size(), size()}; }
  void correct(const Matrix& H, const Vector& innovation, const Matrix& noise);
  void observation(std::size_t index, Matrix& H, Eigen::Vector2d& expected) const;

  PoseFilterState& state_;
};

}  // namespace constrictor::guidance
