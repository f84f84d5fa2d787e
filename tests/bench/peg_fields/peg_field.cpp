#include "bench/peg_fields/peg_field.hpp"

#include <algorithm>
#include <vector>

#include "component/random.hpp"

namespace constrictor::peg_fields {
namespace {

using Eigen::Vector2d;

constexpr int kRefusals = 5000;   // in succession that end the drawing
constexpr double kFree_m = 0.02;  // between the body at the start and a peg

}  // namespace

Scenario draw_field(const FieldSpec& spec, double body_length_m, double body_radius_m, std::uint64_t seed) {
  Random random(seed, "pegs");
  std::vector<Vector2d> all_m;
  for (int refused = 0; refused < kRefusals;) {
    const double x_m = random.uniform(spec.from_m, spec.to_m);
    const Vector2d at_m(x_m, random.uniform(-spec.half_width_m, spec.half_width_m));
    const bool apart =
        std::all_of(all_m.begin(), all_m.end(), [&](const Vector2d& p) { return (p - at_m).norm() >= spec.spacing_m; });
    if (apart) all_m.push_back(at_m);
    refused = apart ? 0 : refused + 1;
  }
  Scenario scene;
  scene.name = "peg_field";
  scene.seed = seed;
  scene.friction.object_robot = spec.friction;
  for (const Vector2d& at_m : all_m) {
    const Vector2d on_body_m(std::clamp(at_m.x(), -body_length_m, 0.0), 0.0);
    if ((at_m - on_body_m).norm() < body_radius_m + spec.radius_m + kFree_m) continue;
    ScenarioObstacle peg;
    peg.shape = BodyShape::kCylinder;
    peg.size_m = {spec.radius_m, spec.radius_m, spec.height_m};
    peg.position_m = at_m;
    scene.obstacles.push_back(peg);
  }
  return scene;
}

}  // namespace constrictor::peg_fields
