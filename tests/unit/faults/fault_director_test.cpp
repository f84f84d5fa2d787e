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
