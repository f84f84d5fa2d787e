// The equations of motion of one step for bodies that touch each other, and their solution by Newton's method.
#pragma once

#include <Eigen/Cholesky>
#include <Eigen/Core>
#include <cstddef>
#include <map>
#include <span>
#include <vector>

#include "sim/world/chain_factor.hpp"
#include "sim/world/contact_law.hpp"
#include "sim/world/servo.hpp"
#include "sim/world/spatial.hpp"

namespace constrictor {

/// A body of the system. The modules of the chain come first, from head to tail, and have one common point of
/// reference; each object has its own centre as its reference.
struct SystemBody {
  Matrix6d inertia = Matrix6d::Zero();
  Vector6d impulse = Vector6d::Zero();   ///< of all but contacts and servos in this step: h (external - velocity terms)
  Vector6d velocity = Vector6d::Zero();  ///< before and, once it is solved, after the step
  Vector6d change = Vector6d::Zero();    ///< of the velocity in the last step; the solver starts from it
};

/// The system's unknowns are the generalised velocities at the end of the step: the six of the head, the rates of the
/// joints, and six for each object that touches the robot or other objects. They obey
///   M (u+ - u) = h (Q + sum of J^T f(J u+) + torques(u+))
/// in which contact forces f and torques of the servos are those at the end of the step (implicit Euler), so that every
/// step is stable. Each is the gradient of a convex function as long as the bounds of friction are fixed, so Newton's
/// method with a line search converges; the bounds follow the normal forces from one iteration to the next. Each
/// iteration solves with the matrix M + h J^T D J + h D_servo. The contacts of a module add up to six by six numbers,
/// which have the form of an inertia; so ChainFactor solves for the chain in a time that grows linearly with the
/// modules, once for the gradient and once for each unknown of an object that the chain touches. Contacts between
/// modules couple distant joints. Then the composite-rigid-body algorithm makes the matrix, and Cholesky's
/// factorisation solves with it. Sources: R. Featherstone, Rigid Body Dynamics Algorithms, chapters 6 and 7; E.
/// Todorov, Convex and analytically-invertible dynamics with contacts and constraints (ICRA 2014), for the primal
/// Newton method.
class ChainSystem {
 public:
  struct Joint {
    Vector6d axis = Vector6d::Zero();  ///< spatial velocity of the modules behind the joint at a rate of 1 rad/s
    double rate_rad_s = 0.0;           ///< before and, once it is solved, after the step
    double change_rad_s = 0.0;         ///< as SystemBody::change
    ServoRow servo;
    /// While the angle is beyond a limit, `stop` pushes it back: its torque has only the sign of `stop_side` (+1 or
    /// -1). If `stop_side` is 0, the angle is within its limits, and `stop` is not used.
    double stop_side = 0.0;
    ServoRow stop;

    [[nodiscard]] double torque_nm(double rate) const;  ///< of servo and limit, at the end of the step
    [[nodiscard]] double slope(double rate) const;      ///< by which it falls with the rate
  };
  struct Contact {
    std::size_t first;
    std::size_t second;                     ///< kFixed: the ground or an obstacle
    Eigen::Matrix<double, 6, 3> on_first;   ///< wrenches of unit forces along the axes of the contact's frame
    Eigen::Matrix<double, 6, 3> on_second;  ///< the same about the reference of the second body
    ContactLaw law;
    Eigen::Vector3d drift_m_s{0.0, 0.0, 0.0};  ///< in the contact's frame: added to the velocity that the law sees
    Eigen::Vector3d velocity_m_s{0.0, 0.0, 0.0};
    Eigen::Vector3d change_m_s{0.0, 0.0, 0.0};
    Eigen::Vector3d force_n{0.0, 0.0, 0.0};
  };

  explicit ChainSystem(std::size_t modules) : modules_(modules), joints_(modules - 1) {}

