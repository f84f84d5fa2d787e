// Which process gets which signal when.
#include "cli/fault_director.hpp"

#include <gtest/gtest.h>

#include <csignal>

namespace constrictor::cli {
namespace {

using namespace std::chrono_literals;

TEST(FaultDirector, KillsOnceAndStopsForItsTimeOfWallClock) {
  FaultPlan plan;
  plan.processes = {{ProcessFault::Kind::kKill, "camera", 2'000'000'000, 0, 0, 0},
                    {ProcessFault::Kind::kStop, "control", 3'000'000'000, 0, 1.5, 0}};
  FaultDirector director(plan);
  const auto start = FaultDirector::Clock::now();
  EXPECT_TRUE(director.due(1.9, start).empty());
  auto signals = director.due(2.1, start);
  ASSERT_EQ(signals.size(), 1u);
  EXPECT_EQ(signals[0].component, "camera");
  EXPECT_EQ(signals[0].number, SIGKILL);
  signals = director.due(3.0, start + 1s);
  ASSERT_EQ(signals.size(), 1u);
  EXPECT_EQ(signals[0].number, SIGSTOP);
  EXPECT_TRUE(director.due(3.0, start + 2400ms).empty()) << "the stopped run does not go on; the wall clock does";
  signals = director.due(3.0, start + 2600ms);
  ASSERT_EQ(signals.size(), 1u);
  EXPECT_EQ(signals[0].number, SIGCONT);
  EXPECT_TRUE(director.due(9.0, start + 9s).empty());
}

TEST(FaultDirector, BreaksADeviceOnceAndMendsIt) {
  FaultPlan plan;
  const auto order = [](const std::string& line) {
    return std::get<DeviceOrder>(read_order("servo_emulator", line, [](std::string_view) { return std::size_t{23}; }));
  };
  plan.devices = {{order("stuck 7"), 2'000'000'000, 3'000'000'000}, {order("reboot 4"), 0, INT64_MAX}};
  FaultDirector director(plan);
  const auto lines = [&](double at_s) {
    std::vector<std::string> all;
    for (const auto& [device, line] : director.commands(at_s)) all.push_back(device + ": " + line);
    return all;
  };
  using Lines = std::vector<std::string>;
  EXPECT_EQ(lines(0.1), Lines{"servo_emulator: reboot 4"});
  EXPECT_EQ(lines(1.9), Lines{});
  EXPECT_EQ(lines(2.1), Lines{"servo_emulator: stuck 7"});
  EXPECT_EQ(lines(2.9), Lines{});
  EXPECT_EQ(lines(3.1), Lines{"servo_emulator: heal 7"});
  EXPECT_EQ(lines(9.0), Lines{});
  EXPECT_EQ(director.news(2.5).front(), "fault: stuck 7 of servo_emulator begins at 2.0 s");
}

TEST(FaultDirector, ARunThatIsContinuedDoesNotRepeatWhatHasHappened) {
  const auto order = [](const std::string& line) {
    return std::get<DeviceOrder>(read_order("servo_emulator", line, [](std::string_view) { return std::size_t{23}; }));
  };
  FaultPlan plan;
  plan.processes = {{ProcessFault::Kind::kKill, "camera", 2'000'000'000, 0, 0, 0},
                    {ProcessFault::Kind::kStop, "control", 3'000'000'000, 0, 1.5, 0},
                    {ProcessFault::Kind::kKill, "planner", 8'000'000'000, 0, 0, 0}};
  plan.devices = {{order("stuck 7"), 2'000'000'000, 3'000'000'000},
                  {order("stuck 8"), 2'000'000'000, 9'000'000'000},
                  {order("reboot 4"), 2'000'000'000, INT64_MAX}};
  FaultDirector director(plan);
  director.continue_at(5.0);
  const auto start = FaultDirector::Clock::now();
  EXPECT_TRUE(director.due(5.0, start).empty());
  EXPECT_TRUE(director.due(5.0, start + 9s).empty()) << "the stopped process has died with its launcher";
  const auto commands = director.commands(5.0);
  ASSERT_EQ(commands.size(), 1u) << "a new device is whole, so that the fault that lasts begins again";
  EXPECT_EQ(commands[0].line, "stuck 8");
  EXPECT_EQ(director.news(5.0), std::vector<std::string>{"fault: stuck 8 of servo_emulator begins at 2.0 s"});
  ASSERT_EQ(director.due(8.0, start).size(), 1u);
  EXPECT_EQ(director.commands(9.0).front().line, "heal 8");
}

TEST(FaultDirector, SaysWhenAFaultBeginsAndEnds) {
  FaultPlan plan;
  plan.topics.resize(1);
  plan.topics[0].topic = &topics::kInfos[topics::kImuState.id];
  plan.topics[0].from_ns = 1'000'000'000;
  plan.topics[0].until_ns = 2'000'000'000;
  FaultDirector director(plan);
  EXPECT_TRUE(director.news(0.5).empty());
  EXPECT_EQ(director.news(1.5), std::vector<std::string>{"fault: drop of imu_state begins at 1.0 s"});
  EXPECT_TRUE(director.news(1.6).empty());
  EXPECT_EQ(director.news(2.5), std::vector<std::string>{"fault: drop of imu_state ends at 2.0 s"});
}

}  // namespace
}  // namespace constrictor::cli
