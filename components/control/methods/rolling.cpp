// "rolling": the body forms an arc and turns about its own axis, so that it rolls sideways like a bent log. With a
// positive frequency f the robot moves to its left, at 2 pi f times the radius of a module. It cannot be steered: the
// curvature of the path does not count. Source: that of CompoundWave.
#include <numbers>

#include "control/compound_wave.hpp"

namespace constrictor {
namespace {

class Rolling : public CompoundGait {
 public:
  std::string_view name() const override { return "rolling"; }

 protected:
  CompoundWave wave(const ControlConfig& config, double, double) const override {
    CompoundWave wave;
    wave.yaw_rad = config.rolling_rad;
    wave.pitch_rad = config.rolling_rad;
    wave.lead_rad = 0.5 * std::numbers::pi;
    return wave;
  }
};

}  // namespace

std::unique_ptr<ControlMethod> make_rolling() { return std::make_unique<Rolling>(); }

}  // namespace constrictor
