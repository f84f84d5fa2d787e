// The force of one contact as a function of the relative velocity at the end of the step. ChainDynamics solves for the
// velocity at which all forces and the motion agree.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>

#include "sim/world/dynamics.hpp"
#include "sim/world/solver_settings.hpp"

namespace constrictor {

/// How the force falls with the velocity: by `slope` times the velocity along `axis` (a unit vector in the contact's
/// frame). At most three such terms make the derivative, which is symmetric and never negative.
struct ContactSlope {
  struct Term {
    Eigen::Vector3d axis;
    double slope = 0.0;
  };
  std::array<Term, 3> terms;
  std::size_t count = 0;
  void add(const Eigen::Vector3d& axis, double slope) { terms[count++] = {axis, slope}; }
};

/// Vectors are in the frame of the contact: normal, first and second tangent. The velocity is that of the first body
/// relative to the second one, the force that on the first body.
///   normal:    f = max(0, k depth - d v), a spring and a damper in parallel; the depth is that at the beginning of the
///              step, the velocity that at its end. With the depth at the end, too, the step h would add a damping h k
///   friction:  Coulomb's law with the coefficients of the contact; a force within its bound lets the bodies creep with
///              velocity = force / creep_resistance, so slowly that no result depends on it. The bound on the friction
///              of skin, with coefficients a along and b across, is a rectangle, or with elliptic_friction an ellipse:
///              the force of a sliding body is then the one that takes the most power, -N D D v / |D v| with D =
///              diag(a, b)
/// The bounds of friction belong to one normal force, which bound() sets; between two calls the law is the gradient of
/// a convex function.
class ContactLaw {
 public:
  ContactLaw(const SolverContact& contact, const SolverSettings& settings);

  /// Sets the bounds of friction that belong to the normal force at this velocity.
  void bound(const Eigen::Vector3d& velocity_m_s);
  [[nodiscard]] Eigen::Vector3d force_n(const Eigen::Vector3d& velocity_m_s) const;
  [[nodiscard]] ContactSlope slope(const Eigen::Vector3d& velocity_m_s) const;
  /// The columns are normal and tangents in W.
  [[nodiscard]] const Eigen::Matrix3d& frame() const { return frame_; }

 private:
  [[nodiscard]] double normal_n(double velocity_m_s) const;
  [[nodiscard]] Eigen::Vector2d scaled_creep(const Eigen::Vector3d& velocity_m_s) const;

  Eigen::Matrix3d frame_;
  double resting_n_;  ///< normal force of bodies that do not move
  double damping_n_s_m_;
  double fastest_m_s_;  ///< at which bodies may leave each other because they overlap
  double creep_resistance_n_s_m_;
  bool isotropic_;
  bool elliptic_;
  double along_;  ///< coefficients of friction
  double across_;
  double along_n_ = 0.0;  ///< bounds of friction
  double across_n_ = 0.0;
};

}  // namespace constrictor
