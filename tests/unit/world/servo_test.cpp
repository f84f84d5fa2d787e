// The servo compared with closed forms: a joint of one inertia instead of a robot.
#include "sim/world/servo.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <utility>
#include <vector>

#include "unit/world/servo_joint.hpp"

namespace constrictor {
namespace {

// A motor beyond its no-load speed has the limit 0.
TEST(ServoRow, WithoutATorqueTheRateIsThatOfTheMotorWhateverTheLimit) {
  for (int i = 1; i < 1000; ++i) {
    const ServoRow row{0.37 * i, 1.0 / (0.013 * i), 0.0, 0.0, 0.0};
    EXPECT_EQ(row.torque_free_rate_rad_s(), 0.37 * i);
  }
}

TEST(Servo, SagsByTheLoadOverThePositionGain) {
  Joint joint(model());
  joint.load_nm = 2.0;
  for (int i = 0; i < 100; ++i) joint.tick({0.0, 0.0, 6.0});
  EXPECT_NEAR(joint.angle_rad, 2.0 / model().position_gain_nm_rad, 1e-9);
  EXPECT_NEAR(joint.torque_nm, -2.0, 1e-9);
}

TEST(Servo, TheRotorAddsToTheInertiaOfTheJoint) {
  // Without gains only a constant load accelerates rotor and joint together.
  JointModel free = model();
  free.position_gain_nm_rad = 1e-6;
  free.velocity_gain_nm_s_rad = 0.0;
  free.rotor_inertia_kg_m2 = 0.03;
  Joint joint(free, 0.02);
  joint.load_nm = 0.5;
  for (int i = 0; i < 20; ++i) joint.tick({0.0, 0.0, 6.0});
  EXPECT_NEAR(joint.rate_rad_s, 0.5 / (0.02 + 0.03) * 20 * kTick_s, 1e-3);
}

TEST(Servo, SwingsAsASecondOrderSystem) {
  // A soft servo, so that its period is long against the step: w = sqrt(kp / I), damping kd / (2 sqrt(kp I)).
  JointModel soft = model();
  soft.position_gain_nm_rad = 2.0;
  soft.velocity_gain_nm_s_rad = 0.02;
  soft.rotor_inertia_kg_m2 = 0.01;
  Joint joint(soft, 0.01);
  joint.angle_rad = 0.3;
  std::vector<double> crossings_s;
  for (int i = 0; i < std::lround(2.0 / kStep_s); ++i) {
    if (i % kSteps == 0) {
      joint.servo.set({0.0, 0.0, 6.0});
      joint.servo.begin_tick(kSteps, kStep_s);
    }
    const double before = joint.angle_rad;
    joint.step();
    if (before * joint.angle_rad < 0.0) crossings_s.push_back(kStep_s * (i + before / (before - joint.angle_rad)));
  }
  ASSERT_GE(crossings_s.size(), 4U);
  const double half_s = (crossings_s[3] - crossings_s[0]) / 3.0;
  EXPECT_NEAR(std::numbers::pi / half_s, std::sqrt(2.0 / 0.02), 0.03 * std::sqrt(2.0 / 0.02));
}

TEST(Servo, FollowsASineWithTheErrorThatInertiaDemands) {
  // With the true rate as feed-forward, the error is the torque of the inertia over the gain.
  Joint joint(model(), 0.02);
  const double w = 2.0 * std::numbers::pi * 0.7;
  double worst_rad = 0.0;
  for (int i = 1; i < 200; ++i) {
    const double t = i * kTick_s;
    joint.tick({0.5 * std::sin(w * t), 0.5 * w * std::cos(w * t), 6.0});
    if (i > 20) worst_rad = std::max(worst_rad, std::abs(0.5 * std::sin(w * t) - joint.angle_rad));
  }
  const double inertia = 0.02 + model().rotor_inertia_kg_m2;
  EXPECT_LT(worst_rad, 1.5 * inertia * 0.5 * w * w / model().position_gain_nm_rad + 0.5 * w * kStep_s * 0.1);
}

TEST(Servo, TheSetpointMovesWithoutJumpsAndReachesTheCommandAtTheEndOfTheTick) {
  JointModel limits = model();
  Servo servo(limits);
  double before_rad = 0.0;
  double before_rate = 0.0;
  for (int tick = 1; tick <= 20; ++tick) {
    const double t = tick * kTick_s;
    servo.set({0.4 * std::sin(4.0 * t), 1.6 * std::cos(4.0 * t), 6.0});
    servo.begin_tick(kSteps, kStep_s);
    for (int i = 0; i < kSteps; ++i) {
      (void)servo.row(0.0, 0.0);
      const double rate = (servo.setpoint_rad() - before_rad) / kStep_s;
      // The true acceleration is at most 6.4 rad/s²; only the first tick jumps, from rest to the rate of the sine.
      if (tick > 2) {
        EXPECT_LT(std::abs(rate - before_rate), 1.5 * 6.4 * kStep_s);
      }
      before_rad = servo.setpoint_rad();
      before_rate = rate;
    }
    EXPECT_NEAR(servo.setpoint_rad(), 0.4 * std::sin(4.0 * t), 1e-12);
  }
}

TEST(Servo, ADrivingMotorLosesTorqueWithSpeedAndABrakingOneDoesNot) {
  JointModel weak = model();
  weak.max_torque_nm = 6.0;
  weak.no_load_speed_rad_s = 8.0;
  Servo servo(weak);
  servo.set({3.0, 4.0, 6.0});
  servo.begin_tick(kSteps, kStep_s);
  EXPECT_NEAR(servo.row(0.0, 2.0).torque_limit_nm, 6.0 * (1.0 - 2.0 / 8.0), 1e-12);
  EXPECT_NEAR(servo.row(0.0, -2.0).torque_limit_nm, 6.0, 1e-12);
  EXPECT_NEAR(servo.row(-9.0, 9.0).torque_limit_nm, 0.0, 1e-12);
}

TEST(Servo, ARelaxedJointIsStoppedByTheFrictionOfItsGear) {
  JointModel rough = model();
  rough.gear_friction_nm = 0.1;
  Joint joint(rough, 0.02);
  joint.rate_rad_s = 1.0;
  const double inertia = 0.02 + rough.rotor_inertia_kg_m2;  // the gear turns the rotor, too
  for (int i = 0; i < 5; ++i) joint.tick({0.0, 0.0, 0.0});
  EXPECT_NEAR(joint.rate_rad_s, 1.0 - 0.1 / inertia * 5 * kTick_s, 1e-9);
  for (int i = 0; i < 15; ++i) joint.tick({0.0, 0.0, 0.0});
  EXPECT_NEAR(joint.rate_rad_s, 0.0, 1e-5);
  EXPECT_NEAR(joint.angle_rad, 0.5 * 1.0 * inertia / 0.1, 0.01);
}

TEST(Servo, ARelaxedJointTurnsItsRotor) {
  for (const double stiffness_nm_rad : {0.0, 60.0}) {
    JointModel free = model();
    free.stiffness_nm_rad = stiffness_nm_rad;
    free.damping_nm_s_rad = 0.5;
    Joint joint(free, 0.02);
    joint.load_nm = 0.06;
    for (int i = 0; i < 50; ++i) joint.tick({0.0, 0.0, 0.0});
    const double rate = 0.06 / (0.02 + free.rotor_inertia_kg_m2) * 50 * kTick_s;
    EXPECT_NEAR(joint.rate_rad_s, rate, stiffness_nm_rad == 0.0 ? 1e-9 : 0.01 * rate) << stiffness_nm_rad;
  }
}

TEST(Servo, TheFrictionOfTheGearBrakesADrivenJoint) {
  JointModel rough = model();
  rough.gear_friction_nm = 0.4;
  Joint joint(rough, 0.02);
  // At a steady rate the position loop exerts what the friction takes: the joint lags by the friction over the gain.
  for (int i = 1; i <= 100; ++i) joint.tick({i * kTick_s * 0.5, 0.5, 6.0});
  EXPECT_NEAR(joint.rate_rad_s, 0.5, 1e-6);
  EXPECT_NEAR(joint.servo.setpoint_rad() - joint.angle_rad, 0.4 / rough.position_gain_nm_rad,
              0.02 * 0.4 / rough.position_gain_nm_rad + 0.5 * kStep_s);
  EXPECT_NEAR(joint.torque_nm, 0.0, 1e-6) << "the gear takes all of the motor's torque";
  // A weak push against a servo that holds creeps, and a relaxed joint feels the same friction.
  Joint held(rough, 0.02);
  held.load_nm = 0.3;
  held.tick({0.0, 0.0, 6.0});
  EXPECT_LT(std::abs(held.angle_rad), 0.005 * kTick_s);
}

TEST(Servo, ASeriesSpringStretchesByTheLoadAndTheMotorStaysAtTheSetpoint) {
  Joint joint(elastic_model());
  joint.load_nm = 3.0;
  for (int i = 0; i < 200; ++i) joint.tick({0.2, 0.0, 6.0});
  EXPECT_NEAR(joint.servo.motor_angle_rad(), 0.2 + 3.0 / model().position_gain_nm_rad, 1e-6);
  EXPECT_NEAR(joint.angle_rad - joint.servo.motor_angle_rad(), 3.0 / 60.0, 1e-6);
}

// The motor holds its angle, and the joint swings on its spring: I q" = -k q - d q'. A stiff servo hardly moves.
TEST(Servo, AJointOnItsSpringSwingsAndDecaysAsTheEquationSays) {
  for (const double inertia : {0.02, 0.1}) {
    JointModel held = elastic_model();
    held.position_gain_nm_rad = 1e5;
    held.velocity_gain_nm_s_rad = 1e3;
    Joint joint(held, inertia);
    joint.angle_rad = 0.02;
    std::vector<double> crossings_s;
    std::vector<double> peaks_rad;
    double peak_rad = 0.0;
    for (int i = 0; crossings_s.size() < 4; ++i) {
      ASSERT_LT(i, 1000);
      if (i % kSteps == 0) {
        joint.servo.set({0.0, 0.0, 6.0});
        joint.servo.begin_tick(kSteps, kStep_s);
      }
      const double before = joint.angle_rad;
      joint.step();
      peak_rad = std::max(peak_rad, std::abs(joint.angle_rad));
      if (before * joint.angle_rad >= 0.0) continue;
      crossings_s.push_back(kStep_s * (i + before / (before - joint.angle_rad)));
      peaks_rad.push_back(std::exchange(peak_rad, 0.0));
    }
    const double decay = 0.5 * 0.5 / inertia;  // d / 2I
    const double w = std::sqrt(60.0 / inertia - decay * decay);
    const double half_s = (crossings_s[3] - crossings_s[1]) / 2.0;
    EXPECT_NEAR(std::numbers::pi / half_s, w, 0.03 * w) << inertia;
    // The first peak is the angle of the start; the others are those between two crossings, half a period apart.
    const double decrement = decay * 2.0 * std::numbers::pi / w;
    EXPECT_NEAR(std::log(peaks_rad[1] / peaks_rad[3]), decrement, 0.05 * decrement) << inertia;
  }
}

TEST(Servo, ASpringNeverTransmitsMoreThanTheTorqueLimit) {
  Joint joint(elastic_model());
  joint.load_nm = 1.2;
  for (int i = 0; i < 50; ++i) {
    joint.tick({0.0, 0.0, 1.0});
    EXPECT_LE(std::abs(joint.torque_nm), 1.0 + 1e-9);
  }
  EXPECT_GT(joint.angle_rad, 0.5);  // the load wins
}

TEST(Servo, BacklashLagsByHalfOfThePlayInTheDirectionOfMotion) {
  JointModel loose = model();
  loose.stiffness_nm_rad = 400.0;
  loose.damping_nm_s_rad = 0.5;
  loose.backlash_rad = 0.02;
  Joint joint(loose);
  const auto move_to = [&](double from_rad, double to_rad) {
    for (int i = 1; i <= 250; ++i) {
      // Friction of the joint keeps it in place while the gear does not touch.
      joint.load_nm = -2.0 * joint.rate_rad_s;
      joint.tick({from_rad + (to_rad - from_rad) * std::min(i / 200.0, 1.0), 0.0, 6.0});
    }
  };
  move_to(0.0, 0.2);
  EXPECT_NEAR(joint.angle_rad, 0.2 - 0.01, 5e-4);
  move_to(0.2, 0.185);  // less than the play: the joint stays
  EXPECT_NEAR(joint.angle_rad, 0.2 - 0.01, 5e-4);
  move_to(0.185, 0.0);
  EXPECT_NEAR(joint.angle_rad, 0.0 + 0.01, 5e-4);
}

TEST(Servo, BacklashTransmitsNoTorqueUntilTheGearTouches) {
  JointModel loose = model();
  loose.stiffness_nm_rad = 400.0;
  loose.backlash_rad = 0.1;
  Joint joint(loose);
  joint.rate_rad_s = 1.0;  // pushed by hand through the play of 0.05 rad on this side
  joint.tick({0.0, 0.0, 6.0});
  EXPECT_EQ(joint.torque_nm, 0.0);
  EXPECT_NEAR(joint.angle_rad, kTick_s, 1e-12);
  for (int i = 0; i < 5; ++i) joint.tick({0.0, 0.0, 6.0});
  EXPECT_LT(joint.rate_rad_s, 0.0);  // thrown back
}

TEST(Servo, AnEncoderOfCoarseStepsHoldsWithinOneStep) {
  JointModel coarse = model();
  coarse.encoder_step_rad = 0.01;
  Joint joint(coarse);
  for (int i = 0; i < 200; ++i) joint.tick({0.123, 0.0, 6.0});
  EXPECT_NEAR(joint.angle_rad, 0.123, 0.01);
  EXPECT_DOUBLE_EQ(coarse.measured_rad(0.123), 0.12);
  EXPECT_DOUBLE_EQ(coarse.measured_rad(-0.126), -0.13);
  EXPECT_EQ(model().measured_rad(0.123), 0.123);
}

}  // namespace
}  // namespace constrictor
