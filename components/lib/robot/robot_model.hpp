// The description of a robot from its YAML file: geometry, joints, skin, camera and sensor noise.
#pragma once

#include <Eigen/Core>
#include <cmath>
#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

namespace constrictor {

// A value that every robot file must state has no default here: it is 0 until load_robot() has set it.

enum class JointAxis { kYaw, kPitch };

/// One joint, between module i (head side) and module i + 1 (tail side).
struct JointModel {
  JointAxis axis = JointAxis::kYaw;
  double min_rad = 0.0;
  double max_rad = 0.0;
  double max_speed_rad_s = 0.0;
  double max_torque_nm = 0.0;
  // The servo: sim/world/servo.hpp has its equations. All values hold at the output of the gear.
  double position_gain_nm_rad = 0.0;    ///< torque for an error of the angle
  double velocity_gain_nm_s_rad = 0.0;  ///< torque for an error of the rate
  double rotor_inertia_kg_m2 = 0.0;     ///< of motor and gear
  double gear_friction_nm = 0.0;        ///< resists the motion of the joint
  double no_load_speed_rad_s = 0.0;     ///< at which the motor has no torque left; 0: the torque does not fall
  double stiffness_nm_rad = 0.0;        ///< stiffness of the series elastic element; 0: the joint has none and is rigid
  double damping_nm_s_rad = 0.0;        ///< damping of the series elastic element
  double backlash_rad = 0.0;            ///< play of the gear, in series with the elastic element; 0: none
  double encoder_step_rad = 0.0;        ///< resolution of measured angles; 0: exact

  /// The angle as the encoder measures it.
  [[nodiscard]] double measured_rad(double angle_rad) const {
    return encoder_step_rad > 0.0 ? encoder_step_rad * std::round(angle_rad / encoder_step_rad) : angle_rad;
  }
};

/// A pin-hole camera: that of the head, or a further one.
struct CameraModel {
  std::string name;        ///< of a further camera
  std::size_t module = 0;  ///< that carries the camera; 0: the head
  int width = 0;
  int height = 0;
  double horizontal_fov_rad = 0.0;
  Eigen::Vector3d p_HC{0.0, 0.0, 0.0};  ///< [m] optical centre C in the frame of the module; H is the head's frame
  double yaw_rad = 0.0;                 ///< rotation of the optical axis about z, positive left; the head's: 0
  double tilt_rad = 0.0;                ///< rotation of the optical axis downwards
  int period_ticks = 0;                 ///< ticks between two images; all cameras expose at the same ticks
  int latency_ticks = 0;                ///< ticks from exposure until the image is visible to its readers

  /// [pixel] focal length.
  [[nodiscard]] double focal_pixels() const { return 0.5 * width / std::tan(0.5 * horizontal_fov_rad); }
};

struct RobotModel {
  std::string name;
  std::size_t module_count = 0;
  double module_length_m = 0.0;  ///< from joint to joint
  double module_radius_m = 0.0;
  double module_belly_half_width_m = 0.0;  ///< of the flat underside that keeps a module from rolling; 0: round modules
  double module_mass_kg = 0.0;
  std::vector<JointModel> joints;            ///< module_count - 1 joints, from head to tail
  double friction_along = 0.0;               ///< Coulomb friction coefficient of the skin along the module's axis
  double friction_across = 0.0;              ///< Coulomb friction coefficient of the skin across the module's axis
  double torque_filter_s = 0.0;              ///< time constant of the low-pass filter of the measured joint torque
  CameraModel camera;                        ///< of the head; its number is 0
  std::vector<CameraModel> further_cameras;  ///< their numbers count from 1
  // Standard deviations of the sensor noise; 0: no noise.
  double joint_position_noise_rad = 0.0;
  double joint_torque_noise_nm = 0.0;
  bool contact_sensors = true;  ///< the skin feels contacts; otherwise ContactState.module_count is 0
  double contact_force_noise_n = 0.0;
  bool imu = true;  ///< the head has an inertial unit; otherwise no ImuState is published
  double imu_rate_noise_rad_s = 0.0;
  double imu_acceleration_noise_m_s2 = 0.0;
  double imu_yaw_drift_rad_sqrt_s = 0.0;  ///< random walk of the yaw of ImuState.orientation

  /// The camera of a number; null if the robot has none of it.
  [[nodiscard]] const CameraModel* camera_of(std::size_t number) const {
    if (number == 0) return &camera;
    return number <= further_cameras.size() ? &further_cameras[number - 1] : nullptr;
  }
  /// Indices into `joints` of the yaw joints, from head to tail.
  [[nodiscard]] std::vector<std::size_t> yaw_joints() const;
};

/// Neighbouring modules overlap at their joint, and modules two apart may touch at the joints' limits. Neither pair
/// makes contacts in a simulation: two modules do that are at least so many apart along the body.
inline constexpr std::size_t kNearestSelfContact = 3;

/// Reads and checks a robot file (YAML). Throws ConfigurationError that names file, line, key, found and accepted.
RobotModel load_robot(const std::filesystem::path& file);

}  // namespace constrictor
