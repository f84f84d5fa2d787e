// "concertina": the body folds and stretches part by part in a channel. Folded parts press against both walls and stay;
// the stretched part travels from the head to the tail and carries the body forward. It needs the walls: on open ground
// the folds slide. Source: the gait that H. Marvi and D. L. Hu describe in "Friction enhancement in concertina
// locomotion of snakes", J. R. Soc. Interface 9 (2012), 3067-3080; the travelling stretch is this project's own.
#include "control/compound_wave.hpp"

namespace constrictor {
namespace {

class Concertina : public CompoundGait {
 public:
  std::string_view name() const override { return "concertina"; }

 protected:
  bool needs_pitch_joints() const override { return false; }
  CompoundWave wave(const ControlConfig& config, double curvature_1_m, double) const override {
    CompoundWave wave;
    wave.yaw_rad = config.concertina_rad;
    wave.wavelength_m = config.concertina_wavelength_m;
    wave.stretches = true;
    wave.curvature_1_m = curvature_1_m;
    return wave;
  }
};

}  // namespace

std::unique_ptr<ControlMethod> make_concertina() { return std::make_unique<Concertina>(); }

}  // namespace constrictor
