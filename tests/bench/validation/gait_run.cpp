#include "bench/validation/gait_run.hpp"

#include <cmath>

namespace constrictor::validation {

using Eigen::Vector3d;

Gait lateral_gait(const RobotModel& robot, const LateralUndulation& gait) {
  return {gait.period_s(), [gait, yaw = robot.yaw_joints(), joints = robot.joints.size()](double time_s) {
            const JointMotion wave = gait.at(time_s, yaw.size());
            const auto n = static_cast<Eigen::Index>(joints);
            JointMotion motion{Eigen::VectorXd::Zero(n), Eigen::VectorXd::Zero(n), Eigen::VectorXd::Zero(n)};
            for (std::size_t k = 0; k < yaw.size(); ++k) {
              const auto from = static_cast<Eigen::Index>(k);
              const auto to = static_cast<Eigen::Index>(yaw[k]);
              motion.angle_rad[to] = wave.angle_rad[from];
              motion.rate_rad_s[to] = wave.rate_rad_s[from];
              motion.acceleration_rad_s2[to] = wave.acceleration_rad_s2[from];
            }
            return motion;
          }};
}

Gait open_loop_gait(const RobotModel& robot, OpenLoopGait gait) {
  const double period_s = kPeriod_s * std::round(1.0 / (gait.frequency_hz * kPeriod_s));
  gait.frequency_hz = 1.0 / period_s;
  return {period_s, [gait, robot](double time_s) {
            constexpr double kDelta_s = 1e-4;
            const auto at = [&](double t) {
              const std::vector<double> angles = gait.angles(robot, std::max(0.0, t));
              return Eigen::VectorXd(Eigen::VectorXd::Map(angles.data(), static_cast<Eigen::Index>(angles.size())));
            };
            const Eigen::VectorXd before = at(time_s - kDelta_s);
            const Eigen::VectorXd now = at(time_s);
            const Eigen::VectorXd after = at(time_s + kDelta_s);
            return JointMotion{now, (after - before) / (2.0 * kDelta_s),
                               (after - 2.0 * now + before) / (kDelta_s * kDelta_s)};
          }};
}

void drive(World& world, const Gait& gait, double time_s, const std::function<void()>& after_step) {
  const JointMotion next = gait.motion(time_s + kPeriod_s);
  std::vector<double> torques;
  for (const JointModel& joint : world.robot().joints) torques.push_back(joint.max_torque_nm);
  const auto span = [](const Eigen::VectorXd& v) {
    return std::span<const double>(v.data(), static_cast<std::size_t>(v.size()));
  };
  world.set_servo(span(next.angle_rad), span(next.rate_rad_s), torques);
  world.advance(kPeriod_s, after_step);
}

Vector3d centre_of(const World& world) {
  Vector3d sum = Vector3d::Zero();
  for (std::size_t i = 0; i < world.module_count(); ++i) sum += world.module_pose(i).translation();
  return sum / static_cast<double>(world.module_count());
}

double largest_joint_gap_m(const World& world) {
  const Vector3d half(0.5 * world.robot().module_length_m, 0.0, 0.0);
  double largest = 0.0;
  for (std::size_t i = 0; i + 1 < world.module_count(); ++i)
    largest = std::max(largest, (world.module_pose(i) * Vector3d(-half) - world.module_pose(i + 1) * half).norm());
  return largest;
}

std::vector<Vector3d> module_forces_n(const World& world, std::optional<Touched> touched) {
  std::vector<Vector3d> sums(world.module_count(), Vector3d::Zero());
  for (const ModuleContact& contact : world.contacts())
    if (!touched || contact.touched == *touched)
      sums[contact.module_index] += world.module_pose(contact.module_index).linear() * contact.force_n;
  return sums;
}

double ground_force_square_n2(const World& world) {
  const std::vector<Vector3d> forces_n = module_forces_n(world, Touched::kGround);
  double sum = 0.0;
  for (const Vector3d& force_n : forces_n) sum += force_n.squaredNorm();
  return sum / static_cast<double>(forces_n.size());
}

namespace {

/// Mean direction of the modules' axes: a unit vector.
Vector3d forward_of(const World& world) {
  Vector3d sum = Vector3d::Zero();
  for (std::size_t i = 0; i < world.module_count(); ++i) sum += world.module_pose(i).linear().col(0);
  return sum.normalized();
}

double kinetic_energy_j(const World& world) {
  const RobotModel& robot = world.robot();
  const double inertia = capsule_inertia(robot.module_mass_kg, robot.module_radius_m, robot.module_length_m);
  double sum = 0.0;
  for (std::size_t i = 0; i < world.module_count(); ++i) {
    sum += 0.5 * robot.module_mass_kg * world.module_velocity_m_s(i).squaredNorm() +
           0.5 * inertia * world.module_angular_velocity_rad_s(i).squaredNorm();
  }
  return sum;
}

}  // namespace

GaitMeasurement measure_gait(const RobotModel& robot, const Gait& gait, const SolverSettings& settings,
                             int settle_cycles, int cycles) {
  World world(robot, Scenario{}, settings);
  const auto ticks = static_cast<int>(std::lround(gait.period_s / kPeriod_s));
  const std::vector<std::size_t> yaw = robot.yaw_joints();
  int tick = 0;
  for (; tick < settle_cycles * ticks; ++tick) drive(world, gait, tick * kPeriod_s);
  GaitMeasurement found;
  found.duration_s = cycles * gait.period_s;
  const double kinetic_j = kinetic_energy_j(world);
  double step_squares = 0.0;
  double tick_squares = 0.0;
  std::vector<double> tick_torque_nm(yaw.size());  // sum over the steps of a tick
  double error_squares = 0.0;
  double force_squares = 0.0;
  int steps = 0;
  std::vector<double> rates(world.joint_count());
  for (std::size_t i = 0; i < rates.size(); ++i) rates[i] = world.joint_rate_rad_s(i);
  const auto after_step = [&] {
    ++steps;
    for (std::size_t i = 0; i < rates.size(); ++i) {
      // The work of a step is exact with the mean of the rates before and after it.
      const double rate = world.joint_rate_rad_s(i);
      found.work_j += settings.step_s * world.joint(i).step_torque_nm() * 0.5 * (rates[i] + rate);
      rates[i] = rate;
    }
    for (std::size_t k = 0; k < yaw.size(); ++k) {
      const double torque_nm = world.joint(yaw[k]).step_torque_nm();
      tick_torque_nm[k] += torque_nm;
      step_squares += torque_nm * torque_nm;
    }
    found.friction_j -= settings.step_s * world.contact_power_w();
  };
  for (int cycle = 0; cycle < cycles; ++cycle) {
    const Vector3d from = centre_of(world);
    const Vector3d forward = forward_of(world);
    for (int i = 0; i < ticks; ++i, ++tick) {
      std::fill(tick_torque_nm.begin(), tick_torque_nm.end(), 0.0);
      const int steps_before = steps;
      drive(world, gait, tick * kPeriod_s, after_step);
      for (const double sum : tick_torque_nm) tick_squares += sum * sum / (steps - steps_before);
      const JointMotion now = gait.motion((tick + 1) * kPeriod_s);
      for (const std::size_t joint : yaw)
        error_squares += std::pow(now.angle_rad[static_cast<Eigen::Index>(joint)] - world.joint_angle_rad(joint), 2);
      found.joint_gap_m = std::max(found.joint_gap_m, largest_joint_gap_m(world));
      force_squares += ground_force_square_n2(world);
      for (const ModuleContact& contact : world.contacts()) {
        const Vector3d force_W = world.module_pose(contact.module_index).linear() * contact.force_n;
        found.vertical_force_n += force_W.z() / (cycles * ticks);
      }
    }
    found.speed_m_s += forward.dot(centre_of(world) - from) / found.duration_s;
  }
  const auto joints = static_cast<double>(yaw.size());
  found.torque_rms_nm = std::sqrt(tick_squares / (joints * steps));
  found.ripple_nm = std::sqrt(std::max(0.0, step_squares - tick_squares) / (joints * steps));
  found.tracking_rad = std::sqrt(error_squares / (joints * cycles * ticks));
  found.ground_force_n = std::sqrt(force_squares / (cycles * ticks));
  found.kinetic_change_j = kinetic_energy_j(world) - kinetic_j;
  return found;
}

}  // namespace constrictor::validation
