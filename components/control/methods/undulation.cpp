// "undulation": lateral undulation, straight or on a posture (an object is carried between the arms of a U), forwards
// or backwards, steered by the curvature of the path. It is never done.
#include "control/wave_motion.hpp"

namespace constrictor {
namespace {

class Undulation : public PostureMethod {
 public:
  std::string_view name() const override { return "undulation"; }
  bool keeps_pose() const override { return true; }

 protected:
  MethodProgress progress(double left_rad, BodyState&) const override { return {false, left_rad > 0.0 ? 0.0 : 1.0}; }
};

}  // namespace

std::unique_ptr<ControlMethod> make_undulation() { return std::make_unique<Undulation>(); }

}  // namespace constrictor
