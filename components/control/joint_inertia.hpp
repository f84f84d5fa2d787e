// The inertia that the joints of one axis feel: that of the links, which move freely in one plane, and of the rotors.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <vector>

#include "robot/robot_model.hpp"

namespace constrictor {

/// The joints of one axis divide the body into n + 1 links, which turn in one plane while all other joints are
/// straight. The body floats: ground and gravity are not part of the model.
class JointInertia {
 public:
  /// `joints`: the indices of joints with one axis, from the head. `mass_share`: how much of the modules' mass counts.
  JointInertia(const RobotModel& robot, std::vector<std::size_t> joints, double mass_share = 1.0);

  [[nodiscard]] std::size_t joint_count() const { return joints_.size(); }
  [[nodiscard]] const std::vector<std::size_t>& joints() const { return joints_; }

  /// [kg m²] M(q), n x n: torques u give the rates q' of the joints the accelerations M^-1 u, apart from terms that
  /// are quadratic in the rates. `angle_rad`: angles of the joints, n entries.
  /// Derivation: with the headings h of the links, the kinetic energy relative to the centre of mass is h'^T W h' / 2,
  /// W_jk = A_jk cos(h_j - h_k) + I_j [j = k], where A follows from the masses and lengths of the links. The angles are
  /// q = D h, so that M = (D W^-1 D^T)^-1 + J, where J is the inertia of the rotors.
  [[nodiscard]] Eigen::MatrixXd matrix(const Eigen::VectorXd& angle_rad) const;

 private:
  std::vector<std::size_t> joints_;
  Eigen::MatrixXd coupling_kg_m2_;  ///< A
  Eigen::VectorXd own_kg_m2_;       ///< of each link about its centre
  Eigen::VectorXd rotor_kg_m2_;
};

}  // namespace constrictor
