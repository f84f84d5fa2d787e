// The emulated robot as a whole: the same physics as the simulated plant, driven through bytes.
#include <cmath>

#include "bus_fixture.hpp"
#include "configuration/configuration.hpp"
#include "dynamixel/sensor_board.hpp"
#include "sim/scenario_loader/scenario_file.hpp"
#include "sim/servo_emulator/emulated_robot.hpp"
#include "support/project.hpp"

namespace constrictor::servo_emulator {
namespace {

namespace fs = std::filesystem;
namespace map = dynamixel::sensor_board;
const fs::path kProject = testing::source_path();

class Robot : public ::testing::Test {
 protected:
  Robot()
      : plan_(dynamixel::load_bus_plan(kProject / "deploy/buses/mamba_emulated.yaml",
                                       kProject / "components/lib/dynamixel/models")),
        robot_(load_robot(kProject / "components/lib/robot/mamba.yaml"),
               load_scenario(kProject / "sim/scenarios/line.yaml", 1), plan_, 1) {}
  void pass(double seconds) { robot_.advance_to(now_ns_ += std::llround(seconds * 1e9)); }
  /// Writes a register of a servo over its line, as a controller does.
  void write(std::size_t joint, const char* name, std::int64_t value) {
    const auto& reg = plan_.model.at(name);
    Bytes data;
    dynamixel::put_value(data, reg, value);
    Bytes packet;
    dynamixel::put_write(packet, plan_.joints[joint].id, reg.address, data);
    const std::size_t port = plan_.joints[joint].port;
    robot_.line(port).receive(packet, plan_.ports[port].baud, now_ns_);
    robot_.line(port).outgoing().clear();
  }
  double angle_rad(std::size_t joint) { return robot_.world().joint_angle_rad(joint); }

