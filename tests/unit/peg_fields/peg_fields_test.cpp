// Random fields of pegs, and the robot among them.
#include <gtest/gtest.h>

#include "bench/peg_fields/peg_trial.hpp"
#include "support/project.hpp"

namespace constrictor::peg_fields {
namespace {

TEST(PegFields, PegsAreApartAndDoNotTouchTheBodyAtTheStart) {
  const FieldSpec field;
  const Scenario scene = draw_field(field, 2.1, 0.035, 5);
  const auto& pegs = scene.obstacles;
  EXPECT_GT(pegs.size(), 60u);
  for (std::size_t i = 0; i < pegs.size(); ++i) {
    const Eigen::Vector2d at = pegs[i].position_m;
    if (at.x() > -2.1 && at.x() < 0.0) {
      EXPECT_GE(std::abs(at.y()), 0.035 + field.radius_m);
    }
    for (std::size_t j = 0; j < i; ++j) EXPECT_GE((at - pegs[j].position_m).norm(), field.spacing_m);
  }
  EXPECT_NE(draw_field(field, 2.1, 0.035, 6).obstacles.front().position_m, pegs.front().position_m);
}

TEST(PegFields, ContactControlMovesTheBodyWhereUndulationDoesNot) {
  const RobotModel robot = load_robot(testing::robot_path("mamba"));
  FieldSpec field;
  field.spacing_m = 0.25;
  Trial trial;
  trial.longest_s = 30.0;
  trial.method.method = "undulation";
  EXPECT_LT(run(robot, field, 206, trial).way_m, 0.5);
  trial.method.method = "obstacle_aided";
  EXPECT_GT(run(robot, field, 206, trial).way_m, 1.5);
}

}  // namespace
}  // namespace constrictor::peg_fields
