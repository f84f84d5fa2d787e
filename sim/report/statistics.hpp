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
