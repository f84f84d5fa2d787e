#include "control/control_parameters.hpp"

namespace constrictor {

void add_parameters(ControlConfig& c, Parameters& p) {
  p.add(c.amplitude_rate_rad_s, "wave.amplitude_rate_rad_s", "rad/s", {0.01, 10.0}, "how fast the wave's amplitude may change");
  p.add(c.frequency_rate_hz_s, "wave.frequency_rate_hz_s", "Hz/s", {0.01, 10.0}, "how fast its frequency may change");
  p.add(c.wavelength_rate_m_s, "wave.wavelength_rate_m_s", "m/s", {0.01, 10.0}, "how fast its length may change");
  p.add(c.curvature_rate_1_ms, "wave.curvature_rate_1_ms", "1/(m s)", {0.01, 20.0}, "how fast the path's curvature may change");
  p.add(c.shape_rate_rad_s, "posture.shape_rate_rad_s", "rad/s", {0.01, 4.0}, "of each joint towards a posture, unless the trajectory says");
  p.add(c.blend_rate_rad_s, "posture.blend_rate_rad_s", "rad/s", {0.01, 4.0}, "at which an earlier posture fades");
  p.add(c.squeeze_rate_rad_s, "squeeze.rate_rad_s", "rad/s", {0.001, 2.0}, "of the squeeze, in total over the base's joints");
  p.add(c.opening_share, "squeeze.opening_share", "", {0.0, 1.0}, "of the squeeze, by which the joints beside the base open");
}

}  // namespace constrictor
