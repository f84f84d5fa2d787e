// How a held object moves over the ground: its place, the direction of the U, and the angle at which the U drives
// askew.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cereal/types/array.hpp>
#include <cereal/types/deque.hpp>
#include <deque>

namespace constrictor {

/// The gait shakes the object and the U, so that both are averaged over windows of two periods of the gait: a loaded
/// body may rock with half of the gait's frequency.
class HeldMotion {
 public:
  struct Config {
    double pivot_m = 0.0;   ///< distance from the object to the point of the U that turns do not move sideways
    double filter_s = 0.0;  ///< time constant of the low-pass on the way of a window
  };
  /// The present motion.
  struct Motion {
    /// [m] The object's present place in M. The mean over the last window is where the object was half a window ago. In
    /// a whole window, the object moves from the mean over the window before to this mean: half of this way is added to
    /// the mean. Before two windows have been observed, the place is the mean itself.
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
    archive(samples_, way_U_.x(), way_U_.y(), way_s_, crab_rad_);
  }

 private:
  struct Mean {
    Eigen::Vector2d place{0.0, 0.0}, mouth{0.0, 0.0};  ///< [m] in M; unit vector in M
  };
  /// Over the samples that are at least `from_s` and less than `to_s` old.
  [[nodiscard]] Mean mean(double from_s, double to_s) const;
  [[nodiscard]] bool observed(double duration_s) const;
  /// `last`, `before`: over the last window of `window_s`, and over the window before it. `since_s`: since the last
  /// call.
  void observe_crab(const Mean& last, const Mean& before, double since_s, double window_s, const Config& config);
  std::deque<std::array<double, 4>> samples_;  ///< (time [s], x, y [m] in M, mouth [rad]), oldest first
  Eigen::Vector2d way_U_{0.0, 0.0};            ///< [m] filtered way of a window; x as the U points, y to its left
  double way_s_ = 0.0;                         ///< time for which it has been measured
  double crab_rad_ = 0.0;
};

}  // namespace constrictor
