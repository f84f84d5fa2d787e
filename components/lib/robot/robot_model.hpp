// The robot as its YAML file describes it: geometry, joints, sensors. Lengths in m, masses in kg, angles in rad.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

namespace constrictor {

enum class JointAxis { kYaw, kPitch };

/// One joint, between module i (head side) and module i + 1 (tail side).
struct JointModel {
  JointAxis axis = JointAxis::kYaw;
  double min_rad = -1.57;
  double max_rad = 1.57;
  double max_speed_rad_s = 4.0;
  double max_torque_nm = 6.0;
  double servo_gain_1_s = 20.0;   ///< motor velocity = clamp(gain (reference - angle) + feed-forward)
  double stiffness_nm_rad = 0.0;  ///< series elasticity; 0: stiff
  double damping_nm_s_rad = 0.0;  ///< of the series elastic element
};

/// Pin-hole camera in the head.
struct CameraModel {
  int width = 320;
  int height = 240;
  double horizontal_fov_rad = 1.57;
  Eigen::Vector3d p_HC{0.03, 0.0, 0.05};  ///< optical centre in the head's frame
  double tilt_rad = 0.3;                  ///< downwards
  int period_ticks = 5;
  int latency_ticks = 2;
};

struct RobotModel {
  std::string name;
  std::size_t module_count = 0;
  double module_length_m = 0.0;  ///< joint to joint
  double module_radius_m = 0.0;
  double module_belly_half_width_m = 0.0;  ///< of the flat underside on which a module stands against rolling; 0: round
  double module_mass_kg = 0.0;
  std::vector<JointModel> joints;  ///< module_count - 1, head to tail
  double friction_along = 0.05;    ///< anisotropic skin: Coulomb coefficient along the module's axis
  double friction_across = 0.5;
  double torque_filter_s = 0.15;  ///< low-pass of the measured joint torque
  CameraModel camera;
  // sensor noise, standard deviations; zero: off
  double joint_position_noise_rad = 0.0;
  double joint_torque_noise_nm = 0.0;
  double contact_force_noise_n = 0.0;
  double imu_rate_noise_rad_s = 0.0;
  double imu_acceleration_noise_m_s2 = 0.0;
  double imu_yaw_drift_rad_sqrt_s = 0.0;  ///< random walk of the yaw of ImuState.orientation

  /// Indices of the yaw joints, head to tail.
  [[nodiscard]] std::vector<std::size_t> yaw_joints() const;
};

/// Reads and checks a robot file. Throws ConfigurationError.
RobotModel load_robot(const std::filesystem::path& file);

}  // namespace constrictor
