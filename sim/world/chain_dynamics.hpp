// The dynamics of the robot as one chain in generalised coordinates: the pose of the head and the angles of the joints.
// The hinges hold exactly, because no coordinate could open them, and the forces of a step are solved for exactly
// instead of by a number of relaxation sweeps. README.md compares it with OdeDynamics.
#pragma once

#include <cstdint>
#include <utility>

#include "sim/world/chain_system.hpp"
#include "sim/world/dynamics.hpp"

namespace constrictor {

class ChainDynamics : public Dynamics {
 public:
  ChainDynamics(const Mechanism& mechanism, const SolverSettings& settings);

  void move(std::size_t body, const Eigen::Vector3d& by_m) override;
  /// prepare(), solve() and finish().
  void step(std::span<const ServoRow> rows, std::span<const SolverContact> contacts) override;
  /// The first part of a step: sets its equations up.
  void prepare(std::span<const ServoRow> rows, std::span<const SolverContact> contacts);
  /// The second part: groups the bodies that touch each other, directly or over others, and solves for the velocities
  /// of each group at the end of the step.
  void solve(std::span<const SolverContact> contacts);
  /// The last part: moves the bodies and reports torques and forces.
  void finish(std::span<const SolverContact> contacts);
  [[nodiscard]] std::vector<double> save() const override;
  void load(std::span<const double> memory) override;

  /// Iterations of Newton's method since the engine was built, for all groups of bodies.
  [[nodiscard]] std::int64_t iterations() const { return iterations_; }
  [[nodiscard]] std::int64_t unsolved() const override { return unsolved_; }

 private:
  struct Inertial {
    double mass_kg;
    Eigen::Vector3d inertia_kg_m2;
  };

  /// Poses, or velocities, of all modules from those of the head and the joints.
  void place_modules();
  void move_modules();
  void prepare_chain();
  void prepare_joints(std::span<const ServoRow> rows);
  void prepare_object(std::size_t body);
  void prepare_contacts(std::span<const SolverContact> contacts);
  [[nodiscard]] Eigen::Vector3d drift_m_s(const SolverContact& contact, std::size_t module) const;
  /// The momentum of the chain after the step, as the forces of the step change it. Reports the contacts' forces.
  [[nodiscard]] Vector6d momentum_after(std::span<const SolverContact> contacts);
  void integrate();
  /// How many numbers save() returns.
  [[nodiscard]] std::size_t memory_size() const;
  /// The spatial momentum of the chain about the origin of W, and the matrix that turns a velocity which all modules
  /// share into such a momentum.
  [[nodiscard]] std::pair<Vector6d, Matrix6d> momentum() const;
  /// Gives the chain the momentum `wanted` (as in momentum()) after a step with these contacts.
  void restore_momentum(const Vector6d& wanted, std::span<const SolverContact> contacts);
  [[nodiscard]] Eigen::Vector3d axis(std::size_t joint) const;  ///< in W
  [[nodiscard]] const Eigen::Vector3d& reference(std::size_t body) const;
  [[nodiscard]] Eigen::Matrix3d inertia_W(std::size_t body) const;

  std::vector<Inertial> inertial_;
  std::vector<JointModel> models_;
  double half_length_m_;
  double radius_m_;  ///< of the modules
  Eigen::Vector3d gravity_m_s2_;
  ChainSystem system_;
  struct Drift {
    Eigen::Vector3d angular_rad_s2{0.0, 0.0, 0.0};
    Eigen::Vector3d linear_m_s2{0.0, 0.0, 0.0};  ///< of the centre
  };
  std::vector<Drift> drifts_;        ///< accelerations of the modules at constant generalised velocities
  std::vector<std::size_t> groups_;  // of each body: the number of a body in the same group
  std::vector<std::size_t> group_objects_;
  std::vector<std::size_t> group_contacts_;
  std::int64_t iterations_ = 0;
  std::int64_t unsolved_ = 0;
};

}  // namespace constrictor
