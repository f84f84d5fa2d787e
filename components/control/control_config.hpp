// Parameters of control, read from control.yaml.
#pragma once

#include <cstdint>
#include <filesystem>

#include "control/yaw_chain.hpp"

namespace constrictor {

struct ControlConfig {
  WaveWeights weights;
  // ramps: how fast parameters of the wave may change
  double amplitude_rate_rad_s = 0.5;
  double frequency_rate_hz_s = 1.0;
  double wavelength_rate_m_s = 0.5;
  double curvature_rate_1_ms = 1.5;   ///< [1/m/s]
  double shape_rate_rad_s = 0.5;      ///< of each joint of the posture, unless the trajectory names its own
  double blend_rate_rad_s = 0.5;      ///< at which what is left of an earlier posture fades from each joint
  // grasp
  double base_bend_rad = 0.5;         ///< joints of the posture bent by more than this are the base of a U
  double squeeze_rate_rad_s = 0.1;    ///< total over the base joints
  double opening_share = 0.5;         ///< of the squeeze, by which the two joints beside the base open, in total
  // safety
  double speed_share = 1.0;           ///< of the servos' maximum speed
  std::int64_t hold_after_ticks = 10;    ///< age of the newest desired trajectory at which the posture is held
  std::int64_t relax_after_ticks = 250;  ///< age at which the joints are let go
};

/// Throws ConfigurationError.
ControlConfig load_control_config(const std::filesystem::path& file);

}  // namespace constrictor
