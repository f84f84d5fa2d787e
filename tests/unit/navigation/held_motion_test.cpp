// The motion of a held object, against a U that sways and slides in a known way.
#include "navigation/held_motion.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace constrictor {
namespace {

constexpr double kPeriod_s = 0.9;
constexpr double kFilter_s = 4.0;
constexpr double kSpeed_m_s = 0.13;

struct Drive {
  HeldMotion motion;
  Eigen::Vector2d place{0.0, 0.0};  ///< without the sway
};

/// The U points to `mouth_rad`, moves to `mouth_rad + crab_rad`, and sways with the gait.
Drive drive(double mouth_rad, double crab_rad, double duration_s) {
  Drive result;
  const double course_rad = mouth_rad + crab_rad;
  for (double t = 0.0; t < duration_s; t += 0.02) {
    const double phase = 2.0 * std::numbers::pi * t / kPeriod_s;
    result.place = kSpeed_m_s * t * Eigen::Vector2d(std::cos(course_rad), std::sin(course_rad));
    const Eigen::Vector2d sway = 0.06 * std::sin(phase) * Eigen::Vector2d(-std::sin(mouth_rad), std::cos(mouth_rad));
    result.motion.observe(t, result.place + sway, mouth_rad + 0.2 * std::cos(phase), kPeriod_s, kFilter_s);
  }
  return result;
}

TEST(HeldMotion, FindsTheCrabAngleAndThePlaceUnderTheSwayOfTheGait) {
  for (const double mouth_rad : {0.3, 3.1, -2.0}) {
    for (const double crab_rad : {0.0, 0.25, -0.15}) {
      const Drive end = drive(mouth_rad, crab_rad, 20.0);
      EXPECT_NEAR(end.motion.crab_rad(), crab_rad, 0.02) << "mouth " << mouth_rad;
      EXPECT_LT((end.motion.place() - end.place).norm(), 0.01) << "mouth " << mouth_rad << ", crab " << crab_rad;
    }
  }
}

TEST(HeldMotion, AUThatStandsHasNoCrabAngle) {
  HeldMotion motion;
  for (double t = 0.0; t < 10.0; t += 0.02)
    motion.observe(t, {0.002 * std::sin(5.0 * t), 0.002 * std::cos(7.0 * t)}, 0.4, kPeriod_s, kFilter_s);
  EXPECT_EQ(motion.crab_rad(), 0.0);
}

TEST(HeldMotion, TheSteeredPointKeepsTheObjectOnItsCourse) {
  // The course is the x axis. The object lies on it; the U has turned by minus the crab angle, so that it moves along
  // x.
  const Eigen::Vector2d p_HO(-0.8, 0.2);  // behind the head and to its left
  const double lookahead_m = 0.5;
  for (const double crab_rad : {0.0, 0.3, -0.3}) {
    const double c = std::cos(-crab_rad), s = std::sin(-crab_rad);
    const double head_y_m = -(s * p_HO.x() + c * p_HO.y());  // so that the object is at y = 0
    const double point_y_m = head_y_m + s * lookahead_m;
    EXPECT_NEAR(steered_aside_m(p_HO, lookahead_m, crab_rad), point_y_m, 1e-12) << crab_rad;
  }
}

}  // namespace
}  // namespace constrictor
