// Sliding mode control of the heading, compared with what its theory promises for a unicycle: the time to reach the
// boundary layer, the offset on the surface, and the error that a constant disturbance leaves.
#include "navigation/sliding_steering.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace constrictor {
namespace {

constexpr double kStep_s = 0.002;
constexpr double kPace_m_s = 0.5;

/// A unicycle beside a line of constant curvature, in the line's own coordinates, while a disturbance is added to the
/// curvature of its path.
struct Unicycle {
  explicit Unicycle(const SlidingSteeringConfig& parameters) : config(parameters) {}
  double offset_m = 0.0;     ///< of the line, positive if it lies to the left
  double heading_rad = 0.0;  ///< of the line relative to the robot
  double line_curvature_1_m = 0.0;
  double disturbance_1_m = 0.0;
  double time_s = 0.0;
  double curvature_1_m = 0.0;
  SlidingSteeringConfig config;
  SlidingSteeringState state{};

  [[nodiscard]] double surface() const { return heading_rad + std::atan(offset_m / config.approach_m); }
  void step() {
    SlidingSteering::observe(time_s, {0.0, offset_m, heading_rad, line_curvature_1_m}, 0.0, state);
    curvature_1_m = SlidingSteering(config, 5.0).curvature(state) + disturbance_1_m;
    // The speed along the line, of a robot on its inner or outer side.
    const double along_m_s = kPace_m_s * std::cos(heading_rad) / (1.0 + line_curvature_1_m * offset_m);
    offset_m += kStep_s * kPace_m_s * std::sin(heading_rad);
    heading_rad += kStep_s * (along_m_s * line_curvature_1_m - kPace_m_s * curvature_1_m);
    time_s += kStep_s;
  }
};

SlidingSteeringConfig narrow() {
  SlidingSteeringConfig config;
  config.gain_1_m = 1.0;
  config.layer_rad = 0.05;
  config.approach_m = 0.6;
  return config;
}

TEST(SlidingSteering, ReachesTheLayerInTheTimeOfTheTheoryAndStays) {
  for (const double disturbance : {0.0, 0.3, -0.5}) {
    Unicycle robot(narrow());
    robot.heading_rad = -0.8;
    robot.offset_m = -0.1;
    robot.disturbance_1_m = disturbance;
    const double way_rad = std::abs(robot.surface()) - 0.05;
    // A disturbance to the right, which is negative, helps a robot that must turn to the right.
    const double exact_s = way_rad / (kPace_m_s * (1.0 - disturbance));
    while (std::abs(robot.surface()) > 0.05 && robot.time_s < 2.0 * exact_s) robot.step();
    EXPECT_NEAR(robot.time_s, exact_s, 0.01 * exact_s) << disturbance;
    for (const double end_s = robot.time_s + 5.0; robot.time_s < end_s; robot.step())
      ASSERT_LT(std::abs(robot.surface()), 0.0501) << disturbance;
  }
}

TEST(SlidingSteering, OnTheSurfaceTheOffsetDecaysAsItsParameterSays) {
  Unicycle robot(narrow());
  robot.offset_m = 0.06;
  robot.heading_rad = -std::atan(0.1);
  const double way_m = 0.9;
  for (int i = 0; i < static_cast<int>(way_m / (kPace_m_s * kStep_s)); ++i) robot.step();
  EXPECT_NEAR(robot.offset_m, 0.06 * std::exp(-way_m / 0.6), 1e-3);
}

// In the layer, the disturbance is balanced where gain s / layer equals it.
TEST(SlidingSteering, AConstantDisturbanceLeavesTheErrorOfTheLayer) {
  SlidingSteeringConfig config = narrow();
  config.layer_rad = 0.4;
  for (const double disturbance : {0.25, -0.6}) {
    Unicycle robot(config);
    robot.disturbance_1_m = disturbance;
    for (int i = 0; i < 20'000; ++i) robot.step();
    EXPECT_NEAR(robot.surface(), -0.4 * disturbance, 1e-4);
    EXPECT_NEAR(robot.heading_rad, 0.0, 1e-4);
    EXPECT_NEAR(robot.offset_m, -0.6 * std::tan(0.4 * disturbance), 1e-4);
  }
}

TEST(SlidingSteering, FollowsABendWithoutError) {
  Unicycle robot(narrow());
  robot.line_curvature_1_m = 0.8;
  robot.offset_m = 0.15;
  for (int i = 0; i < 10'000; ++i) robot.step();
  EXPECT_NEAR(robot.offset_m, 0.0, 1e-3);
  EXPECT_NEAR(robot.curvature_1_m, 0.8, 1e-3);
}

TEST(SlidingSteering, ReadsABendFromWhatIsSeenAhead) {
  // A circle of radius 1.25 m to the left that touches the x axis 0.1 m to the left of the head.
  const double radius_m = 1.25, ahead_m = 0.35;
  const double angle_rad = std::asin(ahead_m / radius_m);
  SlidingSteeringState state;
  SlidingSteering::observe(0.0, {ahead_m, 0.1 + radius_m * (1.0 - std::cos(angle_rad)), angle_rad, 1.0 / radius_m}, 0.0,
                           state);
  EXPECT_NEAR(Steering::mean_error(state.offset), 0.1, 0.002);
  EXPECT_NEAR(Steering::mean_error(state.heading), 0.0, 0.005);
}

TEST(SlidingSteering, KeepsTheLimit) {
  SlidingSteeringState state;
  SlidingSteering::observe(0.0, {0.0, 5.0, 0.0, 0.6}, 0.0, state);
  EXPECT_NEAR(SlidingSteering(narrow(), 5.0).curvature(state), 0.6 + 1.0, 1e-12) << "the gain outside of the layer";
  EXPECT_EQ(SlidingSteering(narrow(), 0.4).curvature(state), 0.4);
}

TEST(SlidingSteering, TheMeanOverAGaitPeriodHidesTheSwayOfTheHead) {
  SlidingSteeringState state;
  for (int i = 0; i < 400; ++i) {
    const double t = 0.01 * i;
    SlidingSteering::observe(t, {0.0, 0.0, 0.02 + 0.3 * std::sin(2.0 * 3.14159265358979 * t), 0.1}, 0.999, state);
  }
  EXPECT_NEAR(Steering::mean_error(state.heading), 0.02, 1e-3);
  EXPECT_NEAR(Steering::mean_error(state.curvature), 0.1, 1e-9);
}

TEST(SlidingSteering, IgnoresWhatIsNotFinite) {
  SlidingSteeringState state;
  const SlidingSteeringConfig config = narrow();
  EXPECT_EQ(SlidingSteering(config, 1.0).curvature(state), 0.0) << "before the first image";
  for (const double bad : {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()}) {
    SlidingSteering::observe(0.0, {0.35, bad, 0.0, 0.0}, 1.0, state);
    SlidingSteering::observe(0.0, {0.35, 0.0, bad, 0.0}, 1.0, state);
    SlidingSteering::observe(0.0, {0.35, 0.0, 0.0, bad}, 1.0, state);
  }
  EXPECT_EQ(SlidingSteering(config, 1.0).curvature(state), 0.0);
}

}  // namespace
}  // namespace constrictor
