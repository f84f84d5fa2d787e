// From the path and the velocity of a trajectory to the gait.
#include "control/motion_gait.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "robot/trajectory_path.hpp"
#include "unit/control/control_run.hpp"

namespace constrictor {
namespace {

msg::DesiredTrajectory trajectory(const char* motion, double speed_m_s, double acceleration_m_s2 = 0.0) {
  msg::DesiredTrajectory desired{};
  set_motion(desired, motion, 1);
  desired.speed_m_s = speed_m_s;
  desired.acceleration_m_s2 = acceleration_m_s2;
  return desired;
}

TEST(MotionGait, TheFrequencyIsTheSpeedOverTheWayOfAnUndulation) {
  const ControlConfig config;
  const Gait gait = gait_of(trajectory("travel", 0.45), config);
  EXPECT_DOUBLE_EQ(gait.frequency_hz * config.travel.advance_m, 0.45);
  EXPECT_EQ(gait.amplitude_rad, config.travel.amplitude_rad);
  EXPECT_EQ(gait.wavelength_m, config.travel.wavelength_m);
  EXPECT_DOUBLE_EQ(gait_of(trajectory("creep", -0.1), config).frequency_hz, -0.1 / config.creep.advance_m);
  EXPECT_EQ(gait_of(trajectory("carry", 2.0), config).frequency_hz, config.most_hz) << "faster than the joints can";
  EXPECT_EQ(gait_of(trajectory("carry", -2.0), config).frequency_hz, -config.most_hz);
}

TEST(MotionGait, AMotionWithoutSpeedHasNoWave) {
  const Gait gait = gait_of(trajectory("travel", 0.0), ControlConfig());
  EXPECT_EQ(gait.frequency_hz, 0.0);
  EXPECT_EQ(gait.amplitude_rad, 0.0);
}

TEST(MotionGait, EachKindOfMotionHasItsMethod) {
  ControlConfig config;
  for (const char* motion : {"travel", "carry", "creep", "seat", "deliver", "leave"}) {
    EXPECT_TRUE(drives(motion));
    EXPECT_EQ(method_of(motion, config), "undulation") << motion;
  }
  config.carry.method = 1;
  EXPECT_EQ(method_of("carry", config), drive_methods()[1]);
  EXPECT_EQ(method_of("travel", config), "undulation");
  EXPECT_EQ(method_of("stand", config), "hold");
  for (const char* motion : {"wrap", "squeeze", "bend", "relax", "a method of one's own"}) {
    EXPECT_FALSE(drives(motion));
    EXPECT_EQ(method_of(motion, config), motion);
  }
}

// The lateral path of a sine whose heading has this amplitude, differentiated twice by numbers.
TEST(MotionGait, TheLateralAccelerationIsThatOfTheWave) {
  const Gait gait{1.1, 0.3, 1.07, 0.0};
  const auto aside_m = [&](double time_s) {
    double sum_m = 0.0;  // of heading x step along the body, from the wave's crest on
    for (int i = 0; i < 1000; ++i)
      sum_m += gait.amplitude_rad * std::cos(2.0 * M_PI * (i + 0.5) * 1e-3 * gait.frequency_hz * time_s) *
               gait.frequency_hz * time_s * gait.wavelength_m * 1e-3;
    return sum_m;
  };
  double largest = 0.0;
  for (double t = 0.05; t < 1.0; t += 0.005)
    largest = std::max(largest, std::abs(aside_m(t + 1e-3) - 2.0 * aside_m(t) + aside_m(t - 1e-3)) / 1e-6);
  EXPECT_NEAR(lateral_acceleration_m_s2(gait), largest, 0.01 * largest);
}

TEST(MotionGait, ALimitOfTheAccelerationMakesTheWavesSmallerAndThenSlower) {
  const ControlConfig config;
  const Gait usual = gait_of(trajectory("carry", 0.198), config);
  const double usual_m_s2 = lateral_acceleration_m_s2(usual);
  EXPECT_EQ(lateral_acceleration_m_s2(gait_of(trajectory("carry", 0.198, 2.0 * usual_m_s2), config)), usual_m_s2);
  for (const double share : {0.8, 0.6, 0.4, 0.2}) {
    const Gait slower = gait_of(trajectory("carry", 0.198, share * usual_m_s2), config);
    EXPECT_NEAR(lateral_acceleration_m_s2(slower), share * usual_m_s2, 1e-9);
    EXPECT_GE(slower.amplitude_rad, 0.4 - 1e-9) << "a smaller wave slips";
    EXPECT_EQ(slower.frequency_hz < usual.frequency_hz, share < 0.5) << share;
  }
}

/// Mean angle of the yaw joints over a period of the wave, as the curvature of the body [1/m].
double driven_curvature_1_m(const Script& script) {
  LocalRun run = make_run(script);
  run.advance(400);
  double sum_rad = 0.0;
  for (int i = 0; i < 100; ++i) {  // two periods of 0.5 Hz
    run.advance(1);
    for (int j = 0; j < 23; j += 2) sum_rad += run.latest(topics::kJointCommand)->position_rad[j] / 100.0;
  }
  return sum_rad / (11.0 * 2.0 * 0.089);
}

// A path of several pieces: the body bends as on the arc that leads to the point ahead of the head.
TEST(MotionGait, TheBodyBendsAlongThePath) {
  const auto on = [](double offset_m) {
    return [offset_m](const Tick&, msg::DesiredTrajectory& desired) {
      desired = trajectory("travel", 0.45);
      desired.point_count = 2;  // straight, beside the head, and later a bend that is too far ahead to matter
      desired.points[0].y_m = offset_m;
      desired.points[1] = {1.5, 1.5, offset_m, 0.0, 2.0};
      return true;
    };
  };
  EXPECT_NEAR(driven_curvature_1_m(on(0.0)), 0.0, 0.02);
  const double ahead_m = ControlConfig().lookahead_m, aside_m = 0.1;
  const double expected_1_m = 2.0 * aside_m / (ahead_m * ahead_m + aside_m * aside_m);
  EXPECT_NEAR(driven_curvature_1_m(on(aside_m)), expected_1_m, 0.1 * expected_1_m);
  EXPECT_NEAR(driven_curvature_1_m(on(-aside_m)), -expected_1_m, 0.1 * expected_1_m);
}

TEST(MotionGait, APathThatIsNotOneIsNotAccepted) {
  LocalRun run = make_run([](const Tick&, msg::DesiredTrajectory& desired) {
    desired = trajectory("travel", 0.45);
    desired.point_count = 2;  // both at the same arc length
    return true;
  });
  run.advance(10);
  EXPECT_FALSE(run.latest(topics::kMotionStatus)->accepted);
  EXPECT_STREQ(run.latest(topics::kMotionStatus)->method, "hold");
}

TEST(MotionGait, TheStatusTellsThePeriodOfTheDesiredSpeed) {
  LocalRun run = make_run([](const Tick& tick, msg::DesiredTrajectory& desired) {
    desired = trajectory(tick.index < 50 ? "travel" : "stand", tick.index < 50 ? 0.45 : 0.0);
    return true;
  });
  run.advance(10);
  EXPECT_DOUBLE_EQ(run.latest(topics::kMotionStatus)->period_s, 0.9 / 0.45);
  run.advance(60);
  EXPECT_EQ(run.latest(topics::kMotionStatus)->period_s, 10.0) << "a body that stands does not sway";
}

}  // namespace
}  // namespace constrictor
