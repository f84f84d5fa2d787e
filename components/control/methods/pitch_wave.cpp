// "pitch_wave": a vertical wave travels along the body towards the head, as in a caterpillar. The body moves straight
// ahead through passages as narrow as itself, and on ground that is as slippery along the body as across it. The yaw
// joints bend the body along the path. Source: the article that CompoundWave names, which calls this gait "linear
// progression".
#include "control/compound_wave.hpp"

namespace constrictor {
namespace {

class PitchWave : public CompoundGait {
 public:
  std::string_view name() const override { return "pitch_wave"; }

 protected:
  CompoundWave wave(const ControlConfig& config, double curvature_1_m, double) const override {
    CompoundWave wave;
    wave.pitch_rad = config.pitch_wave_rad;
    wave.wavelength_m = config.pitch_wave_wavelength_m;
    wave.curvature_1_m = curvature_1_m;
    return wave;
  }
};

}  // namespace

std::unique_ptr<ControlMethod> make_pitch_wave() { return std::make_unique<PitchWave>(); }

}  // namespace constrictor