  dynamixel::BusPlan plan_;
  EmulatedRobot robot_;
  std::int64_t now_ns_ = 0;
};

TEST_F(Robot, AServoMovesItsJointInItsDirectionAboutItsZero) {
  for (std::size_t joint : {2u, 3u}) {  // joint 3 turns the other way
    write(joint, "operating_mode", 5);
    write(joint, "torque_enable", 1);
    write(joint, "goal_position", plan_.joints[joint].steps(plan_.model, joint == 2 ? 0.3 : 0.0));
  }
  pass(1.0);
  EXPECT_NEAR(angle_rad(2), 0.3, 0.01);
  EXPECT_NEAR(angle_rad(3), 0.0, 0.01);
  EXPECT_EQ(robot_.servo(2).get("present_position"), plan_.joints[2].steps(plan_.model, angle_rad(2)));
  EXPECT_EQ(robot_.servo(3).get("present_position"), plan_.joints[3].steps(plan_.model, angle_rad(3)));
}

TEST_F(Robot, EqualBytesGiveEqualWorlds) {
  EmulatedRobot other(robot_.world().robot(), robot_.world().scenario(), plan_, 1);
  write(0, "torque_enable", 1);
  write(0, "goal_position", 2300);
  Bytes packets;
  dynamixel::put_write(packets, 1, 64, Bytes{1});
  dynamixel::put_write(packets, 1, 116, Bytes{0xFC, 0x08, 0, 0});
  other.line(0).receive(packets, plan_.ports[0].baud, 0);
  for (int i = 0; i < 50; ++i) {
    pass(0.02);
    other.advance_to(now_ns_);
  }
  EXPECT_EQ(robot_.world().state_hash(), other.world().state_hash());
  EXPECT_GT(std::abs(angle_rad(0)), 0.2);
}

TEST_F(Robot, TheBoardsMeasureGravityAndWeight) {
  pass(1.0);
  const auto number = [&](std::uint8_t id, std::size_t port, std::uint16_t address) {
    Bytes packet;
    dynamixel::put_read(packet, id, address, 2);
    robot_.line(port).receive(packet, plan_.ports[port].baud, now_ns_);
    dynamixel::PacketParser parser;
    for (const auto& sent : robot_.line(port).outgoing()) parser.add(sent.bytes);
    robot_.line(port).outgoing().clear();
    const auto answer = parser.next();
    EXPECT_TRUE(answer);
    return answer ? static_cast<double>(dynamixel::get_number(answer->data(), 2, true)) : NAN;
  };
  EXPECT_NEAR(number(100, 0, map::imu::kLinearAcceleration + 4) * map::kAcceleration_m_s2, 9.81, 0.3);
  EXPECT_NEAR(number(100, 0, map::imu::kOrientation) * map::kUnitVector, 1.0, 1e-3);
  const auto force_n = [&](int module) {
    return number(static_cast<std::uint8_t>(101 + module), 1, map::contact::kForce + 4) * map::kForce_n;
  };
  double weight_n = 0.0;
  for (int i = 0; i < 24; ++i) weight_n += force_n(i);
  EXPECT_NEAR(weight_n, 24 * 0.3 * 9.81, 3.0);

  // A numb module feels nothing, though its board answers; the others go on feeling.
  EXPECT_EQ(robot_.command("numb 5"), "");
  pass(0.02);
  EXPECT_EQ(force_n(5), 0.0);
  EXPECT_NE(force_n(6), 0.0);
  EXPECT_EQ(robot_.command("feel 5"), "");
  pass(0.02);
  EXPECT_NE(force_n(5), 0.0);
}

TEST_F(Robot, ABrokenCableTakesThePowerOfTheServosBehindIt) {
  for (std::size_t joint : {5u, 9u}) write(joint, "torque_enable", 1);
  EXPECT_EQ(robot_.command("cable 0 6"), "");
  EXPECT_EQ(robot_.servo(5).get("torque_enable"), 1);
  EXPECT_EQ(robot_.servo(9).get("torque_enable"), 0);
  write(9, "torque_enable", 1);
  EXPECT_EQ(robot_.servo(9).get("torque_enable"), 0) << "it does not receive";
  EXPECT_EQ(robot_.command("mend 0"), "");
  write(9, "torque_enable", 1);
  EXPECT_EQ(robot_.servo(9).get("torque_enable"), 1);
}

TEST_F(Robot, AStuckJointStaysWhileItsMotorPullsAndMovesWhenItIsHealed) {
  write(2, "operating_mode", 5);
  write(2, "torque_enable", 1);
  write(2, "goal_current", 300);
  pass(0.2);
  const double before = angle_rad(2);
  EXPECT_EQ(robot_.command("stuck 2"), "");
  write(2, "goal_position", plan_.joints[2].steps(plan_.model, 0.5));
  pass(0.5);
  EXPECT_NEAR(angle_rad(2), before, 0.005);
  EXPECT_NEAR(static_cast<double>(std::abs(robot_.servo(2).get("present_current"))), 300, 30)
      << "the motor exerts its goal current";
  EXPECT_EQ(robot_.command("heal 2"), "");
  pass(1.0);
  EXPECT_NEAR(angle_rad(2), 0.5, 0.02);
}

TEST_F(Robot, AWeakServoExertsItsShareForTheSameCurrent) {
  write(2, "torque_enable", 1);
  const double whole_nm = robot_.servo(2).order(0.004).torque_limit_nm;
  ASSERT_GT(whole_nm, 0.0);
  EXPECT_EQ(robot_.command("weak 2 0.25"), "");
  EXPECT_DOUBLE_EQ(robot_.servo(2).order(0.004).torque_limit_nm, 0.25 * whole_nm);
  EXPECT_EQ(robot_.command("heal 2"), "");
  EXPECT_DOUBLE_EQ(robot_.servo(2).order(0.004).torque_limit_nm, whole_nm);
}

TEST_F(Robot, AHotServoSwitchesItsTorqueOff) {
  write(2, "torque_enable", 1);
  EXPECT_EQ(robot_.command("hot 2 95"), "");
  pass(0.02);
  EXPECT_EQ(robot_.servo(2).get("present_temperature"), 95);
  EXPECT_EQ(robot_.servo(2).get("hardware_error_status") & 4, 4) << "overheating";
  EXPECT_EQ(robot_.servo(2).get("torque_enable"), 0);
}

TEST_F(Robot, AHealedServoHasItsIdAndItsVoltageAgainAndAnswers) {
  const auto id = robot_.servo(4).get("id");
  for (const char* line : {"id 4 77", "voltage 4 6", "silent 4", "heal 4"}) EXPECT_EQ(robot_.command(line), "") << line;
  pass(0.02);
  EXPECT_EQ(robot_.servo(4).get("id"), id);
  EXPECT_EQ(robot_.servo(4).get("present_input_voltage"), 120);
  write(4, "led", 1);
  EXPECT_EQ(robot_.servo(4).get("led"), 1);
}

TEST_F(Robot, CommandsAreRefusedWithWhatIsAccepted) {
  EXPECT_NE(robot_.command("explode 3").find("accepted ambient JOINT CELSIUS, cable PORT PLACE"), std::string::npos);
  EXPECT_EQ(robot_.command("cable 2 0"), "found 'cable 2 0', accepted cable PORT PLACE with 0 to 1 and 0 to 255");
  EXPECT_EQ(robot_.command("reboot 23"), "found 'reboot 23', accepted reboot JOINT with 0 to 22");
  for (const char* line :
       {"", "cable", "cable 0", "cable 0 1 2", "cable x 1", "silent 1.5", "damage 0 1.5", "id 3 253"})
    EXPECT_NE(robot_.command(line), "") << line;
}

TEST_F(Robot, ASlowHostLeavesTimeOut) {
  EXPECT_EQ(robot_.advance_to(1'000'000'000), std::lround(0.2 / SolverSettings{}.step_s));
  EXPECT_EQ(robot_.left_out_ns(), 800'000'000);
  EXPECT_NEAR(robot_.world().time_s(), 0.2, 1e-9);
}

TEST_F(Robot, ABusFileOfAnotherRobotIsRefused) {
  dynamixel::BusPlan shorter = plan_;
  shorter.joints.pop_back();
  EXPECT_THROW(EmulatedRobot(robot_.world().robot(), robot_.world().scenario(), shorter, 1), ConfigurationError);
}

}  // namespace
}  // namespace constrictor::servo_emulator
