// Statistics of errors, updated at every tick.
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <optional>
#include <vector>

#include "robot/planar.hpp"

namespace constrictor::report {

/// Root mean square and greatest magnitude of the added values; NaN before the first value.
struct RootMeanSquare {
  double sum_of_squares = 0.0;
  double greatest = 0.0;
  std::uint64_t count = 0;

  void add(double value) {
    sum_of_squares += value * value;
    greatest = std::max(greatest, std::abs(value));
    ++count;
  }
  [[nodiscard]] double rms() const {
    return count > 0 ? std::sqrt(sum_of_squares / static_cast<double>(count))
                     : std::numeric_limits<double>::quiet_NaN();
  }
  [[nodiscard]] double max() const { return count > 0 ? greatest : std::numeric_limits<double>::quiet_NaN(); }

  template <class Archive>
  void serialize(Archive& archive) {
    archive(sum_of_squares, greatest, count);
  }
};

/// Mechanical work of the joints, and how far the robot came with it.
struct Effort {
  double work_j = 0.0;             ///< sum of |torque x rate| over all joints; braking counts like driving
  double distance_m = 0.0;         ///< path of the centre of the modules, measured once in kEvery_s
  Eigen::Vector2d centre_m{0, 0};  ///< at the last measurement
  double measured_s = -1.0;        ///< simulated time of the last measurement; negative: none yet

  /// A path that is measured at each tick would count the tremble of a robot that stands.
  static constexpr double kEvery_s = 1.0;

  void add_work(double power_w, double duration_s) { work_j += power_w * duration_s; }
  void add_centre(const Eigen::Vector2d& now_m, double time_s) {
    if (measured_s >= 0 && time_s < measured_s + kEvery_s) return;
    if (measured_s >= 0) distance_m += (now_m - centre_m).norm();
    centre_m = now_m;
    measured_s = time_s;
  }
  /// Work for each newton of weight and metre of path; NaN below 0.1 m of path.
  [[nodiscard]] double cost_of_transport(double mass_kg) const {
    constexpr double kGravity_m_s2 = 9.81;
    return distance_m < 0.1 ? std::numeric_limits<double>::quiet_NaN()
                            : work_j / (mass_kg * kGravity_m_s2 * distance_m);
  }

  template <class Archive>
  void serialize(Archive& archive) {
    archive(work_j, distance_m, centre_m.x(), centre_m.y(), measured_s);
  }
};

/// [m] distance of a point from a polyline. Empty if the point lies beyond an end of the line, or if the line has fewer
/// than two points.
[[nodiscard]] std::optional<double> cross_track_m(const Eigen::Vector2d& p, const std::vector<Eigen::Vector2d>& line_m);

/// A pose and the tick to which it belongs.
struct PoseAtTick {
  std::int64_t tick = -1;
  PlanarPose X;

  template <class Archive>
  void serialize(Archive& archive) {
    archive(tick, X);
  }
};

/// X_AB from X_WA and X_WB.
[[nodiscard]] PlanarPose relative_pose(const PlanarPose& X_WA, const PlanarPose& X_WB);

}  // namespace constrictor::report
