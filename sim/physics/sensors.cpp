#include "sim/physics/sensors.hpp"

#include <algorithm>
#include <cmath>

#include "robot/planar_message.hpp"
#include "robot/pose_message.hpp"
#include "robot/rotation.hpp"

namespace constrictor {
namespace {

static_assert(static_cast<std::uint8_t>(Touched::kGround) == msg::kTouchedGround);
static_assert(static_cast<std::uint8_t>(Touched::kSelf) == msg::kTouchedSelf);
static_assert(static_cast<std::uint8_t>(Touched::kObject) == msg::kTouchedObject);
static_assert(static_cast<std::uint8_t>(Touched::kObstacle) == msg::kTouchedObstacle);

msg::Quaternion quaternion(const Eigen::Quaterniond& q) { return {q.w(), q.x(), q.y(), q.z()}; }

void add(msg::Vector3& sum, const Eigen::Vector3d& v) {
  sum.x += v.x();
  sum.y += v.y();
  sum.z += v.z();
}

}  // namespace

Sensors::Sensors(const RobotModel& robot, std::uint64_t seed, bool noise)
    : robot_(robot),
      noise_(noise),
      joint_random_(seed, "joints"),
      contact_random_(seed, "contacts"),
      imu_random_(seed, "imu") {}

Eigen::Vector3d Sensors::noisy(const Eigen::Vector3d& value, double sd, Random& random) const {
  if (!noise_ || sd == 0.0) return value;
  const double x = random.normal();
  const double y = random.normal();
  return value + sd * Eigen::Vector3d(x, y, random.normal());
}

msg::JointState Sensors::joints(const World& world) {
  msg::JointState state{};
  state.joint_count = static_cast<std::uint16_t>(world.joint_count());
  for (std::size_t i = 0; i < world.joint_count(); ++i) {
    state.position_rad[i] = world.joint_angle_rad(i);
    state.velocity_rad_s[i] = world.joint_rate_rad_s(i);
    state.torque_nm[i] = world.joint_torque_nm(i);
    if (noise_) {
      state.position_rad[i] += robot_.joint_position_noise_rad * joint_random_.normal();
      state.torque_nm[i] += robot_.joint_torque_noise_nm * joint_random_.normal();
    }
    state.position_rad[i] = robot_.joints[i].measured_rad(state.position_rad[i]);
  }
  return state;
}

void Sensors::contacts(const World& world, msg::ContactState& felt, msg::TouchedState& touched) {
  if (!robot_.contact_sensors) return;
  felt.module_count = static_cast<std::uint16_t>(world.module_count());
  for (const ModuleContact& contact : world.contacts()) {
    const Eigen::Vector3d force = noisy(contact.force_n, robot_.contact_force_noise_n, contact_random_);
    add(felt.force_n[contact.module_index], force);
    add(felt.torque_nm[contact.module_index], contact.position_m.cross(force));
    if (felt.contact_count == msg::kMaxContacts) continue;
    touched.kind[felt.contact_count] = static_cast<std::uint8_t>(contact.touched);
    touched.index[felt.contact_count] = contact.touched_index;
    felt.contacts[felt.contact_count++] = {contact.module_index, vector3(contact.position_m), vector3(contact.normal),
                                           vector3(force)};
  }
  touched.contact_count = felt.contact_count;
}

msg::ImuState Sensors::imu(const World& world, double elapsed_s) {
  ImuTruth truth = world.imu();
  // An inertial unit measures its orientation relative to gravity, which a slope tilts relative to W.
  if (truth.up_W != Eigen::Vector3d::UnitZ())
    truth.q_WHead = shortest_rotation(truth.up_W, Eigen::Vector3d::UnitZ()) * truth.q_WHead;
  if (!started_) {
    started_ = true;
    start_yaw_rad_ = yaw_of(quaternion(truth.q_WHead));
  } else if (noise_) {
    yaw_drift_rad_ += robot_.imu_yaw_drift_rad_sqrt_s * std::sqrt(elapsed_s) * imu_random_.normal();
  }
  const double turn = yaw_drift_rad_ - start_yaw_rad_;
  const Eigen::Quaterniond q_StartW(std::cos(0.5 * turn), 0.0, 0.0, std::sin(0.5 * turn));
  msg::ImuState state{};
  state.orientation = quaternion((q_StartW * truth.q_WHead).normalized());
  state.angular_velocity_rad_s = vector3(noisy(truth.angular_velocity_rad_s, robot_.imu_rate_noise_rad_s, imu_random_));
  state.linear_acceleration_m_s2 =
      vector3(noisy(truth.proper_acceleration_m_s2, robot_.imu_acceleration_noise_m_s2, imu_random_));
  return state;
}

msg::WorldState world_state(const World& world) {
  msg::WorldState state{};
  state.module_count = static_cast<std::uint16_t>(world.module_count());
  for (std::size_t i = 0; i < world.module_count(); ++i) state.module_poses[i] = pose_message(world.module_pose(i));
  state.object_count = static_cast<std::uint16_t>(world.object_count());
  for (std::size_t i = 0; i < world.object_count(); ++i) {
    state.object_poses[i] = pose_message(world.object_pose(i));
    state.object_velocities_m_s[i] = vector3(world.object_velocity_m_s(i));
  }
  std::copy(world.state_hash().begin(), world.state_hash().end(), state.state_hash);
  return state;
}

}  // namespace constrictor
