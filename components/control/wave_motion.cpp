#include "control/wave_motion.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "robot/planar.hpp"
#include "robot/u_arms.hpp"

namespace constrictor {

namespace {

/// True if on this posture the coordinate along the head's direction differs from the arc length.
bool fields_differ(const YawChain& chain, const LinkArray& shape_rad) {
  constexpr double kAlike_m = 0.03;
  const LinkArray x = chain.coordinates(chain.headings(shape_rad));
  for (std::size_t k = 0; k < chain.link_count(); ++k) {
    if (std::abs(x[k] - chain.arc_coordinates()[k]) > kAlike_m) return true;
  }
  return false;
}

/// Raises or lowers the base of the U at a limited speed. A raised base does not drag sideways over the ground, and its
/// weight is on the arms, which push the body.
void advance_lift(const MethodInput& input, const LinkArray& base_rad, BodyState& body) {
  constexpr double kRate_rad_s = 0.05;
  JointArray target_rad{};
  if (const auto base = base_of(input, base_rad)) {
    const auto hinges =
        base_hinges(input.robot, input.chain.joint_index(base->first), input.chain.joint_index(base->last));
    // A pitch joint's positive angle lowers what is in front of it.
    for (std::size_t i = 0; hinges && i < hinges->size(); ++i) target_rad[(*hinges)[i]] = -input.gait.lift_rad;
  }
  for (std::size_t j = 0; j < input.robot.joints.size(); ++j)
    body.lift_rad[j] = approach(body.lift_rad[j], target_rad[j], kRate_rad_s * input.dt_s);
}

}  // namespace

std::optional<UBase> base_of(const MethodInput& input, const LinkArray& shape_rad) {
  std::optional<UBase> base;
  for (std::size_t k = 0; k < input.chain.joint_count(); ++k) {
    if (is_base(input, shape_rad[k])) base = UBase{base ? base->first : k, k};
  }
  return base;
}

double approach(double value, double target, double step) { return std::clamp(target, value - step, value + step); }

void advance_wave(const MethodInput& input, double field, BodyState& body) {
  const ControlConfig& c = input.config;
  const double dt_s = input.dt_s;
  Wave& wave = body.wave;
  // `field` chooses the argument of the wave (Wave::field): the coordinate along the head's direction, or the arc
  // length. On a bent posture the two can differ by whole wavelengths. Therefore the wave fades out before it changes.
  const bool fades = wave.field != field && fields_differ(input.chain, body.shape_rad);
  const double amplitude_rad = fades ? 0.0 : input.gait.amplitude_rad;
  wave.amplitude_rad = approach(wave.amplitude_rad, amplitude_rad, c.amplitude_rate_rad_s * dt_s);
  if (!fades || wave.amplitude_rad <= 0.0) wave.field = field;
  wave.wavelength_m = approach(wave.wavelength_m, input.gait.wavelength_m, c.wavelength_rate_m_s * dt_s);
  wave.curvature_1_m = approach(wave.curvature_1_m, input.gait.curvature_1_m, c.curvature_rate_1_ms * dt_s);
  body.frequency_hz = approach(body.frequency_hz, input.gait.frequency_hz, c.frequency_rate_hz_s * dt_s);
  wave.phase_rad = wrap_angle(wave.phase_rad + 2.0 * std::numbers::pi * body.frequency_hz * dt_s);
}

double advance_shape(const MethodInput& input, const LinkArray& target_rad, double rate_rad_s, BodyState& body) {
  double left_rad = 0.0;
  for (std::size_t k = 0; k < input.chain.joint_count(); ++k) {
    body.shape_rad[k] = approach(body.shape_rad[k], target_rad[k], rate_rad_s * input.dt_s);
    left_rad = std::max(left_rad, std::abs(target_rad[k] - body.shape_rad[k]));
  }
  return left_rad;
}

void fade_residual(const MethodInput& input, BodyState& body, Setpoints& setpoints) {
  for (std::size_t j = 0; j < input.robot.joints.size(); ++j) {
    body.residual_rad[j] = approach(body.residual_rad[j], 0.0, input.config.blend_rate_rad_s * input.dt_s);
    setpoints.position_rad[j] = body.residual_rad[j];
    setpoints.torque_limit_nm[j] = input.robot.joints[j].max_torque_nm;
  }
}

void ride(const MethodInput& input, const LinkArray& base_rad, BodyState& body, Setpoints& setpoints) {
  const LinkArray angle = input.chain.joint_angles(body.shape_rad, body.wave, input.config.weights);
  fade_residual(input, body, setpoints);
  advance_lift(input, base_rad, body);
  for (std::size_t j = 0; j < input.robot.joints.size(); ++j) setpoints.position_rad[j] += body.lift_rad[j];
  for (std::size_t k = 0; k < input.chain.joint_count(); ++k) {
    const std::size_t j = input.chain.joint_index(k);
    setpoints.position_rad[j] += angle[k];
    if (input.desired.torque_limit_nm > 0.0 && is_base(input, base_rad[k])) {
      setpoints.torque_limit_nm[j] = input.desired.torque_limit_nm;
    }
  }
}

LinkArray desired_shape(const msg::DesiredTrajectory& desired, const YawChain& chain) {
  LinkArray shape{};
  for (std::size_t k = 0; k < std::min<std::size_t>(desired.shape_count, chain.joint_count()); ++k) {
    shape[k] = desired.shape_rad[k];
  }
  return shape;
}

double desired_shape_rate(const MethodInput& input) {
  return input.desired.shape_rate_rad_s > 0.0 ? input.desired.shape_rate_rad_s : input.config.shape_rate_rad_s;
}

void keep_residual(const MethodInput& input, BodyState& body) {
  const LinkArray angle = input.chain.joint_angles(body.shape_rad, body.wave, input.config.weights);
  body.residual_rad = input.commanded_rad;
  for (std::size_t j = 0; j < input.robot.joints.size(); ++j) body.residual_rad[j] -= body.lift_rad[j];
  for (std::size_t k = 0; k < input.chain.joint_count(); ++k) body.residual_rad[input.chain.joint_index(k)] -= angle[k];
}

MethodProgress PostureMethod::step(const MethodInput& input, BodyState& body, Setpoints& setpoints) const {
  const LinkArray shape_rad = desired_shape(input.desired, input.chain);
  advance_wave(input, 1.0, body);
  const double left_rad = advance_shape(input, shape_rad, desired_shape_rate(input), body);
  ride(input, shape_rad, body, setpoints);
  return progress(left_rad, body);
}

}  // namespace constrictor
