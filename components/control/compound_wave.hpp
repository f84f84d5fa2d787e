// Gaits that also move the pitch joints: one travelling wave in the yaw joints and one in the pitch joints.
#pragma once

#include "control/control_method.hpp"

namespace constrictor {

/// Two waves of the joint angles with a common frequency and wavelength:
///
///     yaw joint at arc length s:    bend + amplitude(s) sin(phase + 2 pi s / lambda)
///     pitch joint at arc length s:  pitch_rad sin(phase + 2 pi s / lambda + lead)
///
/// A rising phase moves the waves towards the head. If the body `stretches`, the folds of the yaw joints stand still on
/// the body, and the place where they are straight travels towards the tail, once along the body in a period of the
/// phase:
///
///     yaw joint at arc length s:    bend + amplitude(s) cos(2 pi s / lambda) (1 - cos(phase - 2 pi s / length)) / 2
///
/// Source: the compound serpenoid curve of M. Tesch et al., "Parameterized and scripted gaits for modular snake
/// robots", Advanced Robotics 23 (2009), 1131-1158.
struct CompoundWave {
  double yaw_rad = 0.0;       ///< amplitude of the yaw joints in the middle of the body
  double pitch_rad = 0.0;     ///< amplitude of the pitch joints
  double wavelength_m = 0.0;  ///< 0: all joints move in phase
  double lead_rad = 0.0;      ///< by which the pitch joints are ahead of the yaw joints
  double cone = 0.0;          ///< share by which the yaw amplitude is greater at the tail than in the middle, -1 to 1
  bool stretches = false;
  double curvature_1_m = 0.0;  ///< of the body, positive to the left: added to the yaw joints as a constant bend
};

/// A gait of such waves. It moves a body without an object: it refuses trajectories with a posture, and robots without
/// pitch joints if it has a vertical wave. The gait gives the frequency (its sign is the direction) and the curvature
/// of the path; an amplitude of 0 stops the waves. The form of the waves is in the configuration. It is never done.
class CompoundGait : public ControlMethod {
 public:
  [[nodiscard]] bool accepts(const msg::DesiredTrajectory& desired, const YawChain& chain) const final;
  void start(const MethodInput& input, BodyState& body) const final;
  MethodProgress step(const MethodInput& input, BodyState& body, Setpoints& setpoints) const final;

 protected:
  /// Whether the gait has a vertical wave.
  [[nodiscard]] virtual bool needs_pitch_joints() const { return true; }
  /// `curvature_1_m` of the path, positive to the left of the direction in which the gait moves with a positive
  /// frequency; `length_m` of the body.
  [[nodiscard]] virtual CompoundWave wave(const ControlConfig& config, double curvature_1_m, double length_m) const = 0;
};

}  // namespace constrictor
