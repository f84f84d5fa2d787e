// How a held object moves over the ground: its place, the direction of the U, and the angle at which the U drives
// askew.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cereal/types/array.hpp>
#include <cereal/types/deque.hpp>
#include <deque>

namespace constrictor {

/// The gait shakes the object and the U, so that both are averaged over whole periods of the gait.
class HeldMotion {
 public:
  struct Config {
    double pivot_m = 0.0;   ///< distance from the object to the point of the U that turns do not move sideways
    double filter_s = 0.0;  ///< time constant of the low-pass on the crab angle
  };
  /// The present motion.
  struct Motion {
    /// [m] The object's present place in M. The mean over the last period is where the object was half a period ago. In
    /// a whole period, the object moves from the mean over the period before to this mean: half of this way is added to
    /// the mean. Before two periods have been observed, the place is the mean itself.
    Eigen::Vector2d place;
    double heading_rad;  ///< direction in M in which the U points, found in the same way
    /// From the direction in which the U points to the direction in which it moves, positive left. On a slope the body
    /// slides downhill while it drives, so that the robot drives like a crab. The object in the base of the U swings
    /// out when the U turns; that is no crab angle, and the point `pivot_m` before the object does not do so. 0 until
    /// it is known.
    double crab_rad;
  };
  /// The motion after a new observation. `p_M`: [m] the object's centre in M. `mouth_rad`: direction in M in which the
  /// U points. `period_s`: of the gait.
  Motion observe(double time_s, const Eigen::Vector2d& p_M, double mouth_rad, double period_s, const Config& config);

  template <class Archive>
  void serialize(Archive& archive) {
    archive(samples_, crab_rad_, crab_s_);
  }

 private:
  struct Mean {
    Eigen::Vector2d place{0.0, 0.0}, mouth{0.0, 0.0};  ///< [m] in M; unit vector in M
  };
  struct Means {
    Mean last, before;  ///< over the last period, and over the period before it
    bool two_periods;
  };
  [[nodiscard]] Means means(double period_s) const;
  std::deque<std::array<double, 4>> samples_;  ///< (time [s], x, y [m] in M, mouth [rad]), oldest first
  double crab_rad_ = 0.0;
  double crab_s_ = 0.0;  ///< time for which the crab angle has been measured
};

}  // namespace constrictor
