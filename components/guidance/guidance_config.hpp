// Parameters of guidance, read from guidance.yaml.
#pragma once

#include <filesystem>

#include "guidance/odometry.hpp"

namespace constrictor::guidance {

/// Units and meaning: guidance.yaml.
struct GuidanceConfig {
  OdometryConfig odometry;
  double speed_sd = 0.08;
  double speed_sd_m_s = 0.01;
  double correlation_s = 0.7;
  double yaw_sd_rad_sqrt_s = 0.003;
  double speed_window_s = 1.5;

  double bearing_sd_rad = 0.02;
  double range_sd_m = 0.015;
  double range_sd_1_m = 0.04;
  double inflation = 4.0;
  double max_range_m = 2.5;
  double gate = 11.8;
  double merge_m = 0.5;
  int confirm = 3;

  double line_spacing_m = 0.05;
  double line_map_range_m = 0.9;
  double line_correct_after_s = 10.0;
  double line_correct_sd_m = 0.03;
  double line_correct_gate_m = 0.2;

  double touch_min_force_n = 0.4;
  double touch_max_normal_z = 0.5;
  double touch_self_margin_m = 0.012;
  double touch_keep_s = 4.0;
};

/// Throws ConfigurationError.
GuidanceConfig load_guidance_config(const std::filesystem::path& file);

}  // namespace constrictor::guidance
