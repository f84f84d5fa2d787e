// The robot from above, as a chain of yaw links, and the travelling wave on a posture of this chain.
#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "constrictor/messages.hpp"
#include "robot/robot_model.hpp"

namespace constrictor {

/// One value for each yaw joint or link, head to tail; elements beyond the count are 0. A chain of n joints has n + 1
/// links.
using LinkArray = std::array<double, msg::kMaxJoints>;

/// Lateral undulation on a posture.
struct Wave {
  double amplitude_rad = 0.0;
  double wavelength_m = 1.0;
  double curvature_1_m = 0.0;  ///< curvature of the path, positive to the left
  double phase_rad = 0.0;
  /// The argument of the wave. 1: the coordinate X along the head's direction, so that the arms of a U undulate in
  /// parallel. 0: the arc length along the body, so that the body follows itself round bends.
  double field = 1.0;
};

/// How strongly each link takes part in the wave. The defaults are in ControlConfig.
struct WaveWeights {
  std::vector<double> head;     ///< share of the amplitude in the first links; 1 in all others
  double rigid_bend_rad = 0.0;  ///< a link between two joints of the posture bent by this or more does not undulate
};

/// Planar kinematics of the yaw links. Link k lies between yaw joints k - 1 and k; link 0 carries the head.
class YawChain {
 public:
  explicit YawChain(const RobotModel& robot);

  [[nodiscard]] std::size_t joint_count() const { return joints_.size(); }
  /// Whether the robot also has pitch joints.
  [[nodiscard]] bool has_pitch_joints() const { return has_pitch_joints_; }
  [[nodiscard]] std::size_t link_count() const { return joints_.size() + 1; }
  /// Index among all joints of the robot of yaw joint k.
  [[nodiscard]] std::size_t joint_index(std::size_t k) const { return joints_[k]; }
  /// [m] distance between neighbouring yaw joints.
  [[nodiscard]] double link_length_m() const { return link_length_m_; }

  /// Heading of each link relative to link 0 in a posture given by its yaw joint angles [rad].
  [[nodiscard]] LinkArray headings(const LinkArray& shape_rad) const;
  /// [m] coordinate of each link's centre along the head's direction, from the head's centre (behind is negative).
  [[nodiscard]] LinkArray coordinates(const LinkArray& headings_rad) const;
  /// [m] the same for a straight body: the negative arc length from the head's centre.
  [[nodiscard]] const LinkArray& arc_coordinates() const { return arc_m_; }
  /// Weight 0..1 of each link in the wave on this posture.
  [[nodiscard]] LinkArray weights(const LinkArray& shape_rad, const WaveWeights& weights) const;

  /// Yaw joint angles of the wave on the posture:
  /// H_k = Theta_k + kappa X_k + A w_k cos(2 pi Y_k / lambda + phase), q_k = H_k - H_{k+1}, with
  /// Y_k = field X_k + (1 - field) S_k. Theta_k: headings(); X_k: coordinates(); S_k: arc_coordinates(); w_k:
  /// weights(). Source: serpenoid curve (Hirose) sampled at rigid links. The weights are this project's own, and so is
  /// X_k, which is the same for both arms of a U.
  [[nodiscard]] LinkArray joint_angles(const LinkArray& shape_rad, const Wave& wave, const WaveWeights& weights) const;

  /// A posture that was moved along the body by `distance_m` towards the head (negative: towards the tail). Joint k
  /// takes the angle of the posture at k + distance / link length: linear between joints, 0 beyond the ends.
  [[nodiscard]] LinkArray slid(const LinkArray& shape_rad, double distance_m) const;

 private:
  std::vector<std::size_t> joints_;
  std::vector<double> front_m_;  ///< by link: arc length of its front end from the head's centre
  std::vector<double> length_m_;
  LinkArray arc_m_{};
  double link_length_m_ = 0.0;
  bool has_pitch_joints_ = false;
};

}  // namespace constrictor
