// "sidewinding": the body rolls over the ground sideways, on a few places that it lifts and puts down again. No part of
// it slides, so that it needs no particular skin. With a positive frequency the robot moves to its left. Source: J. W.
// Burdick, J. Radford and G. S. Chirikjian, "A sidewinding locomotion gait for hyper-redundant robots", Advanced
// Robotics 9 (1995), 195-216.
#include <algorithm>
#include <numbers>

#include "control/compound_wave.hpp"

namespace constrictor {
namespace {

class Sidewinding : public CompoundGait {
 public:
  std::string_view name() const override { return "sidewinding"; }

 protected:
  CompoundWave wave(const ControlConfig& config, double curvature_1_m, double length_m) const override {
    CompoundWave wave;
    wave.yaw_rad = config.sidewinding_yaw_rad;
    wave.pitch_rad = config.sidewinding_pitch_rad;
    wave.wavelength_m = config.sidewinding_wavelength_m;
    wave.lead_rad = -0.5 * std::numbers::pi;
    // Each part moves sideways about in proportion to its amplitude. A body that moves to its left turns to the left
    // when its head moves faster than its tail.
    constexpr double kMostCone = 0.8;
    wave.cone = std::clamp(-0.5 * curvature_1_m * length_m, -kMostCone, kMostCone);
    return wave;
  }
};

}  // namespace

std::unique_ptr<ControlMethod> make_sidewinding() { return std::make_unique<Sidewinding>(); }

}  // namespace constrictor
