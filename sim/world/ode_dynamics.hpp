// The dynamics by ODE's QuickStep: each module and object is a body with six coordinates, and constraints hold the
// modules together at their hinges. Two velocity motors with their softness (CFM) act as the servo: that of the hinge
// exerts the part of the torque that has a limit, and a joint beside it the part that has none.
#pragma once

#include <ode/ode.h>

#include "sim/world/dynamics.hpp"
#include "sim/world/ode_handles.hpp"

namespace constrictor {

class OdeDynamics : public Dynamics {
 public:
  OdeDynamics(const Mechanism& mechanism, const SolverSettings& settings);

  void move(std::size_t body, const Eigen::Vector3d& by_m) override;
  void step(std::span<const ServoRow> rows, std::span<const SolverContact> contacts) override;
  [[nodiscard]] std::vector<double> save() const override;
  void load(std::span<const double> memory) override;

 private:
  struct Hinge {
    dJointID joint;
    dJointID rotor;
    dBodyID ahead;
    dJointFeedback feedback{};
    dJointFeedback rotor_feedback{};
    [[nodiscard]] double measured_torque_nm() const;
  };

  void drive(Hinge& hinge, const ServoRow& row);
  void build(const RigidBody& body);
  void build_hinge(const JointModel& model, std::size_t ahead, double half_length_m);
  void make_contact(const SolverContact& contact, dJointFeedback& feedback);
  [[nodiscard]] Eigen::Vector3d sliding_direction(const SolverContact& contact) const;
  [[nodiscard]] dBodyID handle(std::size_t body) const { return body == kFixed ? nullptr : handles_[body]; }
  void read_back();

  OdeWorld world_;
  OdeJointGroup group_;
  dSurfaceParameters surface_{};
  std::vector<dBodyID> handles_;
  std::vector<Hinge> hinges_;             // ODE keeps pointers into it
  std::vector<dJointFeedback> feedback_;  // of the contacts; ODE keeps pointers into it
  unsigned long reorder_state_;           // state of ODE's global random generator, set before each step
};

}  // namespace constrictor
