// The robot seen from above as a chain of yaw links, and the travelling wave that rides on a posture of it.
#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "constrictor/messages.hpp"
#include "robot/robot_model.hpp"

namespace constrictor {

/// A value for each yaw joint or link, head to tail; elements beyond the count are zero. A chain of n joints has n + 1 links.
using LinkArray = std::array<double, msg::kMaxJoints>;

/// Lateral undulation on a posture.
struct Wave {
  double amplitude_rad = 0.0;
  double wavelength_m = 1.0;
  double curvature_1_m = 0.0;  ///< of the path, positive left
  double phase_rad = 0.0;
  /// 1: the wave's argument is X along the head's direction (arms of a U undulate in parallel); 0: it is the arc length along the
  /// body (which follows itself round bends).
  double field = 1.0;
};

/// How strongly each link takes part in the wave.
struct WaveWeights {
  std::vector<double> head{0.0, 0.5, 0.8};  ///< first links; the rest 1. A still head keeps the camera on the mean heading
  double rigid_bend_rad = 1.047;            ///< a link between two joints of the posture bent by this or more does not undulate
};

/// Planar kinematics of the yaw links. Link k lies between yaw joints k - 1 and k; link 0 carries the head.
class YawChain {
 public:
  explicit YawChain(const RobotModel& robot);

  [[nodiscard]] std::size_t joint_count() const { return joints_.size(); }
  [[nodiscard]] std::size_t link_count() const { return joints_.size() + 1; }
  /// Index among all joints of the robot of yaw joint k.
  [[nodiscard]] std::size_t joint_index(std::size_t k) const { return joints_[k]; }
  /// [m] distance between neighbouring yaw joints.
  [[nodiscard]] double link_length_m() const { return link_length_m_; }

  /// Heading of each link relative to link 0 in a posture given by its yaw joint angles [rad].
  [[nodiscard]] LinkArray headings(const LinkArray& shape_rad) const;
  /// [m] coordinate of each link's centre along the head's direction, from the head's centre (behind is negative).
  [[nodiscard]] LinkArray coordinates(const LinkArray& headings_rad) const;
  /// [m] the same for the straight body: minus the arc length from the head's centre.
  [[nodiscard]] const LinkArray& arc_coordinates() const { return arc_m_; }
  /// Weight 0..1 of each link in the wave on this posture.
  [[nodiscard]] LinkArray weights(const LinkArray& shape_rad, const WaveWeights& weights) const;

  /// Yaw joint angles of the wave on the posture:
  /// H_k = Theta_k + kappa X_k + A w_k cos(2 pi X_k / lambda + phase), q_k = H_k - H_{k+1}.
  /// Source: serpenoid curve (Hirose) sampled at rigid links; FACTS of the project for the weights and the common X of a U.
  [[nodiscard]] LinkArray joint_angles(const LinkArray& shape_rad, const Wave& wave, const WaveWeights& weights) const;

  /// A posture moved along the body towards the head by `distance_m` (negative: towards the tail): joint k takes the angle
  /// that the posture has at k + distance / link length, linear between joints, zero beyond its ends.
  [[nodiscard]] LinkArray slid(const LinkArray& shape_rad, double distance_m) const;

 private:
  std::vector<std::size_t> joints_;
  std::vector<double> front_m_;  ///< by link: arc length of its front end from the head's centre
  std::vector<double> length_m_;
  LinkArray arc_m_{};
  double link_length_m_ = 0.0;
};

}  // namespace constrictor