  /// The bodies of the whole scene, by their numbers.
  std::vector<SystemBody>& bodies() { return bodies_; }
  std::vector<Joint>& joints() { return joints_; }
  std::vector<Contact>& contacts() { return contacts_; }
  [[nodiscard]] const std::vector<SystemBody>& bodies() const { return bodies_; }
  [[nodiscard]] const std::vector<Joint>& joints() const { return joints_; }

  /// Solves for the motion of the chain (if `with_chain`) and of these objects (numbers of bodies), which touch only
  /// each other and what is fixed. `contacts` has the numbers of their contacts. Returns the number of iterations.
  int solve(bool with_chain, std::span<const std::size_t> objects, std::span<const std::size_t> contacts,
            double step_s);
  /// Whether the last solve() has reached its tolerance. After 50 iterations it ends in any case.
  [[nodiscard]] bool solved() const { return solved_; }

 private:
  /// What has a size that depends on the part of the scene that is solved.
  struct Unknowns {
    Eigen::VectorXd gradient;
    Eigen::VectorXd step;
    Eigen::MatrixXd hessian;  // its rows of the chain are used only if the chain is folded
    Eigen::LLT<Eigen::MatrixXd, Eigen::Lower> factor;
    Eigen::MatrixXd response;  // of the chain to each unknown of the objects
  };

  void begin(bool with_chain, std::span<const std::size_t> objects);
  /// Sets the bounds of friction, the forces and the gradient at the present velocities. Returns its largest entry.
  double evaluate();
  /// The matrix of an iteration (chain_matrix.cpp).
  void assemble();
  void assemble_chain();
  void assemble_objects();
  void add_self_contact(const Contact& contact);
  /// `Unknowns::step` from the matrix and the gradient.
  void find_step();
  /// The changes of the last step as `Unknowns::step`: the bodies probably accelerate as before.
  void begin_as_before();
  void remember_changes();
  /// The change of all velocities that belongs to `Unknowns::step`.
  void spread();
  /// Derivative of the function that the solution minimises, along the step, after this share of the step.
  [[nodiscard]] double derivative(double share) const;
  /// The share of the step at which this derivative is nearly 0.
  [[nodiscard]] double search() const;
  void move(double share);
  [[nodiscard]] bool is_module(std::size_t body) const { return body < modules_; }
  [[nodiscard]] bool is_self(const Contact& contact) const {
    return is_module(contact.first) && is_module(contact.second);  // kFixed is not a module
  }

  std::size_t modules_;
  std::vector<SystemBody> bodies_;
  std::vector<Joint> joints_;
  std::vector<Contact> contacts_;

  // The part of the scene that is solved at present.
  double step_s_ = 0.0;
  bool solved_ = true;
  bool with_chain_ = false;
  bool folded_ = false;  // modules touch modules, so that the matrix is not that of a chain alone
  std::span<const std::size_t> objects_;
  std::span<const std::size_t> active_;  // contacts
  std::vector<std::size_t> members_;     // bodies that move
  std::vector<Eigen::Index> offsets_;    // of the six rows of each object, by the number of the body
  Eigen::Index size_ = 0;
  std::vector<Vector6d> change_;     // of the velocity of each body in one iteration
  std::vector<Vector6d> relative_;   // velocity of each body less that before the step
  std::vector<Vector6d> wrench_;     // on each body, later on each module and all behind it
  std::vector<Matrix6d> stiffness_;  // of each body with its contacts, later of each module and all behind it
  std::vector<Matrix6d> coupling_;   // of each module with one object
  std::vector<double> rates_before_rad_s_;
  std::map<Eigen::Index, Unknowns> unknowns_;  // by size_: to resize one of them would allocate memory in each step
  Unknowns* now_ = nullptr;                    // those of the part that is solved at present
  std::vector<ChainFactor::Joint> hinges_;
  ChainFactor chain_factor_;
  double inertia_before_ = 0.0;  // derivative() without contacts and joints is inertia_before_ + share inertia_slope_
  double inertia_slope_ = 0.0;
};

}  // namespace constrictor
