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

/// State of the filter: x, y, yaw of the head in M, the scale of its drift, then x, y of each landmark; and its
/// covariance, row-major.
struct PoseFilterState {
  std::vector<double> mean{0.0, 0.0, 0.0, 1.0};
  std::vector<double> covariance = std::vector<double>(16, 0.0);
  template <class Archive>
  void serialize(Archive& archive) {
    archive(mean, covariance);
  }
};

/// The part of a motion whose size odometry only estimates, because friction and what the robot pushes decide it: the
/// true part is the estimated one times a scale that hardly changes, and that the filter estimates. The scale is a
/// first-order Gauss-Markov process with the mean 1.
struct ScaledDrift {
  Eigen::Vector2d step_m{0.0, 0.0};  ///< in the head's frame; a part of the whole step
  double forget = 0.0;               ///< share of what is known about the scale that is forgotten in this step
  double scale_sd = 0.0;             ///< standard deviation of the scale where nothing is known about it
};

/// Simultaneous localisation and mapping with full covariance. Landmarks are numbered from 0; removing one renumbers
/// those after it. Source: Smith, Self and Cheeseman, "Estimating uncertain spatial relationships in robotics", 1990.
class PoseFilter {
 public:
  explicit PoseFilter(PoseFilterState& state) : state_(state) {}

  [[nodiscard]] PlanarPose pose() const { return {{state_.mean[0], state_.mean[1]}, state_.mean[2]}; }
  [[nodiscard]] Eigen::Matrix3d pose_covariance() const;
  [[nodiscard]] std::size_t landmark_count() const { return (state_.mean.size() - kFirst) / 2; }
  [[nodiscard]] double scale() const { return state_.mean[kScale]; }
  [[nodiscard]] double scale_sd() const;
  [[nodiscard]] Eigen::Vector2d landmark(std::size_t index) const;
  [[nodiscard]] Eigen::Matrix2d landmark_covariance(std::size_t index) const;

  /// Motion `step_m` in the head's frame, of which `drift` is a part, and turn `turn_rad`; `noise` is the covariance of
  /// their other errors. Returns the motion with the drift scaled.
  Eigen::Vector2d predict(const Eigen::Vector2d& step_m, double turn_rad, const Eigen::Matrix3d& noise,
                          const ScaledDrift& drift = {});
  /// Forgets what is known about the scale, because the robot has taken or left a load.
  void forget_scale(double sd);

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
  static constexpr std::size_t kScale = 3, kFirst = 4;  ///< places in the state: of the scale, of the first landmark
  using Vector = Eigen::VectorXd;
  using Matrix = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
  [[nodiscard]] Eigen::Index size() const { return static_cast<Eigen::Index>(state_.mean.size()); }
  [[nodiscard]] Eigen::Map<Vector> mean() const { return {state_.mean.data(), size()}; }
  [[nodiscard]] Eigen::Map<Matrix> covariance() const { return {state_.covariance.data(), size(), size()}; }
  [[nodiscard]] static Eigen::Index at(std::size_t index) { return static_cast<Eigen::Index>(kFirst + 2 * index); }
  void correct(const Matrix& H, const Vector& innovation, const Matrix& noise);
  void observation(std::size_t index, Matrix& H, Eigen::Vector2d& expected) const;

  PoseFilterState& state_;
};

}  // namespace constrictor::guidance
