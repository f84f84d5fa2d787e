// RunView collects the state of a run from its messages. After a reset, messages of the epoch before may still arrive.
#include <gtest/gtest.h>

#include <cstdio>

#include "cli/run_observer.hpp"

namespace constrictor::cli {
namespace {

constexpr std::uint64_t kRun = 5;

msg::RunState state(std::uint32_t epoch, std::int64_t next_tick, std::uint64_t seed, std::uint64_t run_id = kRun) {
  msg::RunState s{};
  s.run_id = run_id;
  s.epoch = epoch;
  s.tick = next_tick;
  s.seed = seed;
  return s;
}

msg::ComponentStatus status(const char* component, std::uint32_t epoch, std::int64_t tick,
                            std::uint32_t incarnation = 1, std::uint64_t overruns = 0) {
  msg::ComponentStatus s{};
  std::snprintf(s.component, sizeof s.component, "%s", component);
  s.run_id = kRun;
  s.epoch = epoch;
  s.tick = tick;
  s.incarnation = incarnation;
  s.overruns = overruns;
  return s;
}

msg::MissionStatus mission(std::uint32_t epoch, std::int64_t tick) {
  msg::MissionStatus m{};
  m.header.run_id = kRun;
  m.header.epoch = epoch;
  m.header.tick = tick;
  return m;
}

TEST(RunView, TheTickIsTheNewestInAnyMessage) {
  RunView view;
  EXPECT_EQ(view.tick, -1);
  EXPECT_EQ(view.seed(3), 3u) << "before the first RunState, the seed is the one given to the launcher";
  view.take(status("control", 1, 50));
  view.take(mission(1, 60));
  view.take(state(1, 58, 1));
  EXPECT_EQ(view.tick, 60);
  view.take(state(1, 71, 1));
  EXPECT_EQ(view.tick, 70) << "RunState contains the next tick, which is not done yet";
}

TEST(RunView, AfterAResetTickAndSeedAreTheNewOnes) {
  RunView view;
  view.take(state(1, 500, 1));
  view.take(status("control", 1, 490));
  view.take(mission(1, 499));
  view.take(state(2, 0, 7));
  EXPECT_EQ(view.seed(1), 7u);
  EXPECT_EQ(view.tick, -1);
  EXPECT_FALSE(view.mission) << "the mission of the epoch before is over";
  view.take(mission(1, 501));  // late messages of the epoch before
  view.take(status("control", 1, 500));
  view.take(state(1, 501, 1));
  EXPECT_EQ(view.tick, -1);
  EXPECT_EQ(view.seed(1), 7u);
  EXPECT_FALSE(view.mission);
  view.take(status("control", 2, 10));
  EXPECT_EQ(view.tick, 10);
}

// A late observer receives the messages that DDS writers have kept. Their order across topics is not defined.
TEST(RunView, IgnoresKeptMessagesOfTheEpochBeforeInAnyOrder) {
  for (const bool state_first : {true, false}) {
    RunView view;
    if (state_first) view.take(state(2, 21, 7));
    view.take(mission(1, 499));
    view.take(status("planner", 1, 480));
    view.take(status("control", 2, 15));
    if (!state_first) view.take(state(2, 21, 7));
    EXPECT_EQ(view.tick, 20);
    EXPECT_FALSE(view.mission);
    EXPECT_EQ(view.components.size(), 2u) << "the status of a component counts in any epoch";
  }
}

// If the component `report` runs in the plant's process, it draws its figure before the plant's status is published.
TEST(RunView, TheRunIsOverOnceAnyMemberHasEndedInThePresentEpoch) {
  RunView view;
  EXPECT_FALSE(view.run_is_over());
  msg::ComponentStatus ended = status("camera", 1, 200);
  ended.state = msg::kComponentEnded;
  view.take(status("physics", 1, 200));
  EXPECT_FALSE(view.run_is_over());
  view.take(ended);
  EXPECT_TRUE(view.run_is_over());
  view.take(state(2, 0, 7));
  EXPECT_FALSE(view.run_is_over()) << "that was the epoch before";
}

TEST(RunView, IgnoresAnotherRunInTheSameDomain) {
  RunView view;
  view.take(state(1, 100, 1));
  view.take(state(3, 900, 9, kRun + 1));
  EXPECT_EQ(view.tick, 99);
  EXPECT_EQ(view.seed(0), 1u);
}

TEST(RunView, AWaitIsOverOnceItsTickIsDone) {
  msg::Waiting waiting{};
  std::snprintf(waiting.component, sizeof waiting.component, "control");
  waiting.run_id = kRun;
  waiting.tick = 100;
  RunView view;
  EXPECT_FALSE(view.over(waiting)) << "no message shows that the tick is done";
  view.take(status("control", 1, 50));
  view.take(state(1, 101, 1));
  EXPECT_FALSE(view.over(waiting)) << "only other members may have done the tick";
  view.take(status("control", 1, 100));
  EXPECT_TRUE(view.over(waiting));
  RunView later;
  later.take(state(1, 5000, 1));
  EXPECT_TRUE(later.over(waiting)) << "without its status the tick of the run decides: no member can be so far behind";
  waiting.run_id = kRun + 1;
  EXPECT_TRUE(view.over(waiting));
}

// A member that waits for the run to begin knows no run id. Its wait ends with its first status that has a run id.
TEST(RunView, AWaitForTheRunToBeginIsOverOnceTheMemberHasJoined) {
  msg::Waiting waiting{};
  std::snprintf(waiting.component, sizeof waiting.component, "control");
  RunView view;
  EXPECT_FALSE(view.over(waiting));
  msg::ComponentStatus outside = status("control", 0, -1);
  outside.run_id = 0;
  view.take(outside);
  view.take(status("physics", 1, 40));
  EXPECT_FALSE(view.over(waiting)) << "another member has joined, not this one";
  view.take(status("control", 1, 50));
  EXPECT_TRUE(view.over(waiting));
  outside.incarnation = 2;
  view.take(outside);
  EXPECT_FALSE(view.over(waiting)) << "the member was restarted and has not been resumed";
  EXPECT_EQ(view.components["control"].incarnation, 2u);
  view.take(status("control", 1, 60, 2));
  EXPECT_TRUE(view.over(waiting));
}

TEST(RunView, CountsOverrunsOfAllIncarnations) {
  RunView view;
  view.take(status("control", 1, 10, 1, 4));
  view.take(status("control", 1, 20, 2, 3));
  view.take(status("control", 1, 15, 1, 5));  // a late status of the first incarnation
  EXPECT_EQ(view.overruns["control"], 7u);
}

TEST(RunView, TheMissionIsDoneWhenItHasItsOutcome) {
  RunView view;
  EXPECT_FALSE(view.mission_done());
  view.take(state(1, 100, 1));
  msg::MissionStatus mission{};
  mission.header.run_id = kRun;
  mission.header.epoch = 1;
  view.take(mission);
  EXPECT_FALSE(view.mission_done());
  mission.object_count = 2;
  mission.object_index = 2;
  view.take(mission);
  EXPECT_FALSE(view.mission_done()) << "the robot still looks at the last object";
  for (const std::uint8_t outcome : {msg::kMissionSucceeded, msg::kMissionFailed}) {
    mission.outcome = outcome;
    view.take(mission);
    EXPECT_TRUE(view.mission_done());
  }
}

TEST(RunView, TheProgressCountsWhatIsDeliveredAndNotThePlaceInTheSequence) {
  RunView view;
  view.take(state(1, 101, 1));
  msg::MissionStatus status = mission(1, 100);
  std::snprintf(status.state, sizeof status.state, "search object");
  status.object_count = 3;
  status.object_index = 2;  // the first object was put aside, the second one was delivered
  status.delivered_count = 1;
  status.colour = msg::kColourRed;
  view.take(status);
  EXPECT_EQ(progress_line(view, 0.0), "search object | 1 of 3 objects delivered, red next | 2.0 s simulated");
}

TEST(RunView, ARunThatStandsStillShowsNoSpeed) {
  RunView view;
  view.take(state(1, 101, 1));
  EXPECT_EQ(progress_line(view, 3.0), "2.0 s simulated, 3.0x real time");
  EXPECT_EQ(progress_line(view, 0.0), "2.0 s simulated");
}

}  // namespace
}  // namespace constrictor::cli
