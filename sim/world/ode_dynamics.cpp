#include "sim/world/ode_dynamics.hpp"

#include <algorithm>
#include <stdexcept>

namespace constrictor {
namespace {

using Eigen::Vector3d;

/// Numbers that a body keeps: position, quaternion, rotation matrix, velocity and angular velocity.
constexpr std::size_t kBodyNumbers = 3 + 4 + 12 + 3 + 3;

Vector3d vector_of(const dReal* from) { return {from[0], from[1], from[2]}; }

void copy(const Vector3d& from, dVector3 to) {
  to[0] = from.x();
  to[1] = from.y();
  to[2] = from.z();
  to[3] = 0.0;
}

OdeWorld make_world(const SolverSettings& settings, const Vector3d& gravity_m_s2) {
  ensure_ode();
  OdeWorld world(dWorldCreate());
  dWorldSetGravity(world.get(), gravity_m_s2.x(), gravity_m_s2.y(), gravity_m_s2.z());
  dWorldSetERP(world.get(), settings.erp);
  dWorldSetCFM(world.get(), settings.cfm);
  dWorldSetQuickStepNumIterations(world.get(), settings.iterations);
  dWorldSetQuickStepW(world.get(), settings.over_relaxation);
  dWorldSetContactSurfaceLayer(world.get(), settings.surface_layer_m);
  dWorldSetContactMaxCorrectingVel(world.get(), settings.max_correcting_velocity_m_s);
  return world;
}

void set_values(dBodyID body, const double* from) {
  dBodySetPosition(body, from[0], from[1], from[2]);
  // dBodySetQuaternion() and dBodySetRotation() normalise what they are given, which changes its last bits. ODE has no
  // function that sets the raw values, but its getters return pointers to them.
  std::copy_n(from + 3, 4, const_cast<dReal*>(dBodyGetQuaternion(body)));
  std::copy_n(from + 7, 12, const_cast<dReal*>(dBodyGetRotation(body)));
  dBodySetLinearVel(body, from[19], from[20], from[21]);
  dBodySetAngularVel(body, from[22], from[23], from[24]);
  dBodySetForce(body, 0.0, 0.0, 0.0);
  dBodySetTorque(body, 0.0, 0.0, 0.0);
}

}  // namespace

OdeDynamics::OdeDynamics(const Mechanism& mechanism, const SolverSettings& settings)
    : Dynamics(mechanism, settings),
      world_(make_world(settings, mechanism.gravity_m_s2)),
      group_(dJointGroupCreate(0)),
      reorder_state_(settings.reorder_seed) {
  surface_.mode = dContactApprox1 | dContactSoftERP | dContactSoftCFM | dContactFDir1;
  // ODE's softness of a spring and a damper in parallel. Unlike fixed numbers, it gives the same contact at each step.
  const double spring = settings.step_s * settings.contact_stiffness_n_m;
  surface_.soft_erp = spring / (spring + settings.contact_damping_n_s_m);
  surface_.soft_cfm = 1.0 / (spring + settings.contact_damping_n_s_m);
  for (const RigidBody& module : mechanism.modules) build(module);
  read_back();
  hinges_.reserve(mechanism.joints.size());
  for (std::size_t i = 0; i < mechanism.joints.size(); ++i)
    build_hinge(mechanism.joints[i], i, mechanism.half_length_m);
  for (const RigidBody& object : mechanism.objects) build(object);
  read_back();
}

void OdeDynamics::build(const RigidBody& body) {
  dMass mass;
  const Vector3d& inertia = body.inertia_kg_m2;
  dMassSetParameters(&mass, body.mass_kg, 0, 0, 0, inertia.x(), inertia.y(), inertia.z(), 0, 0, 0);
  const dBodyID handle = dBodyCreate(world_.get());
  dBodySetMass(handle, &mass);
  const Vector3d p = body.X_WB.translation();
  const Eigen::Quaterniond q(body.X_WB.linear());
  const dQuaternion quaternion = {q.w(), q.x(), q.y(), q.z()};
  dBodySetPosition(handle, p.x(), p.y(), p.z());
  dBodySetQuaternion(handle, quaternion);
  handles_.push_back(handle);
}

void OdeDynamics::build_hinge(const JointModel& model, std::size_t ahead, double half_length_m) {
  const Eigen::Isometry3d X_WM = bodies_[ahead].pose();
  const Vector3d p_WJ = X_WM * Vector3d(-half_length_m, 0.0, 0.0);
  const Vector3d a_W = X_WM.linear().col(model.axis == JointAxis::kYaw ? 2 : 1);
  const dJointID joint = dJointCreateHinge(world_.get(), nullptr);
  dJointAttach(joint, handles_[ahead], handles_[ahead + 1]);
  dJointSetHingeAnchor(joint, p_WJ.x(), p_WJ.y(), p_WJ.z());
  dJointSetHingeAxis(joint, a_W.x(), a_W.y(), a_W.z());
  dJointSetHingeParam(joint, dParamLoStop, model.min_rad);
  dJointSetHingeParam(joint, dParamHiStop, model.max_rad);
  const dJointID rotor = dJointCreateAMotor(world_.get(), nullptr);
  dJointAttach(rotor, handles_[ahead], handles_[ahead + 1]);
  dJointSetAMotorNumAxes(rotor, 1);
  dJointSetAMotorAxis(rotor, 0, 1, a_W.x(), a_W.y(), a_W.z());  // fixed in the module ahead
  hinges_.push_back({joint, rotor, handles_[ahead], {}, {}});
  dJointSetFeedback(joint, &hinges_.back().feedback);
  dJointSetFeedback(rotor, &hinges_.back().rotor_feedback);
}

void OdeDynamics::move(std::size_t body, const Vector3d& by_m) {
  const Vector3d p = vector_of(dBodyGetPosition(handles_.at(body))) + by_m;
  dBodySetPosition(handles_[body], p.x(), p.y(), p.z());
  dBodySetLinearVel(handles_[body], 0, 0, 0);
  dBodySetAngularVel(handles_[body], 0, 0, 0);
  read_back();
}

// ODE bounds each of two friction forces separately, so that the bound on their sum is a square: up to sqrt 2 times the
// friction along its diagonals. With one of the two forces along the direction of sliding, the sum is right in each
// direction. The direction is that at the end of the step, if nothing but the external forces acts on the bodies.
Vector3d OdeDynamics::sliding_direction(const SolverContact& contact) const {
  constexpr double kStill_m_s = 1e-9;
  const auto free_velocity = [&](std::size_t body) -> Vector3d {
    if (body == kFixed) return Vector3d::Zero();
    dMass mass;
    dBodyGetMass(handles_[body], &mass);
    return bodies_[body].velocity_at(contact.touch.position_m) + settings_.step_s / mass.mass * external_[body].force_n;
  };
  const Vector3d& normal = contact.touch.normal;
  Vector3d sliding = free_velocity(contact.first) - free_velocity(contact.second);
  sliding -= normal.dot(sliding) * normal;
  if (sliding.norm() < kStill_m_s) sliding = normal.unitOrthogonal();
  return sliding.normalized();
}

void OdeDynamics::make_contact(const SolverContact& contact, dJointFeedback& feedback) {
  dContact made{};
  made.surface = surface_;
  made.surface.mu = contact.friction.along;
  if (contact.friction.isotropic) {
    copy(sliding_direction(contact), made.fdir1);
  } else {
    made.surface.mode |= dContactMu2;
    made.surface.mu2 = contact.friction.across;
    copy(contact.friction.direction, made.fdir1);
  }
  copy(contact.touch.position_m, made.geom.pos);
  copy(contact.touch.normal, made.geom.normal);
  made.geom.depth = contact.touch.depth_m;
  const dJointID joint = dJointCreateContact(world_.get(), group_.get(), &made);
  dJointAttach(joint, handle(contact.first), handle(contact.second));
  dJointSetFeedback(joint, &feedback);
}

void OdeDynamics::drive(Hinge& hinge, const ServoRow& row) {
  dJointSetHingeParam(hinge.joint, dParamVel, row.velocity_rad_s);
  dJointSetHingeParam(hinge.joint, dParamCFM, row.softness);
  dJointSetHingeParam(hinge.joint, dParamFMax, row.torque_limit_nm);
  const bool turns = row.inertia_nm_s_rad > 0.0;
  dJointSetAMotorParam(hinge.rotor, dParamVel, row.free_velocity_rad_s);
  dJointSetAMotorParam(hinge.rotor, dParamCFM, turns ? 1.0 / row.inertia_nm_s_rad : 1.0);
  dJointSetAMotorParam(hinge.rotor, dParamFMax, turns ? dInfinity : 0.0);
  if (!turns) hinge.rotor_feedback = {};  // ODE leaves it as it was
}

void OdeDynamics::step(std::span<const ServoRow> rows, std::span<const SolverContact> contacts) {
  for (std::size_t i = 0; i < hinges_.size(); ++i) drive(hinges_[i], rows[i]);
  for (std::size_t i = 0; i < handles_.size(); ++i) {
    const auto& [force_n, torque_nm] = external_[i];
    dBodyAddForce(handles_[i], force_n.x(), force_n.y(), force_n.z());
    dBodyAddTorque(handles_[i], torque_nm.x(), torque_nm.y(), torque_nm.z());
  }
  dJointGroupEmpty(group_.get());
  feedback_.resize(contacts.size());
  for (std::size_t i = 0; i < contacts.size(); ++i) make_contact(contacts[i], feedback_[i]);
  std::fill(external_.begin(), external_.end(), External{});

  // QuickStep reorders constraints with a random generator that all worlds of the process share. Each world restores
  // its own sequence, so that worlds in one process do not influence each other.
  dRandSetSeed(reorder_state_);
  if (dWorldQuickStep(world_.get(), settings_.step_s) == 0)
    throw std::runtime_error("ODE: dWorldQuickStep failed: out of memory");
  reorder_state_ = dRandGetSeed();

  forces_n_.resize(contacts.size());
  for (std::size_t i = 0; i < contacts.size(); ++i) {
    const dJointFeedback& feedback = feedback_[i];
    // ODE makes the moving body the first one of the joint. No contact has a fixed first body.
    forces_n_[i] = vector_of(feedback.f1);
  }
  read_back();
  for (std::size_t i = 0; i < hinges_.size(); ++i) torques_nm_[i] = hinges_[i].measured_torque_nm();
}

double OdeDynamics::Hinge::measured_torque_nm() const {
  // The joint's wrench on the module ahead acts at the centre of that module; move it to the anchor and project it on
  // the axis.
  dVector3 anchor;
  dVector3 axis;
  dJointGetHingeAnchor(joint, anchor);
  dJointGetHingeAxis(joint, axis);
  const dReal* centre = dBodyGetPosition(ahead);
  const dReal r[3] = {anchor[0] - centre[0], anchor[1] - centre[1], anchor[2] - centre[2]};
  const dReal* f = feedback.f1;
  const dReal* t = feedback.t1;
  const dReal* of_rotor = rotor_feedback.t1;
  return axis[0] * (t[0] + of_rotor[0] - (r[1] * f[2] - r[2] * f[1])) +
         axis[1] * (t[1] + of_rotor[1] - (r[2] * f[0] - r[0] * f[2])) +
         axis[2] * (t[2] + of_rotor[2] - (r[0] * f[1] - r[1] * f[0]));
}

void OdeDynamics::read_back() {
  for (std::size_t i = 0; i < handles_.size(); ++i) {
    BodyMotion& body = bodies_[i];
    const dReal* q = dBodyGetQuaternion(handles_[i]);
    const dReal* R = dBodyGetRotation(handles_[i]);  // 3x4, row-major
    body.position_m = vector_of(dBodyGetPosition(handles_[i]));
    body.q_WB = Eigen::Quaterniond(q[0], q[1], q[2], q[3]);
    body.R_WB << R[0], R[1], R[2], R[4], R[5], R[6], R[8], R[9], R[10];
    body.velocity_m_s = vector_of(dBodyGetLinearVel(handles_[i]));
    body.angular_velocity_rad_s = vector_of(dBodyGetAngularVel(handles_[i]));
  }
  for (std::size_t i = 0; i < hinges_.size(); ++i) {
    angles_rad_[i] = dJointGetHingeAngle(hinges_[i].joint);
    rates_rad_s_[i] = dJointGetHingeAngleRate(hinges_[i].joint);
  }
}

std::vector<double> OdeDynamics::save() const {
  std::vector<double> memory;
  memory.reserve(1 + kBodyNumbers * handles_.size());
  memory.push_back(static_cast<double>(reorder_state_));  // 32 bits
  for (const dBodyID body : handles_) {
    const auto append = [&](const dReal* from, std::size_t count) { memory.insert(memory.end(), from, from + count); };
    append(dBodyGetPosition(body), 3);
    append(dBodyGetQuaternion(body), 4);
    append(dBodyGetRotation(body), 12);
    append(dBodyGetLinearVel(body), 3);
    append(dBodyGetAngularVel(body), 3);
  }
  return memory;
}

void OdeDynamics::load(std::span<const double> memory) {
  check_size(memory.size(), 1 + kBodyNumbers * handles_.size());
  reorder_state_ = static_cast<unsigned long>(memory[0]);
  for (std::size_t i = 0; i < handles_.size(); ++i) set_values(handles_[i], &memory[1 + kBodyNumbers * i]);
  read_back();
}

}  // namespace constrictor
