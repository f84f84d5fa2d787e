#include "control/compound_wave.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "control/wave_motion.hpp"

namespace constrictor {
namespace {

// The method's own state in BodyState::scratch.
constexpr std::size_t kYawAmplitude = 0;    // [rad]
constexpr std::size_t kPitchAmplitude = 1;  // [rad]

constexpr double kTurn = 2.0 * std::numbers::pi;

}  // namespace

bool CompoundGait::accepts(const msg::DesiredTrajectory& desired, const YawChain& chain) const {
  if (!ControlMethod::accepts(desired, chain) || (needs_pitch_joints() && !chain.has_pitch_joints())) return false;
  return std::all_of(desired.shape_rad, desired.shape_rad + desired.shape_count, [](double q) { return q == 0.0; });
}

void CompoundGait::start(const MethodInput& input, BodyState& body) const {
  // The waves begin with an amplitude of 0, so all of the present posture is a remainder, which fades.
  body.residual_rad = input.commanded_rad;
  body.shape_rad = {};
  body.lift_rad = {};
  body.wave.amplitude_rad = 0.0;
}

MethodProgress CompoundGait::step(const MethodInput& input, BodyState& body, Setpoints& setpoints) const {
  advance_wave(input, 0.0, body);
  body.wave.amplitude_rad = 0.0;  // of the undulation, which does not take part
  const double spacing_m = input.robot.module_length_m;
  const double length_m = spacing_m * static_cast<double>(input.robot.module_count);
  const CompoundWave wave = this->wave(input.config, body.wave.curvature_1_m, length_m);
  const bool moves = input.gait.amplitude_rad > 0.0;
  const double step_rad = input.config.amplitude_rate_rad_s * input.dt_s;
  double& yaw_rad = body.scratch[kYawAmplitude];
  double& pitch_rad = body.scratch[kPitchAmplitude];
  yaw_rad = approach(yaw_rad, moves ? wave.yaw_rad : 0.0, step_rad);
  pitch_rad = approach(pitch_rad, moves ? wave.pitch_rad : 0.0, step_rad);
  const double wave_number = wave.wavelength_m > 0.0 ? kTurn / wave.wavelength_m : 0.0;
  const double bend_rad = wave.curvature_1_m * input.chain.link_length_m();
  fade_residual(input, body, setpoints);
  for (std::size_t j = 0; j < input.robot.joints.size(); ++j) {
    const double arc_m = static_cast<double>(j + 1) * spacing_m;
    const double argument = body.wave.phase_rad + wave_number * arc_m;
    const double amplitude_rad = yaw_rad * (1.0 + wave.cone * (2.0 * arc_m / length_m - 1.0));
    const double fold = wave.stretches ? std::cos(wave_number * arc_m) * 0.5 *
                                             (1.0 - std::cos(body.wave.phase_rad - kTurn * arc_m / length_m))
                                       : std::sin(argument);
    setpoints.position_rad[j] += input.robot.joints[j].axis == JointAxis::kYaw
                                     ? bend_rad + amplitude_rad * fold
                                     : pitch_rad * std::sin(argument + wave.lead_rad);
  }
  return {};
}

}  // namespace constrictor
