// Goals: each is answered once, and each accepted goal ends once. The robot stands still; the commands are scripted.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <map>

#include "barrier/local_run.hpp"
#include "constrictor/constants.hpp"
#include "constrictor/text.hpp"
#include "navigation/navigation.hpp"
#include "support/project.hpp"
#include "support/scripted_members.hpp"

namespace constrictor {
namespace {

/// The robot stands at the map's origin; the pose is not written any more from tick 400 on.
ComponentFactory pose_until_tick_400() {
  return testing::scripted_writer<msg::RobotPose>("guidance", topics::kRobotPose,
                                                  [](const Tick& tick, const auto& out) {
                                                    if (tick.index < 400) out.write(msg::RobotPose{});
                                                  });
}

using Commands = std::map<std::int64_t, msg::TaskCommand>;

/// Stands for the component `input`: writes each command at its tick.
ComponentFactory scripted_input(const Commands& commands) {
  return testing::scripted_writer<msg::TaskCommand>(
      "input", topics::kTaskCommand, [commands](const Tick& tick, const auto& out) {
        if (const auto command = commands.find(tick.index); command != commands.end()) out.write(command->second);
      });
}

msg::TaskCommand start(std::uint64_t goal_id, std::uint8_t task) {
  msg::TaskCommand command{};
  command.goal_id = goal_id;
  command.task = task;
  command.parameters.timeout_s = std::numeric_limits<double>::quiet_NaN();
  command.parameters.line_colour = msg::kColourBlue;
  command.parameters.object_colour = msg::kColourGreen;
  command.parameters.drop_zone_colour = msg::kColourGreen;
  command.parameters.direction = msg::kDirectionLeft;
  return command;
}

struct GoalRun {
  std::vector<msg::TaskEvent> events;
  std::unique_ptr<LocalRun> run;
  explicit GoalRun(const Commands& commands) {
    Setup setup;
    setup.robot_file = testing::robot_path("mamba");
    run = std::make_unique<LocalRun>(std::vector<ComponentFactory>{testing::still_robot(), make_navigation_factory(),
                                                                   pose_until_tick_400(), scripted_input(commands)},
                                     setup);
    run->subscribe<msg::TaskEvent>(topics::kTaskEvent,
                                   [this](const msg::TaskEvent& event) { events.push_back(event); });
  }
  /// Number of events that report this state of a goal.
  [[nodiscard]] int count(std::uint64_t goal_id, std::uint8_t state) const {
    int n = 0;
    for (const auto& e : events) n += e.goal_id == goal_id && e.event == msg::kEventNone && e.goal_state == state;
    return n;
  }
  [[nodiscard]] int ends(std::uint64_t goal_id) const {
    return count(goal_id, msg::kGoalSucceeded) + count(goal_id, msg::kGoalAborted) +
           count(goal_id, msg::kGoalPreempted) + count(goal_id, msg::kGoalCancelled);
  }
};

TEST(TaskRegistry, HasEveryTaskOfTheIdlAndNoOther) {
  EXPECT_EQ(make_task(msg::kTaskNone), nullptr);
  for (std::uint8_t task = 1; task < msg::kTaskCount; ++task)
    EXPECT_NE(make_task(task), nullptr) << name_of(constants::kTask, task) << ": add a row to task_registry.cpp";
  EXPECT_EQ(make_task(msg::kTaskCount), nullptr);
}

TEST(Goals, StandsStillWithoutAGoal) {
  GoalRun r({});
  r.run->advance(50);
  EXPECT_STREQ(r.run->latest(topics::kDesiredTrajectory)->motion, "stand");
  EXPECT_EQ(r.run->latest(topics::kTaskStatus)->goal_state, msg::kGoalIdle);
}

TEST(Goals, RotateEndsByItsTimeoutWithTheEvent) {
  msg::TaskCommand rotate = start(1, msg::kTaskRotate);
  rotate.parameters.timeout_s = 2.0;
  GoalRun r({{10, rotate}});
  r.run->advance(60);
  EXPECT_GT(r.run->latest(topics::kDesiredTrajectory)->points[0].curvature_1_m, 1.5);
  r.run->advance(100);
  EXPECT_EQ(r.count(1, msg::kGoalRunning), 1);
  EXPECT_EQ(r.count(1, msg::kGoalSucceeded), 1);
  EXPECT_EQ(
      std::count_if(r.events.begin(), r.events.end(), [](const auto& e) { return e.event == msg::kEventTimeout; }), 1);
  EXPECT_EQ(r.run->latest(topics::kTaskStatus)->progress, 1.0);
}

TEST(Goals, EveryOtherTaskIsAbortedWhenItsTimeLimitPasses) {
  msg::TaskCommand explore = start(1, msg::kTaskExplore);
  explore.parameters.timeout_s = 2.0;
  msg::TaskCommand unlimited = start(2, msg::kTaskExplore);
  unlimited.parameters.timeout_s = 0.0;  // of a writer that sets what it does not use to 0
  GoalRun r({{10, explore}, {150, unlimited}});
  r.run->advance(105);
  EXPECT_EQ(r.ends(1), 0);
  r.run->advance(40);
  EXPECT_EQ(r.count(1, msg::kGoalAborted), 1);
  EXPECT_STREQ(r.run->latest(topics::kTaskStatus)->reason, "the time limit of 2 s passed");
  r.run->advance(300);
  EXPECT_EQ(r.ends(2), 0);
}

TEST(Goals, ANewGoalPreemptsAndACancelCancels) {
  msg::TaskCommand cancel{};
  cancel.goal_id = 2;
  cancel.command = msg::kCommandCancel;
  GoalRun r({{10, start(1, msg::kTaskExplore)}, {50, start(2, msg::kTaskRotate)}, {90, cancel}, {95, cancel}});
  r.run->advance(120);
  EXPECT_EQ(r.count(1, msg::kGoalPreempted), 1);
  EXPECT_EQ(r.count(2, msg::kGoalCancelled), 1);
  EXPECT_EQ(r.ends(1), 1);
  EXPECT_EQ(r.ends(2), 1);
  EXPECT_STREQ(r.run->latest(topics::kDesiredTrajectory)->motion, "stand");
}

TEST(Goals, RefusesWithAReasonAndLeavesTheRunningGoalAlone) {
  msg::TaskCommand bad = start(2, msg::kTaskFollowLine);
  bad.parameters.line_colour = msg::kColourUnknown;
  msg::TaskCommand unknown = start(7, msg::kTaskSearchObject);
  unknown.parameters.object_handle = 3;
  GoalRun r({{10, start(1, msg::kTaskRotate)},
             {20, bad},
             {30, start(3, msg::kTaskDrop)},
             {40, start(4, msg::kTaskGrasp)},
             {50, start(5, msg::kTaskPregrasp)},
             {60, start(6, msg::kTaskTrackObject)},
             {70, unknown}});
  r.run->advance(100);
  for (std::uint64_t goal = 2; goal <= 7; ++goal) {
    EXPECT_EQ(r.count(goal, msg::kGoalRefused), 1) << goal;
    EXPECT_EQ(r.ends(goal), 0) << goal;
  }
  for (const auto& e : r.events) {
    if (e.goal_state != msg::kGoalRefused) continue;
    EXPECT_STRNE(e.detail, "");
  }
  EXPECT_EQ(r.run->latest(topics::kTaskStatus)->goal_id, 1U);
  EXPECT_EQ(r.ends(1), 0);
}

TEST(Goals, FollowLineWaitsForTheFirstPercept) {
  // Without a percept the line is neither found nor lost, so the task waits.
  GoalRun r({{10, start(1, msg::kTaskFollowLine)}});
  r.run->advance(60);
  EXPECT_EQ(r.run->latest(topics::kTaskStatus)->goal_state, msg::kGoalRunning);
}

TEST(Goals, HoldsWhenThePoseIsStale) {
  GoalRun r({{10, start(1, msg::kTaskRotate)}});
  r.run->advance(400);
  EXPECT_STREQ(r.run->latest(topics::kDesiredTrajectory)->motion, "travel");
  r.run->advance(60);
  EXPECT_STREQ(r.run->latest(topics::kDesiredTrajectory)->motion, "stand");
}

TEST(Goals, AreCancelledWhileThePoseIsStale) {
  msg::TaskCommand cancel{};
  cancel.command = msg::kCommandCancel;
  cancel.goal_id = 1;
  GoalRun r({{10, start(1, msg::kTaskRotate)}, {440, cancel}, {450, start(2, msg::kTaskRotate)}});
  r.run->advance(460);
  EXPECT_EQ(r.count(1, msg::kGoalCancelled), 1);
  EXPECT_EQ(r.ends(1), 1);
  EXPECT_EQ(r.count(2, msg::kGoalRefused), 1);
  EXPECT_TRUE(text_of(r.events.back().detail).starts_with("not ready: ")) << "the same goal is accepted later";
}

TEST(Goals, ContinuesIdenticallyAfterARestart) {
  const Commands commands{{10, start(1, msg::kTaskExplore)}, {150, start(2, msg::kTaskSearchObject)}};
  GoalRun whole(commands);
  GoalRun broken(commands);
  whole.run->advance(300);
  broken.run->advance(77);
  broken.run->restart("navigation");
  broken.run->advance(123);
  broken.run->restart("navigation");
  broken.run->advance(100);
  EXPECT_EQ(whole.run->output_hashes().at("navigation"), broken.run->output_hashes().at("navigation"));
}

}  // namespace
}  // namespace constrictor
