#include "control/motion_gait.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <numbers>

#include "robot/trajectory_path.hpp"

namespace constrictor {
namespace {

/// A kind of motion along a path.
struct Kind {
  std::string_view name;
  MotionParameters ControlConfig::*parameters;
  bool has_choice;  ///< its method is a parameter
  bool lifts;       ///< the base of the U is raised; if the robot must not drift aside, the base stays on the ground
};
constexpr Kind kKinds[] = {
    {"travel", &ControlConfig::travel, true, false},   {"carry", &ControlConfig::carry, true, true},
    {"creep", &ControlConfig::creep, true, false},     {"wrap", &ControlConfig::wrap, false, false},
    {"seat", &ControlConfig::seat, true, true},        {"squeeze", &ControlConfig::squeeze, false, false},
    {"deliver", &ControlConfig::deliver, true, false}, {"leave", &ControlConfig::leave, true, true}};

/// Null for every other kind of motion.
const Kind* kind_of(std::string_view motion) {
  const Kind* kind =
      std::find_if(std::begin(kKinds), std::end(kKinds), [&](const Kind& k) { return k.name == motion; });
  return kind == std::end(kKinds) ? nullptr : kind;
}

/// The gait with an amplitude, and if necessary a frequency, with which the body keeps this lateral acceleration.
Gait limited(const Gait& gait, double acceleration_m_s2) {
  const double share = acceleration_m_s2 / lateral_acceleration_m_s2(gait);
  if (!(share < 1.0)) return gait;
  // A smaller wave carries farther than a slower one of the same acceleration, unless it is so small that it slips.
  constexpr double kLeastAmplitude_rad = 0.4;
  const double amplitude_rad = share * gait.amplitude_rad;
  Gait slower = gait;
  slower.amplitude_rad = std::max(amplitude_rad, std::min(gait.amplitude_rad, kLeastAmplitude_rad));
  slower.frequency_hz *= std::sqrt(amplitude_rad / slower.amplitude_rad);
  return slower;
}

}  // namespace

bool drives(std::string_view motion) {
  const Kind* kind = kind_of(motion);
  return kind && kind->has_choice;
}

std::string_view method_of(std::string_view motion, const ControlConfig& config) {
  if (motion == "stand") return "hold";
  const Kind* kind = kind_of(motion);
  return kind && kind->has_choice ? std::string_view(drive_methods().at((config.*kind->parameters).method)) : motion;
}

Gait gait_of(const msg::DesiredTrajectory& desired, const ControlConfig& config) {
  const Kind* kind = kind_of(desired.motion);
  const MotionParameters& parameters = kind ? config.*kind->parameters : config.travel;
  Gait gait;
  gait.wavelength_m = parameters.wavelength_m;
  gait.curvature_1_m = pursuit_curvature_1_m(desired, config.lookahead_m);
  if (desired.point_count > 1) {
    const double most_1_m = desired.shape_count > 0 ? config.carry_curvature_1_m : config.most_curvature_1_m;
    gait.curvature_1_m = std::clamp(gait.curvature_1_m, -most_1_m, most_1_m);
  }
  if (desired.speed_m_s == 0.0) return gait;
  gait.frequency_hz = std::clamp(desired.speed_m_s / parameters.advance_m, -config.most_hz, config.most_hz);
  gait.amplitude_rad = parameters.amplitude_rad;
  if (kind && kind->lifts) gait.lift_rad = config.lift_rad;
  return desired.acceleration_m_s2 > 0.0 ? limited(gait, desired.acceleration_m_s2) : gait;
}

double lateral_acceleration_m_s2(const Gait& gait) {
  return 2.0 * std::numbers::pi * gait.amplitude_rad * gait.wavelength_m * gait.frequency_hz * gait.frequency_hz;
}

}  // namespace constrictor
