// The robot that carries an object: the default step gives the result of a step of 0.25 ms, which half of that step
// (0.125 ms) changes by at most 1 % (tests/bench/validation, group `convergence`).
#include "bench/validation/carrying.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "bench/validation/rigs.hpp"

namespace constrictor::validation {
namespace {

constexpr double kMostSpeedError = 0.03;
constexpr double kMostForceError = 0.05;  // also of torques
constexpr double kMostGap_m = 0.2e-3;

struct Pair {
  CarryingMeasurement usual, fine;
};

Pair carry(double lift_rad) {
  ControlConfig control;
  control.lift_rad = lift_rad;
  SolverSettings fine;
  fine.step_s = 0.25e-3;
  return {measure_carrying(mamba(), {}, control), measure_carrying(mamba(), fine, control)};
}

void expect_alike(const Pair& pair) {
  EXPECT_NEAR(pair.usual.speed_m_s, pair.fine.speed_m_s, kMostSpeedError * pair.fine.speed_m_s);
  EXPECT_NEAR(pair.usual.torque_rms_nm, pair.fine.torque_rms_nm, kMostForceError * pair.fine.torque_rms_nm);
  EXPECT_LT(pair.usual.joint_gap_m, kMostGap_m);
  EXPECT_EQ(pair.usual.unsolved, 0);
  EXPECT_EQ(pair.fine.unsolved, 0);
  EXPECT_LT(pair.fine.slip_m, 0.02) << "the object stays in the bend";
}

TEST(Carrying, WithARaisedBaseIsAsFastAndAsStrongAsWithAFineStep) {
  const Pair pair = carry(ControlConfig{}.lift_rad);
  expect_alike(pair);
  EXPECT_NEAR(pair.usual.object_force_n, pair.fine.object_force_n, kMostForceError * pair.fine.object_force_n);
  EXPECT_GT(pair.fine.object_force_n, 1.0);
}

// The force on the object is not compared here: it converges more slowly (README.md of the folder above).
TEST(Carrying, WithTheBaseOnTheGroundIsAsFastAsWithAFineStep) {
  const Pair pair = carry(0.0);
  expect_alike(pair);
}

}  // namespace
}  // namespace constrictor::validation
