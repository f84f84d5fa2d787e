// The gaits of round bodies in the simulated world, compared with the kinematics of bodies that do not slide.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "bench/gaits/gait_trial.hpp"
#include "support/project.hpp"

namespace constrictor::gaits {
namespace {

const RobotModel& mamba() {
  static const RobotModel robot = load_robot(testing::robot_path("mamba"));
  return robot;
}

Trial trial(const std::string& method, double frequency_hz) {
  Trial trial;
  trial.method = method;
  trial.frequency_hz = frequency_hz;
  trial.friction = 0.4;  // the same in each direction: undulation cannot move the body
  return trial;
}

TEST(Gaits, UndulationNeedsASkinThatSlidesMoreEasilyAlongTheBody) {
  EXPECT_LT(std::abs(run(mamba(), trial("undulation", 0.7)).forward_m_s), 0.05);
  Trial on_skin = trial("undulation", 0.7);
  on_skin.friction.reset();
  EXPECT_GT(run(mamba(), on_skin).forward_m_s, 0.5);
}

TEST(Gaits, RollingMovesTheBodyAsARollingCylinder) {
  for (const double frequency_hz : {0.5, -0.8}) {
    const Course course = run(mamba(), trial("rolling", frequency_hz));
    const double expected_m_s = 2.0 * std::numbers::pi * frequency_hz * mamba().module_radius_m;
    EXPECT_NEAR(course.left_m_s, expected_m_s, 0.12 * std::abs(expected_m_s));
    EXPECT_NEAR(course.forward_m_s, 0.0, 0.01);
  }
}

TEST(Gaits, RollingDoesNotDependOnTheSkin) {
  Trial on_skin = trial("rolling", 0.5);
  const double isotropic_m_s = run(mamba(), on_skin).left_m_s;
  on_skin.friction.reset();
  EXPECT_NEAR(run(mamba(), on_skin).left_m_s, isotropic_m_s, 0.1 * isotropic_m_s);
}

TEST(Gaits, SidewindingMovesTheBodyAlmostWithoutSlip) {
  for (const double frequency_hz : {0.5, -0.5}) {
    const Trial wind = trial("sidewinding", frequency_hz);
    const Course course = run(mamba(), wind);
    const double expected_m_s = sidewinding_without_slip_m_s(mamba(), wind.config, frequency_hz);
    EXPECT_NEAR(course.left_m_s, expected_m_s, 0.25 * std::abs(expected_m_s));
    EXPECT_LT(std::abs(course.left_m_s), std::abs(expected_m_s)) << "the body cannot overtake its waves";
    EXPECT_LT(std::abs(course.forward_m_s), 0.3 * std::abs(course.left_m_s));
  }
}

TEST(Gaits, SidewindingFollowsTheCurvature) {
  for (const double curvature_1_m : {0.5, -0.5}) {
    Trial wind = trial("sidewinding", 0.5);
    wind.curvature_1_m = curvature_1_m;
    const Course course = run(mamba(), wind);
    const double expected_rad_s = curvature_1_m * std::hypot(course.forward_m_s, course.left_m_s);
    EXPECT_NEAR(course.turn_rad_s, expected_rad_s, 0.4 * std::abs(expected_rad_s));
  }
}

// A section of the body that passes through a trough of the wave turns about its centre at the rate of the slope there,
// 2 pi f H with the slope's amplitude H, and rolls on the ground with its radius. In addition, the curved body is
// shorter than its arc by the share H^2 / 4, by which the waves carry it along at f lambda.
TEST(Gaits, APitchWaveMovesTheBodyForwardAtTheSpeedOfItsGeometry) {
  const double frequency_hz = 1.0;
  const Trial wave = trial("pitch_wave", frequency_hz);
  const double wavelength_m = wave.config.pitch_wave_wavelength_m;
  const double link_m = 2.0 * mamba().module_length_m;  // every second joint is a pitch joint
  const double slope_rad = wave.config.pitch_wave_rad / (2.0 * std::sin(std::numbers::pi * link_m / wavelength_m));
  const double expected_m_s = frequency_hz * (2.0 * std::numbers::pi * slope_rad * mamba().module_radius_m +
                                              0.25 * slope_rad * slope_rad * wavelength_m);
  const Course course = run(mamba(), wave);
  EXPECT_NEAR(course.forward_m_s, expected_m_s, 0.35 * expected_m_s);
  EXPECT_NEAR(course.left_m_s, 0.0, 0.01);
  EXPECT_LT(run(mamba(), trial("pitch_wave", -frequency_hz)).forward_m_s, -0.5 * expected_m_s);
}

TEST(Gaits, APitchWaveFollowsTheCurvature) {
  Trial wave = trial("pitch_wave", 1.0);
  wave.curvature_1_m = 0.4;
  const Course course = run(mamba(), wave);
  const double speed_m_s = std::hypot(course.forward_m_s, course.left_m_s);
  EXPECT_GT(course.turn_rad_s, 0.4 * wave.curvature_1_m * speed_m_s);
  EXPECT_LT(course.turn_rad_s, 1.6 * wave.curvature_1_m * speed_m_s);
}

TEST(Gaits, ConcertinaMovesForwardBetweenWallsAndOnlyThere) {
  Trial fold = trial("concertina", 0.3);
  fold.duration_s = 24.0;
  EXPECT_LT(run(mamba(), fold).forward_m_s, 0.01);
  for (const double channel_m : {0.25, 0.3, 0.35}) {
    fold.channel_m = channel_m;
    EXPECT_GT(run(mamba(), fold).forward_m_s, 0.02) << channel_m << " m";
  }
}

TEST(Gaits, TheSpeedGrowsWithTheFrequency) {
  for (const std::string method : {"sidewinding", "rolling", "pitch_wave"}) {
    const auto speed_m_s = [&](double frequency_hz) {
      const Course course = run(mamba(), trial(method, frequency_hz));
      return std::hypot(course.forward_m_s, course.left_m_s);
    };
    EXPECT_NEAR(speed_m_s(0.6) / speed_m_s(0.3), 2.0, 0.4) << method;
  }
}

TEST(Gaits, UnknownMethodsAreRefused) {
  EXPECT_THROW(static_cast<void>(run(mamba(), trial("moonwalk", 0.5))), std::invalid_argument);
  EXPECT_THROW(static_cast<void>(run(mamba(), trial("wrap", 0.5))), std::invalid_argument);
}

}  // namespace
}  // namespace constrictor::gaits
