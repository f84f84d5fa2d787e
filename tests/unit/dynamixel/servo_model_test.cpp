// Models of servos and bus files: what they contain, and what is refused with which reason.
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <string>

#include "configuration/configuration.hpp"
#include "dynamixel/bus_plan.hpp"
#include "support/project.hpp"
#include "support/temporary_folder.hpp"

namespace constrictor::dynamixel {
namespace {

namespace fs = std::filesystem;

const fs::path kModels = testing::source_path("components/lib/dynamixel/models");

TEST(ServoModel, HasTheRegistersOfTheManual) {
  for (const char* name : {"xm540_w150", "xm540_w270", "xm430_w350"}) {
    const ServoModel model = load_servo_model(kModels / (std::string(name) + ".yaml"));
    EXPECT_EQ(model.at("operating_mode").address, 11) << name;
    EXPECT_EQ(model.at("hardware_error_status").address, 70);
    EXPECT_EQ(model.at("bus_watchdog").address, 98);
    EXPECT_EQ(model.at("goal_current").address, 102);
    EXPECT_EQ(model.at("goal_position").address, 116);
    EXPECT_EQ(model.at("present_current").address, 126);
    EXPECT_EQ(model.at("present_velocity").address, 128);
    EXPECT_EQ(model.at("present_position").address, 132);
    EXPECT_EQ(model.at("indirect_address_28").address, 222);
    EXPECT_EQ(model.at("indirect_data_28").address, 251);
    EXPECT_TRUE(model.at("operating_mode").eeprom());
    EXPECT_FALSE(model.at("goal_position").eeprom());
    EXPECT_FALSE(model.at("present_position").writable);
    EXPECT_EQ(model.containing(133), &model.at("present_position"));
    EXPECT_EQ(model.containing(148), nullptr);
    EXPECT_EQ(model.containing(1000), nullptr);
    EXPECT_THROW(static_cast<void>(model.at("present_mood")), std::out_of_range);
  }
}

TEST(ServoModel, NamesAllHardwareErrors) {
  EXPECT_EQ(hardware_error_text(0), "none");
  EXPECT_EQ(hardware_error_text(hardware_error::kOverload | hardware_error::kOverheating), "overheating, overload");
}

constexpr const char* kBus =
    "ports:\n  - {device: /dev/ttyUSB0, baud: 4000000}\n  - {device: bus1, baud: 1000000}\n"
    "servo: {model: xm540_w150, gear: 2}\n"
    "joints:\n  - {id: 1}\n  - {id: 2, direction: -1, zero_steps: 1000, gear: 1}\n  - {port: 1, id: 1}\n"
    "imu: {port: 1, id: 100}\ncontacts: {port: 1, ids: [101, 102, 103, 104]}\n";

class BusFile : public ::testing::Test {
 protected:
  BusPlan load(const std::string& text) {
    std::ofstream(file_) << text;
    return load_bus_plan(file_, kModels);
  }
  /// The error of kBus with one replacement.
  std::string error(const std::string& what, const std::string& with) {
    std::string text = kBus;
    const auto at = text.find(what);
    EXPECT_NE(at, std::string::npos) << what;
    text.replace(at, what.size(), with);
    try {
      load(text);
    } catch (const ConfigurationError& found) {
      return found.what();
    }
    return "no error";
  }

  const testing::TemporaryFolder folder_;
  const fs::path file_ = folder_.path() / "bus.yaml";
};

TEST_F(BusFile, DescribesEachJoint) {
  const BusPlan plan = load(kBus);
  ASSERT_EQ(plan.joints.size(), 3u);
  EXPECT_EQ(plan.ports[0].baud, 4000000u);
  EXPECT_EQ(plan.joints[0].gear, 2.0);
  EXPECT_NEAR(plan.joints[0].torque_constant_nm_a, 7.3 / 4.4, 1e-12);
  EXPECT_EQ(plan.joints[1].gear, 1.0);
  EXPECT_EQ(plan.servo_ids(0), (Bytes{1, 2}));
  EXPECT_EQ(plan.servo_ids(1), (Bytes{1}));
  EXPECT_EQ(plan.imu->id, 100);
  EXPECT_EQ(plan.contact_boards.size(), 4u);
}

TEST_F(BusFile, ConvertsBetweenServoAndJoint) {
  const BusPlan plan = load(kBus);
  const ServoModel& model = plan.model;
  // Joint 0: a quarter turn of the joint is half a turn of the servo.
  EXPECT_EQ(plan.joints[0].steps(model, std::acos(0.0)), 2048 + 2048);
  EXPECT_NEAR(plan.joints[0].angle_rad(model, 2048 - 1024), -0.5 * std::acos(0.0), 1e-12);
  // Joint 1 turns the other way, about its own zero.
  EXPECT_EQ(plan.joints[1].steps(model, std::acos(0.0)), 1000 - 1024);
  EXPECT_NEAR(plan.joints[1].angle_rad(model, 0), 1000 * 2 * std::acos(-1.0) / 4096, 1e-12);
  EXPECT_NEAR(plan.joints[1].rate_rad_s(model, 100), -100 * 0.229 * 2 * std::acos(-1.0) / 60, 1e-5);
  // 100 units of 2.69 mA at 7.3/4.4 Nm/A; joint 0 has a gear of 2 behind the servo.
  EXPECT_NEAR(plan.joints[1].torque_nm(model, 100), -0.269 * 7.3 / 4.4, 1e-9);
  EXPECT_NEAR(plan.joints[0].torque_nm(model, 100), 2 * 0.269 * 7.3 / 4.4, 1e-9);
  EXPECT_EQ(plan.joints[1].current_units(model, 0.269 * 7.3 / 4.4, 2047), 100);
  EXPECT_EQ(plan.joints[1].current_units(model, 1000.0, 2047), 2047);
}

TEST_F(BusFile, RefusesMistakesWithTheirReasons) {
  EXPECT_NE(error("id: 2,", "id: 1,").find("joints[1].id: found id 1 twice at port 0"), std::string::npos)
      << error("id: 2,", "id: 1,");
  EXPECT_NE(error("id: 100", "id: 1").find("found id 1 twice at port 1"), std::string::npos);
  EXPECT_NE(error("4000000", "4000001").find("accepted one of 9600"), std::string::npos);
  EXPECT_NE(error("direction: -1", "direction: 0").find("accepted 1 or -1"), std::string::npos);
  EXPECT_NE(error("port: 1, id: 1}", "port: 2, id: 1}").find("joints[2].port: found 2"), std::string::npos)
      << error("port: 1, id: 1}", "port: 2, id: 1}");
  EXPECT_NE(error("104]", "104, 105]").find("contacts.ids"), std::string::npos);
  EXPECT_NE(error("bus1", "/dev/ttyUSB0").find("each device once"), std::string::npos);
  EXPECT_NE(error("xm540_w150", "xm541").find("xm541"), std::string::npos);
  EXPECT_NE(error("zero_steps", "zero_step").find("zero_step"), std::string::npos) << "an unknown key";
}

}  // namespace
}  // namespace constrictor::dynamixel
