#include "bench/validation/carrying.hpp"

#include <array>
#include <cmath>
#include <numbers>
#include <span>

#include "control/joint_limiter.hpp"
#include "control/yaw_chain.hpp"

namespace constrictor::validation {
namespace {

using Eigen::Vector3d;

// Times of the phases, from the beginning. The object is squeezed with the bend's torque limited, and carried with a
// lower limit, as control does.
constexpr double kBent_s = 6.0;
constexpr double kSqueezed_s = 14.0;
constexpr double kMeasured_s = 18.0;
constexpr double kEnd_s = 28.0;

constexpr double kObjectRadius_m = 0.085;
constexpr double kBend_rad = 1.047;                   // of each joint of the base
constexpr double kSqueeze_rad = 0.35;                 // in addition, summed over the base
constexpr double kSqueezeRate_rad_s = 0.1;            // the same
constexpr double kOpeningShare = 0.25;                // of the squeeze, by which each neighbour of the base opens
constexpr std::array<std::size_t, 3> kBase{5, 6, 7};  // yaw joints, counted from the head
constexpr std::size_t kMiddleModule = 13;

Scenario with_object_beside_the_body(const RobotModel& robot) {
  Scenario scenario;
  ScenarioObject object;
  object.size_m = {kObjectRadius_m, kObjectRadius_m, 0.15};
  object.mass_kg = 0.4;
  object.position_m = {-robot.module_length_m * kMiddleModule, robot.module_radius_m + kObjectRadius_m + 0.01};
  scenario.objects.push_back(object);
  return scenario;
}

/// The setpoints over time: postures, the wave on them, and torque limits.
class CarryingMotion {
 public:
  CarryingMotion(const RobotModel& robot, const ControlConfig& control)
      : chain_(robot),
        joints_(robot.joints.size()),
        limit_nm_(robot.joints[0].max_torque_nm),
        control_(control),
        limiter_(robot, control.speed_share, control.lead_s) {}

  [[nodiscard]] std::size_t base_joint(std::size_t k) const { return chain_.joint_index(kBase[k]); }

  /// Drives the world for one control period that ends at `time_s`.
  void drive(World& world, double time_s) {
    const double squeeze_rad = std::clamp((time_s - kBent_s - 1.0) * kSqueezeRate_rad_s, 0.0, kSqueeze_rad);
    const double bend_rad = kBend_rad * std::min(1.0, time_s / (kBent_s - 1.0));
    LinkArray posture{};
    for (const std::size_t joint : kBase) posture[joint] = bend_rad + squeeze_rad / kBase.size();
    posture[kBase.front() - 1] = posture[kBase.back() + 1] = -kOpeningShare * squeeze_rad;
    const bool carries = time_s >= kSqueezed_s;
    const double grown = std::clamp((time_s - kSqueezed_s) / 2.0, 0.0, 1.0);
    wave_.amplitude_rad = time_s < kBent_s ? 0.0 : std::lerp(0.35, control_.carry.amplitude_rad, grown);
    wave_.wavelength_m = std::lerp(1.07, control_.carry.wavelength_m, grown);
    wave_.phase_rad += 2.0 * std::numbers::pi * (carries ? 1.1 : 0.4) * kPeriod_s;
    const LinkArray yaw = chain_.joint_angles(posture, wave_, control_.weights);

    Setpoints wanted;
    JointArray measured_rad{};
    for (std::size_t j = 0; j < joints_; ++j) {
      wanted.torque_limit_nm[j] = limit_nm_;
      measured_rad[j] = world.joint_angle_rad(j);
    }
    for (std::size_t k = 0; k < chain_.joint_count(); ++k) wanted.position_rad[chain_.joint_index(k)] = yaw[k];
    // The pitch joints on either side of the base: a negative angle raises the base.
    wanted.position_rad[base_joint(0) - 1] = wanted.position_rad[base_joint(kBase.size() - 1) + 1] =
        -grown * control_.lift_rad;
    if (time_s >= kBent_s) {
      for (std::size_t k = 0; k < kBase.size(); ++k) wanted.torque_limit_nm[base_joint(k)] = carries ? 1.5 : 2.5;
    }
    const msg::JointCommand command = limiter_.limit(wanted, measured_rad, kPeriod_s, limited_);
    world.set_servo(std::span(command.position_rad).first(joints_), std::span(command.velocity_rad_s).first(joints_),
                    std::span(command.torque_limit_nm).first(joints_));
    world.advance(kPeriod_s);
  }

 private:
  YawChain chain_;
  std::size_t joints_;
  double limit_nm_;
  ControlConfig control_;
  JointLimiter limiter_;
  LimiterState limited_;
  Wave wave_;
};

double object_force_n(const World& world) {
  double sum = 0.0;
  for (const ModuleContact& contact : world.contacts())
    sum += contact.touched == Touched::kObject ? contact.force_n.norm() : 0.0;
  return sum;
}

}  // namespace

CarryingMeasurement measure_carrying(const RobotModel& robot, const SolverSettings& settings,
                                     const ControlConfig& control) {
  World world(robot, with_object_beside_the_body(robot), settings);
  CarryingMotion motion(robot, control);
  const std::vector<std::size_t> yaw = robot.yaw_joints();
  const int settle_ticks = static_cast<int>(std::lround(kMeasured_s / kPeriod_s));
  const int ticks = static_cast<int>(std::lround((kEnd_s - kMeasured_s) / kPeriod_s));
  const auto object_in_bend = [&] {
    return Eigen::Vector2d((world.module_pose(kMiddleModule).inverse() * world.object_pose(0).translation()).head<2>());
  };
  int tick = 0;
  for (; tick < settle_ticks; ++tick) motion.drive(world, (tick + 1) * kPeriod_s);
  CarryingMeasurement found;
  const Eigen::Vector2d held_m = object_in_bend();
  Vector3d last_m = centre_of(world);
  double torque_squares = 0.0;
  double force_squares = 0.0;
  for (int i = 1; i <= ticks; ++i, ++tick) {
    motion.drive(world, (tick + 1) * kPeriod_s);
    for (const std::size_t joint : yaw) torque_squares += std::pow(world.joint_torque_nm(joint), 2);
    for (std::size_t k = 0; k < kBase.size(); ++k)
      found.base_torque_nm +=
          std::abs(world.joint_torque_nm(motion.base_joint(k))) / static_cast<double>(kBase.size() * ticks);
    force_squares += ground_force_square_n2(world);
    found.object_force_n += object_force_n(world) / ticks;
    found.joint_gap_m = std::max(found.joint_gap_m, largest_joint_gap_m(world));
    if (i % 50 != 0) continue;
    found.speed_m_s += (centre_of(world) - last_m).norm() / (kEnd_s - kMeasured_s);
    last_m = centre_of(world);
  }
  found.torque_rms_nm = std::sqrt(torque_squares / static_cast<double>(yaw.size() * ticks));
  found.ground_force_n = std::sqrt(force_squares / ticks);
  found.slip_m = (object_in_bend() - held_m).norm();
  found.unsolved = world.dynamics().unsolved();
  return found;
}

}  // namespace constrictor::validation
