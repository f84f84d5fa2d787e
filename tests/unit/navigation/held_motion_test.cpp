// The motion of a held object, against a U that sways, slides and turns in a known way.
#include "navigation/held_motion.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "robot/planar.hpp"

namespace constrictor {
namespace {

constexpr double kPeriod_s = 0.9;
constexpr double kPivot_m = 0.3;
constexpr HeldMotion::Config kConfig{kPivot_m, 4.0};
constexpr double kSpeed_m_s = 0.13;

struct Drive {
  HeldMotion::Motion motion{};
  Eigen::Vector2d place{0.0, 0.0};  ///< without the sway
  double mouth_rad = 0.0;
};

/// The pivot of the U, which points to `mouth_rad` and turns at `turn_rad_s`, moves in the direction `mouth_rad +
/// crab_rad`. The object lies behind the pivot, and all sway with the gait. With `rocking_m` the object also moves as
/// far to each side in two periods of the gait.
Drive drive(double mouth_rad, double crab_rad, double turn_rad_s, double duration_s, double speed_m_s = kSpeed_m_s,
            double rocking_m = 0.0) {
  constexpr double kStep_s = 0.02;
  HeldMotion held;
  Drive result;
  result.mouth_rad = mouth_rad;
  Eigen::Vector2d pivot(0.0, 0.0);
  for (double t = 0.0; t < duration_s; t += kStep_s) {
    const double phase = 2.0 * std::numbers::pi * t / kPeriod_s;
    pivot += speed_m_s * kStep_s * along(result.mouth_rad + crab_rad);
    result.mouth_rad += kStep_s * turn_rad_s;
    result.place = pivot - kPivot_m * along(result.mouth_rad);
    const double aside_m = 0.06 * std::sin(phase) + rocking_m * std::sin(0.5 * phase + 0.3);
    const Eigen::Vector2d sway = turned({0.0, aside_m}, result.mouth_rad);
    result.motion = held.observe(t, result.place + sway, result.mouth_rad + 0.2 * std::cos(phase), kPeriod_s, kConfig);
  }
  return result;
}

TEST(HeldMotion, FindsPlaceHeadingAndCrabAngleUnderTheSwayOfTheGait) {
  for (const double mouth_rad : {0.3, 3.1, -2.0}) {
    for (const double crab_rad : {0.0, 0.25, -0.15}) {
      const Drive end = drive(mouth_rad, crab_rad, 0.0, 20.0);
      EXPECT_NEAR(end.motion.crab_rad, crab_rad, 0.02) << "mouth " << mouth_rad;
      EXPECT_NEAR(wrap_angle(end.motion.heading_rad - mouth_rad), 0.0, 0.01) << "mouth " << mouth_rad;
      EXPECT_LT((end.motion.place - end.place).norm(), 0.01) << "mouth " << mouth_rad << ", crab " << crab_rad;
    }
  }
}

// So moves a body of 16 modules with an object: at 0.035 m/s, askew by half a radian, and rocking by 0.03 m.
TEST(HeldMotion, FindsTheCrabAngleOfASlowBodyThatRocksWithHalfOfTheGaitsFrequency) {
  for (const double crab_rad : {0.0, 0.45, -0.45}) {
    const Drive end = drive(2.5, crab_rad, 0.0, 20.0, 0.035, 0.03);
    EXPECT_NEAR(end.motion.crab_rad, crab_rad, 0.03);
    EXPECT_LT((end.motion.place - end.place).norm(), 0.02) << "crab " << crab_rad;
  }
}

TEST(HeldMotion, ATurnOfTheUIsNoCrabAngle) {
  for (const double turn_rad_s : {0.15, -0.15}) {
    const Drive end = drive(0.5, 0.0, turn_rad_s, 12.0);
    EXPECT_NEAR(end.motion.crab_rad, 0.0, 0.03) << turn_rad_s;
    EXPECT_NEAR(wrap_angle(end.motion.heading_rad - end.mouth_rad), 0.0, 0.03) << turn_rad_s;
    EXPECT_LT((end.motion.place - end.place).norm(), 0.02) << turn_rad_s;
  }
}

TEST(HeldMotion, AUThatStandsHasNoCrabAngle) {
  HeldMotion held;
  HeldMotion::Motion motion{};
  for (double t = 0.0; t < 10.0; t += 0.02)
    motion = held.observe(t, {0.002 * std::sin(5.0 * t), 0.002 * std::cos(7.0 * t)}, 0.4, kPeriod_s, kConfig);
  EXPECT_EQ(motion.crab_rad, 0.0);
}

}  // namespace
}  // namespace constrictor
