// "bend": takes the desired posture at a limited speed. The wave goes on if the trajectory names a speed; otherwise
// it fades. Done when the posture is reached.
#include <algorithm>

#include "control/wave_motion.hpp"

namespace constrictor {
namespace {

class Bend : public PostureMethod {
 public:
  std::string_view name() const override { return "bend"; }

 protected:
  MethodProgress progress(double left_rad, BodyState& body) const override {
    double& longest_rad = body.scratch[0];
    longest_rad = std::max(longest_rad, left_rad);
    return {left_rad <= 0.0, longest_rad > 0.0 ? 1.0 - left_rad / longest_rad : 1.0};
  }
};

}  // namespace

std::unique_ptr<ControlMethod> make_bend() { return std::make_unique<Bend>(); }

}  // namespace constrictor
