// The PID controller, compared with closed-form responses.
#include "navigation/pid.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "navigation/steering.hpp"

namespace constrictor {
namespace {

constexpr double kDt_s = 0.01;

TEST(Pid, ProportionalLoopOnAnIntegratorDecaysExponentially) {
  const PidGains gains{2.0, 0.0, 0.0, 100.0, 0.0};
  PidState state;
  double x = 1.0;
  for (int i = 0; i < 100; ++i) x += kDt_s * pid_step(gains, -x, kDt_s, state);
  EXPECT_NEAR(x, std::exp(-2.0), 0.01);  // Euler's error at this step
}

TEST(Pid, IntegralOfAConstantErrorIsARamp) {
  const PidGains gains{0.5, 3.0, 0.0, 100.0, 0.0};
  PidState state;
  double u = 0.0;
  for (int i = 0; i < 200; ++i) u = pid_step(gains, 0.2, kDt_s, state);
  EXPECT_NEAR(u, 0.5 * 0.2 + 3.0 * 0.2 * 2.0, 1e-9);
}

TEST(Pid, DerivativeOfARampIsItsSlopeAfterTheFilterSettled) {
  const PidGains gains{0.0, 0.0, 2.0, 100.0, 0.1};
  PidState state;
  double u = 0.0;
  for (int i = 0; i < 200; ++i) u = pid_step(gains, 0.3 * kDt_s * i, kDt_s, state);
  EXPECT_NEAR(u, 2.0 * 0.3, 1e-6);
}

TEST(Pid, PiLoopOnADisturbedIntegratorReachesTheSetpoint) {
  // x' = u + d has no steady error only if the integral carries -d.
  const PidGains gains{4.0, 4.0, 0.0, 100.0, 0.0};
  PidState state;
  double x = 0.0;
  for (int i = 0; i < 2000; ++i) x += kDt_s * (pid_step(gains, 1.0 - x, kDt_s, state) + 0.7);
  EXPECT_NEAR(x, 1.0, 1e-6);
  EXPECT_NEAR(4.0 * state.integral, -0.7, 1e-6);
}

TEST(Pid, SaturatedOutputDoesNotWindUp) {
  const PidGains gains{1.0, 1.0, 0.0, 1.0, 0.0};
  PidState state;
  for (int i = 0; i < 10000; ++i) EXPECT_LE(std::abs(pid_step(gains, 5.0, kDt_s, state)), 1.0);
  // After a hundred seconds of error in one direction, the output follows a reversed error at once.
  EXPECT_LT(pid_step(gains, -0.5, kDt_s, state), 0.5);
}

TEST(Pid, NonFiniteErrorChangesNothing) {
  const PidGains gains{1.0, 1.0, 1.0, 10.0, 0.0};
  PidState state;
  pid_step(gains, 0.5, kDt_s, state);
  const double integral = state.integral;
  EXPECT_TRUE(std::isfinite(pid_step(gains, std::numeric_limits<double>::quiet_NaN(), kDt_s, state)));
  EXPECT_EQ(state.integral, integral);
}

TEST(Steering, IgnoresASwayWithThePeriodOfTheGait) {
  const Steering steering({6.0, 0.0, 0.0, 1.2, 0.0});
  SteeringState state;
  const double period_s = 1.0;
  for (int i = 0; i <= 300; ++i) {
    const double t = 0.01 * i;
    steering.observe(t, 0.05 + 0.1 * std::sin(2.0 * 3.14159265358979 * t / period_s), period_s, state);
  }
  EXPECT_NEAR(Steering::mean_error(state), 0.05, 1e-3);
}

}  // namespace
}  // namespace constrictor
