#include <gtest/gtest.h>

#include <cereal/archives/portable_binary.hpp>
#include <cmath>
#include <random>
#include <set>
#include <sstream>

#include "configuration/configuration.hpp"
#include "planner/mission_planner.hpp"

namespace constrictor {
namespace {

using enum MissionState;

/// A world of scripted percepts and events around a planner.
class PlannerTest : public ::testing::Test {
 protected:
  PlannerTest() {
    config_.sequence = {msg::kColourGreen, msg::kColourRed};
    config_.line_colour = msg::kColourBlue;
  }

  std::optional<WantedTask> step(std::vector<msg::TaskEvent> events = {}) {
    PlannerInputs inputs;
    inputs.time_s = time_s_ += 0.02;
    inputs.line = &line_;
    inputs.objects = &objects_;
    inputs.fresh_percepts = true;
    inputs.pose = &pose_;
    for (const auto& event : events) inputs.events.push_back(&event);
    const auto wanted = MissionPlanner(config_, memory_).step(inputs);
    if (wanted) last_ = *wanted;
    return wanted;
  }
  void steps(int count) {
    for (int i = 0; i < count; ++i) step();
  }
  msg::TaskEvent event(std::uint8_t what) const {
    msg::TaskEvent e{};
    e.goal_id = (static_cast<std::uint64_t>(msg::kAuthorityPlanner) << 48) + memory_.goals;
    e.task = last_.task;
    e.event = what;
    e.goal_state = msg::kGoalRunning;
    return e;
  }
  msg::TaskEvent ended(std::uint8_t goal_state) const {
    msg::TaskEvent e = event(msg::kEventNone);
    e.goal_state = goal_state;
    return e;
  }
  void see_line(bool visible) {
    line_.visible = visible;
    line_.colour = msg::kColourBlue;
  }
  void see(std::uint8_t colour, std::uint8_t kind, double range_m) {
    objects_.blob_count = 1;
    objects_.blobs[0].colour = colour;
    objects_.blobs[0].kind = kind;
    objects_.blobs[0].range_m = range_m;
  }
  void see_nothing() {
    objects_ = {};
    see_line(false);
  }
  /// From the start to the state in which `colour` is carried along the line.
  void carry(std::uint8_t colour) {
    see_line(true);
    steps(4);
    EXPECT_EQ(memory_.state, kFollowLine);
    see(colour, msg::kBlobObject, 1.2);
    steps(4);
    EXPECT_EQ(memory_.state, kTrackObject);
    step({event(msg::kEventObjectReached)});
    EXPECT_EQ(memory_.state, kPregrasp);
    step({event(msg::kEventObjectPregrasped)});
    EXPECT_EQ(memory_.state, kGrasp);
    see_nothing();
    step({event(msg::kEventObjectGrasped)});
    EXPECT_EQ(memory_.state, kSearchLine);
    see_line(true);
    steps(4);
    EXPECT_EQ(memory_.state, kTransport);
  }
  void drop(std::uint8_t colour) {
    see(colour, msg::kBlobZone, 0.8);
    steps(4);
    EXPECT_EQ(memory_.state, kDrop);
    EXPECT_EQ(last_.task, msg::kTaskDrop);
    EXPECT_EQ(last_.parameters.drop_zone_colour, colour);
    see_nothing();
    step({event(msg::kEventDroppingDone)});
  }

