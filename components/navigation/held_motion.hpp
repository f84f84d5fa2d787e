// How a held object moves over the ground: its place, and the angle at which the U drives askew.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cereal/types/array.hpp>
#include <cereal/types/deque.hpp>
#include <deque>

namespace constrictor {

/// [m] Lateral distance, positive left, from the course of a held object to the point `lookahead_m` ahead of the head
/// that moves with it. `p_HO`: [m] the object in the frame of the head. The U drives straight, and its direction and
/// that of its motion differ by `crab_rad`.
[[nodiscard]] double steered_aside_m(const Eigen::Vector2d& p_HO, double lookahead_m, double crab_rad);

/// The gait shakes the object and the U, so that both are averaged over whole periods of the gait.
class HeldMotion {
 public:
  /// A new observation. `p_M`: [m] the object's centre in M. `mouth_rad`: direction in M in which the U points.
  /// `period_s`: of the gait. `filter_s`: time constant of the low-pass on the crab angle.
  void observe(double time_s, const Eigen::Vector2d& p_M, double mouth_rad, double period_s, double filter_s);
  /// [m] The object's present place in M. The mean over the last period lies half a period back; the way from the mean
  /// over the period before leads from there to the present.
  [[nodiscard]] Eigen::Vector2d place() const;
  /// [rad] Angle from the direction in which the U points to the direction in which the object moves, positive left. On
  /// a slope the body slides downhill while it drives, so that the robot drives like a crab. 0 until it is known.
  [[nodiscard]] double crab_rad() const { return crab_rad_; }

  template <class Archive>
  void serialize(Archive& archive) {
    archive(samples_, period_s_, crab_rad_, crab_s_);
  }

 private:
  struct Means {
    Eigen::Vector2d last, before;  ///< [m] over the last period, and over the period before it
    Eigen::Vector2d mouth;         ///< of the direction of the U, over both
    bool two_periods;
  };
  [[nodiscard]] Means means() const;
  std::deque<std::array<double, 4>> samples_;  ///< (time [s], x, y [m] in M, mouth [rad]), oldest first
  double period_s_ = 0.0;
  double crab_rad_ = 0.0;
  double crab_s_ = 0.0;  ///< time for which the crab angle has been measured
};

}  // namespace constrictor
