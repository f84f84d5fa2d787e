// Files of faults, and the paths of fields that they name.
#include "faults/fault_plan.hpp"

#include <gtest/gtest.h>

#include <fstream>

#include "configuration/configuration.hpp"
#include "faults/message_fields.hpp"
#include "support/temporary_folder.hpp"

namespace constrictor {
namespace {

class FaultFile : public ::testing::Test {
 protected:
  FaultPlan load(const std::string& text) {
    const auto file = dir_.path() / "faults.yaml";
    std::ofstream(file) << text;
    return load_fault_plan(file, targets_);
  }
  /// The error about one fault, without the file; "accepted" if there is none.
  std::string error(const std::string& fault) {
    try {
      load("faults:\n  - {" + fault + "}\n");
    } catch (const ConfigurationError& error) {
      const std::string what = error.what();
      return what.substr(what.find("faults[0]"));
    }
    return "accepted";
  }
  FaultTargets targets_{{"physics", "camera", "control"}};
  testing::TemporaryFolder dir_;
};

TEST_F(FaultFile, SaysWhatHappensToWhatAndWhen) {
  const FaultPlan plan = load(
      "seed: 7\n"
      "faults:\n"
      "  - {topic: camera/image, kind: delay, delay_ticks: 3, from_s: 1.5, until_s: 2, probability: 0.25}\n"
      "  - {process: camera, kind: kill, at_s: 4}\n"
      "  - {topic: imu_state, kind: bias, field: angular_velocity_rad_s.z, amount: 0.5}\n");
  EXPECT_EQ(plan.seed, 7u);
  ASSERT_EQ(plan.topics.size(), 2u);
  EXPECT_EQ(plan.topics[0].kind, TopicFault::Kind::kDelay);
  EXPECT_EQ(plan.topics[0].topic->id, topics::kCameraImage.id);
  EXPECT_EQ(plan.topics[0].from_ns, 1'500'000'000);
  EXPECT_EQ(plan.topics[0].until_ns, 2'000'000'000);
  EXPECT_EQ(plan.topics[0].probability, 0.25);
  EXPECT_EQ(plan.topics[0].delay_ticks, 3);
  EXPECT_EQ(plan.topics[1].number, 3u) << "the place in the file, processes included";
  ASSERT_EQ(plan.processes.size(), 1u);
  EXPECT_EQ(describe(plan.processes[0]), "kill of camera");
  EXPECT_EQ(describe(plan.topics[0]), "delay of camera/image");
}

TEST_F(FaultFile, ALinkThatIsDownConcernsEachTopicThatCrossesIt) {
  targets_.roster = {"physics", "camera", "perception", "control"};
  const FaultPlan plan = load("faults:\n  - {link: [perception], kind: down, from_s: 2, until_s: 3}\n");
  ASSERT_EQ(plan.links.size(), 1u);
  EXPECT_EQ(describe(plan.links[0]), "link down between perception and the others");
  const auto readers_of = [&](std::uint8_t topic) {
    for (const auto& fault : plan.topics) {
      if (fault.topic->id == topic) return fault.readers;
    }
    return std::vector<std::string>{"no fault"};
  };
  EXPECT_EQ(readers_of(topics::kCameraImage.id), (std::vector<std::string>{"perception"}));
  EXPECT_EQ(readers_of(topics::kLinePercept.id), (std::vector<std::string>{"physics", "camera", "control"}));
  EXPECT_EQ(readers_of(topics::kTaskEvent.id), (std::vector<std::string>{"no fault"}))
      << "no member of this run writes it";
  for (const auto& fault : plan.topics) {
    EXPECT_EQ(fault.kind, TopicFault::Kind::kLinkDown);
    EXPECT_EQ(fault.from_ns, 2'000'000'000);
    EXPECT_EQ(fault.until_ns, 3'000'000'000);
  }
}

TEST_F(FaultFile, NoFileIsAPlanWithoutFaults) {
  const FaultPlan plan = load_fault_plan({}, {});
  EXPECT_TRUE(plan.topics.empty());
  EXPECT_TRUE(plan.processes.empty());
}

TEST_F(FaultFile, RefusesWhatCannotBe) {
  const std::pair<const char*, const char*> cases[] = {
      {"kind: drop", "faults[0].topic: found none or several of topic, link, process and device"},
      {"kind: drop, topic: imu_state, process: camera",
       "faults[0].topic: found none or several of topic, link, process and device"},
      {"topic: guidance/pos, kind: drop", "did you mean 'guidance/pose'?"},
      {"topic: imu_state, kind: lose", "faults[0].kind: found lose, accepted one of drop"},
      {"topic: imu_state, kind: drop, probability: 1.5", "faults[0].probability: found 1.5, accepted"},
      {"topic: imu_state, kind: drop, from_s: 3, until_s: 3",
       "faults[0].until_s: found a time that is not after from_s"},
      {"topic: imu_state, kind: delay, delay_ticks: 0", "faults[0].delay_ticks: found 0, accepted"},
      {"topic: imu_state, kind: drop, delay_ticks: 3", "faults[0].delay_ticks: found an unknown key"},
      {"topic: joint_state, kind: bias, field: position_rad, amount: 1",
       "position_rad needs an index from [0] to [63]"},
      {"topic: joint_state, kind: bias, field: 'position_rad[64]', amount: 1", "needs an index"},
      {"topic: joint_state, kind: bias, field: positon_rad, amount: 1", "did you mean 'position_rad'?"},
      {"topic: joint_state, kind: bias, field: joint_count, amount: 1", "it names no floating-point number"},
      {"topic: imu_state, kind: bias, field: angular_velocity_rad_s, amount: 1", "a group of fields"},
      {"topic: imu_state, kind: bias, field: angular_velocity_rad_s.w, amount: 1", "there is no such field"},
      {"topic: imu_state, kind: bias, field: angular_velocity_rad_s.z.z, amount: 1", "it goes on after a number"},
      {"link: [], kind: down", "faults[0].link: found none or all components of the run"},
      {"link: [control, camera, physics], kind: down", "faults[0].link: found none or all components of the run"},
      {"link: [cammera], kind: down", "found cammera, accepted one of physics, camera, control"},
      {"link: [camera], kind: up", "faults[0].kind: found up, accepted"},
      {"link: [camera], kind: down, probability: 0.5", "faults[0].probability: found an unknown key"},
      {"process: cammera, kind: kill, at_s: 1", "did you mean 'camera'?"},
      {"process: camera, kind: kill", "faults[0].at_s"},
      {"process: camera, kind: stop, at_s: 1", "faults[0].for_s"},
      {"process: camera, kind: drop, at_s: 1", "faults[0].kind: found drop, accepted one of kill"}};
  for (const auto& [fault, message] : cases)
    EXPECT_NE(error(fault).find(message), std::string::npos) << fault << ": " << error(fault);
  EXPECT_EQ(error("topic: joint_state, kind: bias, field: 'position_rad[63]', amount: 1"), "accepted");
}

TEST_F(FaultFile, BreaksDevicesThatRunBesideTheRun) {
  targets_.beside = {{"servo_emulator"}};
  targets_.joints = 23;
  const FaultPlan plan = load(
      "faults:\n"
      "  - {device: servo_emulator, kind: weak, joint: 22, share: 0.25, from_s: 2, until_s: 3}\n"
      "  - {device: servo_emulator, kind: cable, port: 0, place: 7}\n");
  ASSERT_EQ(plan.devices.size(), 2u);
  EXPECT_EQ(describe(plan.devices[0]), "weak 22 0.25 of servo_emulator");
  EXPECT_EQ(end_of(plan.devices[0].order), "heal 22");
  EXPECT_EQ(plan.devices[0].until_ns, 3'000'000'000);
  EXPECT_EQ(line_of(plan.devices[1].order), "cable 0 7");
  const std::pair<const char*, const char*> cases[] = {
      {"device: camera_emulator, kind: black", "which does not run beside this run, accepted servo_emulator"},
      {"device: servo, kind: stuck, joint: 1", "faults[0].device: found servo, accepted one of camera_emulator"},
      {"device: servo_emulator, kind: stick, joint: 1", "found stick, accepted one of ambient, cable"},
      {"device: servo_emulator, kind: stuck, joint: 23", "faults[0].joint: found 23, accepted"},
      {"device: servo_emulator, kind: stuck", "faults[0].joint"},
      {"device: servo_emulator, kind: weak, joint: 1, share: 0", "faults[0].share: found 0, accepted"},
      {"device: servo_emulator, kind: weak, joint: 1, share: .nan", "faults[0].share: found"},
      {"device: servo_emulator, kind: id, joint: 1, id: 2.5", "faults[0].id: found 2.5, accepted"},
      {"device: servo_emulator, kind: reboot, joint: 1, until_s: 3",
       "found a time, accepted none: nothing ends reboot"},
      {"device: servo_emulator, process: camera, kind: stuck",
       "found none or several of topic, link, process and device"}};
  for (const auto& [fault, message] : cases)
    EXPECT_NE(error(fault).find(message), std::string::npos) << fault << ": " << error(fault);
  targets_.beside->clear();
  EXPECT_NE(error("device: servo_emulator, kind: stuck, joint: 1").find("the manifest has no emulated devices"),
            std::string::npos);
  targets_.beside.reset();
  EXPECT_EQ(error("device: camera_emulator, kind: black"), "accepted") << "only the launcher knows the devices";
}

TEST(DeviceCommands, EachIsReadAsItIsWrittenAndEndedByACommand) {
  const auto count = [](std::string_view) { return std::size_t{3}; };
  std::size_t commands = 0;
  for (const auto& device : breakable_devices()) {
    for (const DeviceCommand* command : commands_of(device)) {
      ++commands;
      for (const double value : {command->min, command->max}) {
        const DeviceOrder order{command, command->of.empty() ? 0u : 2u, value};
        const auto read = read_order(device, line_of(order), count);
        ASSERT_TRUE(std::holds_alternative<DeviceOrder>(read)) << std::get<std::string>(read);
        EXPECT_EQ(std::get<DeviceOrder>(read).command, command);
        EXPECT_EQ(line_of(std::get<DeviceOrder>(read)), line_of(order));
      }
      const std::string end = end_of({command, 0, 0.0});
      if (end.empty()) continue;
      EXPECT_TRUE(std::holds_alternative<DeviceOrder>(read_order(device, end, count))) << end;
    }
  }
  EXPECT_GT(commands, 20u);
  EXPECT_EQ(std::get<std::string>(read_order("camera_emulator", "blur 51", count)),
            "found 'blur 51', accepted blur PIXELS with 0 to 50");
}

TEST(MessageFields, ABiasChangesOneNumberOfACopy) {
  auto message = std::make_shared<msg::ImuState>();
  message->angular_velocity_rad_s = {1, 2, 3};
  const Sample sample{message, &message->header};
  const Sample biased = with_bias(topics::kImuState.id, sample, "angular_velocity_rad_s.y", 0.5);
  const auto& changed = *static_cast<const msg::ImuState*>(biased.message.get());
  EXPECT_EQ(changed.angular_velocity_rad_s.y, 2.5);
  EXPECT_EQ(changed.angular_velocity_rad_s.x, 1);
  EXPECT_EQ(message->angular_velocity_rad_s.y, 2);
}

}  // namespace
}  // namespace constrictor
