// One emulated servo by the rules of the manual: access to registers, protections, watchdog, modes.
#include <cmath>

#include "bus_fixture.hpp"

namespace constrictor::servo_emulator {
namespace {

TEST(ServoDevice, BeginsAsFromTheFactoryWithItsTorqueOff) {
  NamedServo servo(7);
  EXPECT_EQ(servo.read("model_number"), 1130);
  EXPECT_EQ(servo.read("id"), 7);
  EXPECT_EQ(servo.read("baud_rate"), 3);
  EXPECT_EQ(servo.read("torque_enable"), 0);
  EXPECT_EQ(servo.read("present_position"), 2048);
  EXPECT_EQ(servo.device.return_delay_ns(), 500'000);
  EXPECT_EQ(servo.device.order(0.004).torque_limit_nm, 0.0);
}

TEST(ServoDevice, ReadOnlyRegistersCannotBeWritten) {
  NamedServo servo;
  for (const char* name : {"model_number", "present_position", "hardware_error_status", "present_temperature"})
    EXPECT_EQ(servo.write(name, 0), StatusError::kAccess) << name;
}

TEST(ServoDevice, TheEepromIsLockedWhileTheTorqueIsOn) {
  NamedServo servo;
  EXPECT_EQ(servo.write("operating_mode", 5), StatusError::kNone);
  EXPECT_EQ(servo.write("torque_enable", 1), StatusError::kNone);
  for (const char* name : {"id", "baud_rate", "operating_mode", "return_delay_time", "current_limit"})
    EXPECT_EQ(servo.write(name, 3), StatusError::kAccess) << name;
  EXPECT_EQ(servo.write("goal_position", 2000), StatusError::kNone);
  EXPECT_EQ(servo.write("torque_enable", 0), StatusError::kNone);
  EXPECT_EQ(servo.write("operating_mode", 3), StatusError::kNone);
}

TEST(ServoDevice, ValuesBeyondTheTableAndBeyondTheLimitsHaveTheirOwnErrors) {
  NamedServo servo;
  EXPECT_EQ(servo.write("baud_rate", 8), StatusError::kDataRange);
  EXPECT_EQ(servo.write("torque_enable", 2), StatusError::kDataRange);
  EXPECT_EQ(servo.write("goal_current", 2048), StatusError::kDataRange);
  EXPECT_EQ(servo.write("current_limit", 500), StatusError::kNone);
  EXPECT_EQ(servo.write("goal_current", -501), StatusError::kDataLimit);
  EXPECT_EQ(servo.write("goal_current", -500), StatusError::kNone);
  EXPECT_EQ(servo.write("goal_position", 4096), StatusError::kDataLimit) << "operating mode 3: one turn";
  EXPECT_EQ(servo.write("operating_mode", 5), StatusError::kNone);
  EXPECT_EQ(servo.write("goal_position", 4096), StatusError::kNone) << "operating mode 5: several turns";
}

TEST(ServoDevice, AWriteIsRefusedAsAWhole) {
  NamedServo servo;
  ASSERT_EQ(servo.write("operating_mode", 5), StatusError::kNone);
  Bytes bytes;  // goal_pwm, goal_current, goal_velocity: the last one is beyond its limit
  dynamixel::put_number(bytes, 100, 2);
  dynamixel::put_number(bytes, 100, 2);
  dynamixel::put_number(bytes, 5000, 4);
  EXPECT_EQ(servo.device.write(100, bytes), StatusError::kDataRange);
  EXPECT_EQ(servo.read("goal_pwm"), 885);
  EXPECT_EQ(servo.device.write(117, Bytes(1)), StatusError::kDataLength) << "in the middle of a register";
  EXPECT_EQ(servo.device.write(116, Bytes(2)), StatusError::kDataLength) << "a part of a register";
  EXPECT_EQ(servo.device.write(116, {}), StatusError::kDataLength);
  EXPECT_EQ(servo.device.write(1000, Bytes(1)), StatusError::kDataRange);
  Bytes to;
  EXPECT_EQ(servo.device.read(250, 10, to), StatusError::kDataRange);
}

TEST(ServoDevice, IndirectDataLeadToTheRegistersBehindThem) {
  NamedServo servo;
  ASSERT_EQ(servo.write("operating_mode", 5), StatusError::kNone);
  const std::uint16_t targets[] = {102, 103, 116, 117, 118, 119, 146};
  for (std::uint16_t i = 0; i < 7; ++i)
    ASSERT_EQ(servo.write("indirect_address_" + std::to_string(i + 1), targets[i]), StatusError::kNone);
  Bytes goals;
  dynamixel::put_number(goals, 300, 2);
  dynamixel::put_number(goals, -70000, 4);
  EXPECT_EQ(servo.device.write(224, goals), StatusError::kNone);
  EXPECT_EQ(servo.read("goal_current"), 300);
  EXPECT_EQ(servo.read("goal_position"), -70000);
  Bytes read;
  EXPECT_EQ(servo.device.read(224, 7, read), StatusError::kNone);
  EXPECT_EQ(Bytes(read.begin(), read.begin() + 6), goals);
  EXPECT_EQ(read[6], 25) << "degrees";
  dynamixel::put_number(goals, 0, 1);
  EXPECT_EQ(servo.device.write(224, goals), StatusError::kAccess) << "present_temperature is read-only";
}

TEST(ServoDevice, TheBusWatchdogStopsTheServoAndLocksItsGoals) {
  NamedServo servo;
  ASSERT_EQ(servo.write("operating_mode", 5), StatusError::kNone);
  ASSERT_EQ(servo.write("bus_watchdog", 5), StatusError::kNone);
  servo.pass(1.0);
  EXPECT_EQ(servo.read("bus_watchdog"), 5) << "it watches only while the torque is on";
  ASSERT_EQ(servo.write("torque_enable", 1), StatusError::kNone);
  ASSERT_EQ(servo.write("goal_position", 3000), StatusError::kNone);
  for (int i = 0; i < 20; ++i) {
    servo.pass(0.08);
    servo.device.heard(servo.now_ns);
    EXPECT_EQ(servo.read("bus_watchdog"), 5);
  }
  servo.pass(0.1);
  EXPECT_EQ(servo.read("bus_watchdog"), 5);
  servo.pass(0.004);
  EXPECT_EQ(servo.read("bus_watchdog"), -1);
  EXPECT_EQ(servo.read("torque_enable"), 1) << "the torque stays on";
  const double stopped_rad = servo.device.order(0.004).position_rad;
  servo.device.heard(servo.now_ns);
  for (const char* name : {"goal_pwm", "goal_current", "goal_velocity", "goal_position"})
    EXPECT_EQ(servo.write(name, 1), StatusError::kDataRange) << name;
  servo.pass(0.5);
  EXPECT_EQ(servo.device.order(0.004).position_rad, stopped_rad);
  EXPECT_EQ(servo.device.order(0.004).velocity_rad_s, 0.0);
  EXPECT_EQ(servo.write("bus_watchdog", 0), StatusError::kNone);
  EXPECT_EQ(servo.write("goal_position", 2100), StatusError::kNone);
}

TEST(ServoDevice, ATimeBasedProfileTakesItsTime) {
  NamedServo servo;
  ASSERT_EQ(servo.write("operating_mode", 5), StatusError::kNone);
  ASSERT_EQ(servo.write("drive_mode", 4), StatusError::kNone);
  ASSERT_EQ(servo.write("profile_velocity", 100), StatusError::kNone);  // ms
  ASSERT_EQ(servo.write("torque_enable", 1), StatusError::kNone);
  ASSERT_EQ(servo.write("goal_position", 2048 + 100), StatusError::kNone);
  const double way_rad = 100 * 2 * M_PI / 4096;
  servo.pass(0.048);
  EXPECT_NEAR(servo.device.order(0.004).position_rad, way_rad * 0.52, 1e-9);
  EXPECT_NEAR(servo.device.order(0.004).velocity_rad_s, way_rad / 0.1, 1e-9);
  servo.pass(0.1);
  EXPECT_NEAR(servo.device.order(0.004).position_rad, way_rad, 1e-9);
  EXPECT_EQ(servo.device.order(0.004).velocity_rad_s, 0.0);
}

TEST(ServoDevice, WithoutAProfileTheServoGoesToItsGoalAtOnce) {
  NamedServo servo;
  ASSERT_EQ(servo.write("operating_mode", 5), StatusError::kNone);
  ASSERT_EQ(servo.write("torque_enable", 1), StatusError::kNone);
  ASSERT_EQ(servo.write("goal_position", 2048 + 1000), StatusError::kNone);
  EXPECT_NEAR(servo.device.order(0.004).position_rad, 1000 * 2 * M_PI / 4096, 1e-9);
  EXPECT_EQ(servo.device.order(0.004).velocity_rad_s, 0.0);
}

TEST(ServoDevice, TheGoalCurrentLimitsTheTorque) {
  NamedServo servo;
  ASSERT_EQ(servo.write("operating_mode", 5), StatusError::kNone);
  ASSERT_EQ(servo.write("goal_current", 400), StatusError::kNone);
  EXPECT_EQ(servo.device.order(0.004).torque_limit_nm, 0.0);
  ASSERT_EQ(servo.write("torque_enable", 1), StatusError::kNone);
  EXPECT_NEAR(servo.device.order(0.004).torque_limit_nm, 400 * 0.00269 * 2.0, 1e-9);
}

TEST(ServoDevice, CurrentControlPushesInTheDirectionOfTheCurrent) {
  NamedServo servo;
  ASSERT_EQ(servo.write("operating_mode", 0), StatusError::kNone);
  ASSERT_EQ(servo.write("torque_enable", 1), StatusError::kNone);
  ASSERT_EQ(servo.write("goal_current", -100), StatusError::kNone);
  EXPECT_TRUE(servo.device.order(0.004).torque_mode);
  EXPECT_NEAR(servo.device.order(0.004).torque_nm, -100 * 0.00269 * 2.0, 1e-9);
  EXPECT_NEAR(servo.device.order(0.004).torque_limit_nm, 100 * 0.00269 * 2.0, 1e-9);
}

TEST(ServoDevice, MeasuresItsJoint) {
  NamedServo servo;
  ASSERT_EQ(servo.write("torque_enable", 1), StatusError::kNone);
  servo.pass(0.004, {0.5, -1.0, 0.8});
  EXPECT_EQ(servo.read("present_position"), std::lround(2048 + 0.5 * 4096 / (2 * M_PI)));
  EXPECT_EQ(servo.read("present_velocity"), std::lround(-1.0 / (0.229 * 2 * M_PI / 60)));
  EXPECT_EQ(servo.read("present_current"), std::lround(0.8 / 2.0 / 0.00269));
  EXPECT_EQ(servo.read("present_input_voltage"), 120);
}

TEST(ServoDevice, HeatsUpByTheLawOfTheThermalModelAndShutsDown) {
  ServoTraits traits = NamedServo::quiet();
  NamedServo servo(1, traits);
  ASSERT_EQ(servo.write("torque_enable", 1), StatusError::kNone);
  const double amperes = 1.5;
  servo.pass(60.0, {0.0, 0.0, amperes * 2.0});
  const double power_w = amperes * amperes * traits.resistance_ohm;
  const double time_constant_s = traits.heat_capacity_j_k * traits.heat_resistance_k_w;
  const double expected_c = 25.0 + power_w * traits.heat_resistance_k_w * (1.0 - std::exp(-60.0 / time_constant_s));
  EXPECT_NEAR(servo.device.temperature_c(), expected_c, 0.01);
  EXPECT_FALSE(servo.device.alert());
  servo.device.traits().ambient_c = 300.0;
  servo.pass(120.0, {0.0, 0.0, 3.0});
  EXPECT_EQ(servo.read("hardware_error_status"), dynamixel::hardware_error::kOverheating);
  EXPECT_EQ(servo.read("torque_enable"), 0);
  EXPECT_EQ(servo.write("torque_enable", 1), StatusError::kResultFail) << "only a reboot helps";
}

TEST(ServoDevice, AnOverloadSwitchesTheTorqueOffUntilAReboot) {
  NamedServo servo;
  ASSERT_EQ(servo.write("torque_enable", 1), StatusError::kNone);
  const JointMotion stalled{0.0, 0.0, 0.9 * 4.4 * 2.0};
  servo.pass(2.9, stalled);
  EXPECT_FALSE(servo.device.alert());
  servo.pass(0.2, stalled);
  EXPECT_EQ(servo.read("hardware_error_status"), dynamixel::hardware_error::kOverload);
  EXPECT_EQ(servo.device.order(0.004).torque_limit_nm, 0.0);
  servo.device.reboot();
  EXPECT_EQ(servo.read("hardware_error_status"), 0);
  EXPECT_EQ(servo.write("torque_enable", 1), StatusError::kNone);
}

TEST(ServoDevice, ALowVoltageIsReportedAndDoesNotShutDown) {
  NamedServo servo;
  ASSERT_EQ(servo.write("torque_enable", 1), StatusError::kNone);
  servo.device.traits().supply_v = 9.0;
  servo.pass(0.1);
  EXPECT_TRUE(servo.device.alert());
  EXPECT_EQ(servo.read("hardware_error_status"), dynamixel::hardware_error::kInputVoltage);
  EXPECT_EQ(servo.read("torque_enable"), 1) << "the register `shutdown` does not name the voltage";
}

}  // namespace
}  // namespace constrictor::servo_emulator
