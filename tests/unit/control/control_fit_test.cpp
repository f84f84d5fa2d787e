#include "control/control_fit.hpp"

#include <gtest/gtest.h>

#include "component/data_path.hpp"
#include "control/yaw_chain.hpp"

namespace constrictor {
namespace {

RobotModel robot_named(const char* name) {
  return load_robot(data_path("components/lib/robot/" + std::string(name) + ".yaml"));
}

TEST(ControlFit, NothingChangesForTheDefaultRobot) {
  const ControlConfig tuned, fitted = control_fitted_to(robot_named("mamba"), tuned);
  EXPECT_EQ(fitted.weights.head, tuned.weights.head);
  EXPECT_EQ(fitted.weights.rigid_bend_rad, tuned.weights.rigid_bend_rad);
  EXPECT_EQ(fitted.base_bend_rad, tuned.base_bend_rad);
  EXPECT_EQ(fitted.deliver.amplitude_rad, tuned.deliver.amplitude_rad);
}

TEST(ControlFit, ARobotWithoutContactSensorsKeepsTheBaseOnTheGround) {
  const ControlConfig tuned;
  EXPECT_GT(tuned.lift_rad, 0.0);
  EXPECT_EQ(control_fitted_to(robot_named("mamba"), tuned).lift_rad, tuned.lift_rad);
  EXPECT_EQ(control_fitted_to(robot_named("mamba_no_skin"), tuned).lift_rad, 0.0);
}

TEST(ControlFit, ALongerBodyUndulatesLessWhenItNearsAZone) {
  RobotModel robot = robot_named("mamba");
  const ControlConfig tuned;
  double before_rad = tuned.deliver.amplitude_rad;
  for (const std::size_t modules : {28U, 32U, 40U}) {
    robot.module_count = modules;
    const ControlConfig fitted = control_fitted_to(robot, tuned);
    EXPECT_LT(fitted.deliver.amplitude_rad, before_rad - 0.05) << modules;
    EXPECT_EQ(fitted.carry.amplitude_rad, tuned.carry.amplitude_rad) << modules;
    before_rad = fitted.deliver.amplitude_rad;
  }
  robot.module_count = 16;
  EXPECT_EQ(control_fitted_to(robot, tuned).deliver.amplitude_rad, tuned.deliver.amplitude_rad);
}

// The same U, with the bend of each joint shared by two, moves alike: rigid in the base, and little at the head.
TEST(ControlFit, TheWaveMovesTheSamePlacesOfABodyWithShorterLinks) {
  const RobotModel coarse = robot_named("mamba"), fine = robot_named("mamba_yaw_only");
  const ControlConfig tuned, fitted = control_fitted_to(fine, tuned);
  LinkArray coarse_shape{}, fine_shape{};
  for (int k = 5; k <= 7; ++k) coarse_shape[k] = 1.047;
  for (int k = 10; k <= 15; ++k) fine_shape[k] = 0.5235;
  const YawChain coarse_chain(coarse), fine_chain(fine);
  const LinkArray coarse_weights = coarse_chain.weights(coarse_shape, tuned.weights);
  const LinkArray fine_weights = fine_chain.weights(fine_shape, fitted.weights);
  for (std::size_t k = 0; k < fine_chain.link_count(); ++k) {
    if (k >= 10 && k <= 16) continue;  // the ends of the base lie at different places
    // Every second link begins where one of the coarse body does.
    const std::size_t before = k / 2, after = std::min((k + 1) / 2, coarse_chain.link_count() - 1);
    EXPECT_NEAR(fine_weights[k], 0.5 * (coarse_weights[before] + coarse_weights[after]), 0.01) << k;
  }
  for (std::size_t k = 11; k <= 15; ++k) EXPECT_NEAR(fine_weights[k], 0.0, 0.001) << k;
}

}  // namespace
}  // namespace constrictor
