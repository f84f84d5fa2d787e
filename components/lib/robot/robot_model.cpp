#include "robot/robot_model.hpp"

#include <fmt/format.h>

#include "configuration/configuration.hpp"
#include "constrictor/messages.hpp"
#include "robot/camera_view.hpp"
#include "robot/further_cameras.hpp"

namespace constrictor {
namespace {

// The wave of 8 modules of `mamba`, with 4 yaw joints, does not move them; 10 follow a line. A grasp needs a longer
// body, which navigation checks.
constexpr std::size_t kFewestYawJoints = 5;

JointModel read_joint(Configuration& joints) {
  JointModel joint;
  joint.min_rad = joints.number("min_rad", {-3.0, 0.0});
  joint.max_rad = joints.number("max_rad", {0.0, 3.0});
  joint.max_speed_rad_s = joints.number("max_speed_rad_s", {0.01, 50.0});
  joint.max_torque_nm = joints.number("max_torque_nm", {0.01, 100.0});
  joint.position_gain_nm_rad = joints.number("position_gain_nm_rad", {0.1, 100000.0});
  joint.velocity_gain_nm_s_rad = joints.number("velocity_gain_nm_s_rad", {0.0, 1000.0});
  joint.rotor_inertia_kg_m2 = joints.number("rotor_inertia_kg_m2", {0.0, 10.0}, 0.0);
  joint.gear_friction_nm = joints.number("gear_friction_nm", {0.0, 100.0}, 0.0);
  if (joint.gear_friction_nm >= joint.max_torque_nm) {
    throw joints.error(
        "gear_friction_nm",
        fmt::format("found {} Nm, accepted less than max_torque_nm ({} Nm): the motor would turn nothing",
                    joint.gear_friction_nm, joint.max_torque_nm));
  }
  joint.no_load_speed_rad_s = joints.number("no_load_speed_rad_s", {0.0, 100.0}, 0.0);
  if (joint.no_load_speed_rad_s > 0.0 && joint.no_load_speed_rad_s < joint.max_speed_rad_s) {
    throw joints.error("no_load_speed_rad_s",
                       fmt::format("found {} rad/s, accepted 0 (torque does not fall with speed), or at least "
                                   "max_speed_rad_s ({} rad/s), at which the motor must still turn",
                                   joint.no_load_speed_rad_s, joint.max_speed_rad_s));
  }
  joint.stiffness_nm_rad = joints.number("stiffness_nm_rad", {0.0, 10000.0}, 0.0);
  joint.damping_nm_s_rad = joints.number("damping_nm_s_rad", {0.0, 100.0}, 0.0);
  if (joint.stiffness_nm_rad == 0.0 && joint.damping_nm_s_rad > 0.0) {
    throw joints.error("damping_nm_s_rad", "found damping without stiffness_nm_rad, accepted 0 for a stiff joint");
  }
  joint.backlash_rad = joints.number("backlash_rad", {0.0, 0.5}, 0.0);
  if (joint.stiffness_nm_rad == 0.0 && joint.backlash_rad > 0.0) {
    throw joints.error("backlash_rad", "found backlash without stiffness_nm_rad, which is the stiffness of the gear");
  }
  joint.encoder_step_rad = joints.number("encoder_step_rad", {0.0, 0.5}, 0.0);
  return joint;
}

CameraModel read_camera(Configuration camera, const RobotModel& robot) {
  CameraModel model;
  read_camera_image(camera, false, model);
  read_camera_place(camera, robot, model);
  read_camera_tilt(camera, model);
  model.period_ticks = static_cast<int>(camera.integer("period_ticks", 1, 1000));
  model.latency_ticks = static_cast<int>(camera.integer("latency_ticks", 1, 100));
  camera.finish();
  return model;
}

void read_noise(Configuration noise, RobotModel& robot) {
  robot.joint_position_noise_rad = noise.number("joint_position_rad", {0.0, 0.5}, 0.0);
  robot.joint_torque_noise_nm = noise.number("joint_torque_nm", {0.0, 10.0}, 0.0);
  robot.contact_force_noise_n = noise.number("contact_force_n", {0.0, 10.0}, 0.0);
  robot.imu_rate_noise_rad_s = noise.number("imu_rate_rad_s", {0.0, 1.0}, 0.0);
  robot.imu_acceleration_noise_m_s2 = noise.number("imu_acceleration_m_s2", {0.0, 10.0}, 0.0);
  robot.imu_yaw_drift_rad_sqrt_s = noise.number("imu_yaw_drift_rad_sqrt_s", {0.0, 0.1}, 0.0);
  noise.finish();
}

}  // namespace

std::vector<std::size_t> RobotModel::yaw_joints() const {
  std::vector<std::size_t> indices;
  for (std::size_t i = 0; i < joints.size(); ++i) {
    if (joints[i].axis == JointAxis::kYaw) indices.push_back(i);
  }
  return indices;
}

RobotModel load_robot(const std::filesystem::path& file) {
  Configuration root = Configuration::load(file);
  RobotModel robot;
  robot.name = root.text("name");

  Configuration module = root.section("module");
  robot.module_count = static_cast<std::size_t>(module.integer("count", 2, msg::kMaxModules));
  robot.module_length_m = module.number("length_m", {0.02, 1.0});
  robot.module_radius_m = module.number("radius_m", {0.005, 0.5});
  robot.module_belly_half_width_m = module.number("belly_half_width_m", {0.0, robot.module_radius_m});
  robot.module_mass_kg = module.number("mass_kg", {0.01, 20.0});
  module.finish();

  Configuration joints = root.section("joints");
  const std::vector<std::string> pattern = joints.texts("axes", {"yaw", "pitch"});
  if (pattern.empty()) throw joints.error("axes", "found a list of 0, accepted a list of yaw and pitch");
  robot.joints.assign(robot.module_count - 1, read_joint(joints));
  for (std::size_t i = 0; i < robot.joints.size(); ++i) {
    robot.joints[i].axis = pattern[i % pattern.size()] == "yaw" ? JointAxis::kYaw : JointAxis::kPitch;
  }
  if (robot.yaw_joints().size() < kFewestYawJoints) {
    throw module.error(
        "count", fmt::format("found {} modules with {} yaw joints, accepted a robot with at least {} yaw "
                             "joints ({} modules if the axes alternate)",
                             robot.module_count, robot.yaw_joints().size(), kFewestYawJoints, 2 * kFewestYawJoints));
  }
  robot.torque_filter_s = joints.number("torque_filter_s", {0.0, 5.0});
  joints.finish();

  Configuration skin = root.section("skin");
  robot.friction_along = skin.number("friction_along", {0.0, 5.0});
  robot.friction_across = skin.number("friction_across", {0.0, 5.0});
  robot.contact_sensors = skin.flag("contact_sensors", true);
  skin.finish();

  Configuration imu = root.section("imu", false);
  robot.imu = imu.flag("present", true);
  imu.finish();

  robot.camera = read_camera(root.section("camera"), robot);
  robot.further_cameras = read_further_cameras(root, robot);
  read_noise(root.section("noise", false), robot);
  root.finish();
  return robot;
}

}  // namespace constrictor
