// A snake robot as a chain of rigid links in the plane, whose joint angles are given functions of time. It shares no
// code with the simulated world.
//
// Source: P. Liljebäck, K. Y. Pettersen, Ø. Stavdahl, J. T. Gravdahl, "Snake Robots: Modelling, Mechatronics, and
// Control", Springer 2013, chapter 2 ("complex model"): its equations of motion
//   M theta" + W theta'^2 - l S K f_x + l C K f_y = D^T u,   N m p" = E^T f,
// with the joints driven exactly, as by its partial feedback linearisation. The book has N equal links; here each link
// has a length, mass and inertia of its own, so that the first and the last link of our robots can be shorter.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <functional>
#include <vector>

#include "bench/validation/lateral_undulation.hpp"
#include "robot/robot_model.hpp"

namespace constrictor::validation {

/// A point of a link on which the ground acts.
struct FrictionPoint {
  Eigen::Index link = 0;
  double offset_m = 0.0;  ///< from the centre of the link towards the head
  double weight_n = 0.0;  ///< force with which the point presses on the ground
};

/// The links, head to tail.
struct PlanarRobot {
  Eigen::VectorXd length_m;
  Eigen::VectorXd mass_kg;
  Eigen::VectorXd inertia_kg_m2;  ///< about the centre of each link
  std::vector<FrictionPoint> points;
};

enum class FrictionLaw { kCoulomb, kViscous, kEllipse };

/// The force of the ground on a point, along and across its link; except for the ellipse separately, as in the book.
/// Coulomb: -coefficient * weight * v / sqrt(v^2 + smoothing^2); the book has the sign of v, which RK4 cannot
/// integrate. Viscous: -coefficient [N s/m] * v. Ellipse (not in the book): of all forces within the ellipse whose half
/// axes are coefficient * weight, the one that takes the most power: -weight * D D v / |D v|, D = diag(along, across),
/// smoothed likewise.
struct GroundFriction {
  FrictionLaw law = FrictionLaw::kCoulomb;
  double along = 0.05;
  double across = 0.5;
  double smoothing_m_s = 0.002;
};

/// Where the ground acts on the links of a robot.
enum class FrictionPlaces {
  kLinkCentres,    ///< as in the book, for links of two modules between yaw joints
  kModuleCentres,  ///< as in the book, if each module is a link; every second joint of our robots is then straight
  kModuleEnds,     ///< as in the simulated world: both ends of each module
};

/// The yaw links of a robot whose pitch joints are straight. Modules are capsules of equal mass.
[[nodiscard]] PlanarRobot planar_robot(const RobotModel& robot, FrictionPlaces places);

/// The position of the robot: heading of the first link, centre of mass in the plane, and their rates.
struct PlanarState {
  double heading_rad = 0.0;
  Eigen::Vector2d centre_m{0.0, 0.0};
  double turn_rad_s = 0.0;
  Eigen::Vector2d velocity_m_s{0.0, 0.0};
};

class PlanarModel {
 public:
  PlanarModel(const PlanarRobot& robot, const GroundFriction& friction);

  [[nodiscard]] std::size_t joint_count() const { return static_cast<std::size_t>(robot_.length_m.size()) - 1; }
  /// Integrates one step with the classical Runge-Kutta method of fourth order. `motion` gives the joints at a time.
  void step(PlanarState& state, double time_s, double step_s, const std::function<JointMotion(double)>& motion) const;

  /// What the model says about one instant.
  struct Instant {
    double turn_acceleration_rad_s2 = 0.0;
    Eigen::Vector2d acceleration_m_s2{0.0, 0.0};  ///< of the centre of mass
    Eigen::VectorXd torque_nm;                    ///< of the joints
    double joint_power_w = 0.0;                   ///< that the joints give
    double friction_power_w = 0.0;                ///< that the ground takes; not negative
    double kinetic_energy_j = 0.0;
    double angular_momentum_nms = 0.0;  ///< about the centre of mass
  };
  [[nodiscard]] Instant evaluate(const PlanarState& state, const JointMotion& motion) const;

  /// Mean direction of the links: a unit vector.
  [[nodiscard]] Eigen::Vector2d forward(const PlanarState& state, const JointMotion& motion) const;

  /// The matrices of the book for this robot: x = p_x + B cos(theta), and G = B^T diag(m) B. With equal links of
  /// length 2 l and mass m the book has B = -l K^T and G = m l^2 V; it counts the links from the tail, and we from the
  /// head, which changes the sign of K.
  [[nodiscard]] const Eigen::MatrixXd& centre_matrix_m() const { return B_; }
  [[nodiscard]] const Eigen::MatrixXd& coupling_matrix_kg_m2() const { return G_; }

 private:
  struct Links {  // headings and rates of all links
    Eigen::VectorXd cosine, sine, rate;
  };
  [[nodiscard]] Links links(const PlanarState& state, const JointMotion& motion) const;

  PlanarRobot robot_;
  GroundFriction friction_;
  double mass_kg_ = 0.0;
  Eigen::MatrixXd B_;
  Eigen::MatrixXd G_;
};

/// What the gait achieves over whole cycles.
struct PlanarMeasurement {
  double speed_m_s = 0.0;      ///< of the centre of mass along the mean direction of the links
  double torque_rms_nm = 0.0;  ///< of all joints
  double power_w = 0.0;        ///< mean that the ground takes
};

/// Measures `cycles` cycles of the gait after the first `settle_cycles`, which start at rest. The default step suits
/// the smoothed Coulomb friction, which is stiff.
[[nodiscard]] PlanarMeasurement measure_planar(const PlanarModel& model, const LateralUndulation& gait,
                                               int settle_cycles, int cycles, double largest_step_s = 2e-4);

}  // namespace constrictor::validation
