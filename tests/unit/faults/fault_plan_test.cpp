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
    return load_fault_plan(file, {"physics", "camera", "control"});
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

TEST_F(FaultFile, NoFileIsAPlanWithoutFaults) {
  const FaultPlan plan = load_fault_plan({}, {});
  EXPECT_TRUE(plan.topics.empty());
  EXPECT_TRUE(plan.processes.empty());
}

TEST_F(FaultFile, RefusesWhatCannotBe) {
  const std::pair<const char*, const char*> cases[] = {
      {"kind: drop", "faults[0].topic: found neither or both of topic and process"},
      {"kind: drop, topic: imu_state, process: camera", "faults[0].topic: found neither or both of topic and process"},
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
      {"process: cammera, kind: kill, at_s: 1", "did you mean 'camera'?"},
      {"process: camera, kind: kill", "faults[0].at_s"},
      {"process: camera, kind: stop, at_s: 1", "faults[0].for_s"},
      {"process: camera, kind: drop, at_s: 1", "faults[0].kind: found drop, accepted one of kill"}};
  for (const auto& [fault, message] : cases)
    EXPECT_NE(error(fault).find(message), std::string::npos) << fault << ": " << error(fault);
  EXPECT_EQ(error("topic: joint_state, kind: bias, field: 'position_rad[63]', amount: 1"), "accepted");
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