  PlannerConfig config_;
  MissionMemory memory_;
  msg::LinePercept line_{};
  msg::ObjectPercepts objects_{};
  msg::RobotPose pose_{};
  WantedTask last_;
  double time_s_ = 0.0;
};

TEST_F(PlannerTest, RetrievesGreenThenRedAsInFigure3) {
  ASSERT_TRUE(step());
  EXPECT_EQ(memory_.state, kSearchLineOrObject);
  EXPECT_EQ(last_.task, msg::kTaskExplore);
  carry(msg::kColourGreen);
  drop(msg::kColourGreen);
  EXPECT_EQ(memory_.state, kTurnRound);
  step();
  EXPECT_EQ(last_.task, msg::kTaskRotate);
  EXPECT_FALSE(std::isnan(last_.parameters.timeout_s));
  carry(msg::kColourRed);
  drop(msg::kColourRed);
  EXPECT_EQ(memory_.state, kDone);
  EXPECT_EQ(memory_.recoveries, 0);
}

TEST_F(PlannerTest, IgnoresAnObjectOfAnotherColourAndAZoneOfItsOwn) {
  see_line(true);
  steps(5);
  see(msg::kColourRed, msg::kBlobObject, 0.6);
  steps(10);
  EXPECT_EQ(memory_.state, kFollowLine);
  see(msg::kColourGreen, msg::kBlobZone, 0.6);
  steps(10);
  EXPECT_EQ(memory_.state, kFollowLine);
}

TEST_F(PlannerTest, ASingleImageDoesNotConvince) {
  see_line(true);
  steps(5);
  for (int i = 0; i < 10; ++i) {
    see(msg::kColourGreen, msg::kBlobObject, 1.0);
    step();
    objects_ = {};
    step();
  }
  EXPECT_EQ(memory_.state, kFollowLine);
}

TEST_F(PlannerTest, RecoversALostLineByExploringAndTurning) {
  see_line(true);
  steps(5);
  see_line(false);
  step({event(msg::kEventLineLost)});
  EXPECT_EQ(memory_.state, kSearchLineOrObject);
  EXPECT_EQ(memory_.recoveries, 1);
  std::set<std::uint8_t> tried;
  for (int i = 0; i < 3000; ++i) {
    if (const auto wanted = step()) tried.insert(wanted->task);
  }
  EXPECT_TRUE(tried.contains(msg::kTaskExplore));
  EXPECT_TRUE(tried.contains(msg::kTaskRotate));
  see_line(true);
  steps(4);
  EXPECT_EQ(memory_.state, kFollowLine);
}

TEST_F(PlannerTest, SearchesAtTheEndOfTheLine) {
  see_line(true);
  steps(5);
  step({event(msg::kEventEndOfLine)});
  EXPECT_EQ(last_.task, msg::kTaskSearchObject);
  step({event(msg::kEventObjectFound)});
  EXPECT_EQ(last_.task, msg::kTaskTrackObject);
}

TEST_F(PlannerTest, RecoversALostObjectPregraspAndGrasp) {
  carry(msg::kColourGreen);
  step({event(msg::kEventObjectGraspLost)});
  EXPECT_EQ(memory_.state, kSearchObject);
  step({event(msg::kEventObjectFound)});
  step({event(msg::kEventObjectLost)});
  EXPECT_EQ(memory_.state, kSearchObject);
  step({event(msg::kEventObjectFound)});
  step({event(msg::kEventObjectReached)});
  step({event(msg::kEventObjectPregraspLost)});
  EXPECT_EQ(memory_.state, kSearchObject);
  EXPECT_EQ(memory_.recoveries, 3);
}

TEST_F(PlannerTest, EventsOfAnotherGoalMeanNothing) {
  see_line(true);
  steps(5);
  msg::TaskEvent stale = event(msg::kEventLineLost);
  --stale.goal_id;
  step({stale});
  EXPECT_EQ(memory_.state, kFollowLine);
}

TEST_F(PlannerTest, AfterADropTheLineIsTakenOnlyTowardsTheObjects) {
  carry(msg::kColourGreen);
  drop(msg::kColourGreen);
  pose_.yaw_rad = M_PI;  // it faces away from where it once found the objects
  see_line(true);
  steps(20);
  EXPECT_EQ(memory_.state, kTurnRound);
  pose_.yaw_rad = 0.3;
  steps(4);
  EXPECT_EQ(memory_.state, kFollowLine);
}

TEST_F(PlannerTest, GivesUpWithAReasonWhenNothingHelps) {
  config_.max_recoveries = 3;
  see_line(true);
  for (int i = 0; i < 50 && memory_.state != kFailed; ++i) {
    steps(5);
    step({event(msg::kEventLineLost)});
  }
  EXPECT_EQ(memory_.state, kFailed);
  EXPECT_FALSE(memory_.reason.empty());
  EXPECT_FALSE(step());
}

TEST_F(PlannerTest, AnyLengthOfSequenceIsRetrieved) {
  config_.sequence = {msg::kColourRed, msg::kColourYellow, msg::kColourGreen, msg::kColourRed};
  for (const auto colour : config_.sequence) {
    carry(colour);
    drop(colour);
  }
  EXPECT_EQ(memory_.state, kDone);
}

// A copy made through serialisation at every step stays equal under random events; and nothing ever gets stuck for good: within
// the longest timeout a task is wanted again, or the mission has ended.
TEST_F(PlannerTest, RandomEventsNeverStrandItAndStateSurvivesSerialisation) {
  std::mt19937 random(11);
  for (int run = 0; run < 20; ++run) {
    memory_ = {};
    time_s_ = 0.0;
    double last_wanted_s = 0.0;
    for (int i = 0; i < 30000; ++i) {
      std::stringstream stream;
      {
        cereal::PortableBinaryOutputArchive out(stream);
        out(memory_);
      }
      const MissionMemory before = memory_;
      memory_ = {};
      {
        cereal::PortableBinaryInputArchive in(stream);
        in(memory_);
      }
      ASSERT_EQ(memory_.goals, before.goals);
      ASSERT_EQ(memory_.state, before.state);
      if (random() % 50 == 0) see_line(random() % 2);
      if (random() % 50 == 0) see(static_cast<std::uint8_t>(random() % 4), static_cast<std::uint8_t>(random() % 3), 0.1 * static_cast<double>(random() % 30));
      std::vector<msg::TaskEvent> events;
      if (random() % 200 == 0) events.push_back(event(static_cast<std::uint8_t>(random() % msg::kEventCount)));
      if (random() % 500 == 0) events.push_back(ended(static_cast<std::uint8_t>(random() % 7)));
      if (step(std::move(events))) last_wanted_s = time_s_;
      if (memory_.state == kDone || memory_.state == kFailed) break;
      ASSERT_LT(time_s_ - last_wanted_s, config_.follow_timeout_s + 1.0);
    }
  }
}

TEST(PlannerConfig, DefaultFileIsAccepted) {
  const auto config = load_planner_config(std::string(CONSTRICTOR_SOURCE_DIR) + "/components/planner/planner.yaml");
  EXPECT_EQ(config.sequence, (std::vector<std::uint8_t>{msg::kColourGreen, msg::kColourRed}));
}

}  // namespace
}  // namespace constrictor
