#include "control/control_config.hpp"

#include "configuration/configuration.hpp"

namespace constrictor {

ControlConfig load_control_config(const std::filesystem::path& file) {
  ControlConfig config;
  Configuration root = Configuration::load(file);
  Configuration wave = root.section("wave");
  config.weights.head = wave.numbers("head_weights", {0.0, 1.0}, 0, 16);
  config.weights.rigid_bend_rad = wave.number("rigid_bend_rad", {0.1, 3.2});
  config.amplitude_rate_rad_s = wave.number("amplitude_rate_rad_s", {0.01, 10.0});
  config.frequency_rate_hz_s = wave.number("frequency_rate_hz_s", {0.01, 10.0});
  config.wavelength_rate_m_s = wave.number("wavelength_rate_m_s", {0.01, 10.0});
  config.curvature_rate_1_ms = wave.number("curvature_rate_1_ms", {0.01, 20.0});
  wave.finish();
  Configuration posture = root.section("posture");
  config.shape_rate_rad_s = posture.number("shape_rate_rad_s", {0.01, 4.0});
  config.blend_rate_rad_s = posture.number("blend_rate_rad_s", {0.01, 4.0});
  posture.finish();
  Configuration squeeze = root.section("squeeze");
  config.base_bend_rad = squeeze.number("base_bend_rad", {0.1, 1.5});
  config.squeeze_rate_rad_s = squeeze.number("rate_rad_s", {0.001, 2.0});
  config.opening_share = squeeze.number("opening_share", {0.0, 1.0});
  squeeze.finish();
  Configuration safety = root.section("safety");
  config.speed_share = safety.number("speed_share", {0.01, 1.0});
  config.hold_after_ticks = safety.integer("hold_after_ticks", 2, 1000);
  config.relax_after_ticks = safety.integer("relax_after_ticks", config.hold_after_ticks, 100000);
  safety.finish();
  root.finish();
  return config;
}

}  // namespace constrictor
