// Goals: each is answered once, each accepted one ends once. A plant that stands still, with scripted commands.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <map>

#include "navigation/navigation.hpp"
#include "runtime/local_run.hpp"

namespace constrictor {
namespace {

class StillRobot : public Plant {
 public:
  explicit StillRobot(Wiring& wiring)
      : joints_(wiring.output(topics::kJointState)), contacts_(wiring.output(topics::kContactState)) {}
  void sample(const Tick&) override {
    msg::JointState joints{};
    joints.joint_count = 23;
    joints_.write(joints);
    contacts_.write(msg::ContactState{});
  }
  void step(const Tick&) override {}
  [[nodiscard]] std::int64_t period_ns() const override { return 20'000'000; }

 private:
  Output<msg::JointState> joints_;
  Output<msg::ContactState> contacts_;
};

class StillPose : public StatefulComponent<int> {
 public:
  explicit StillPose(Wiring& wiring) : out_(wiring.output(topics::kRobotPose)) {}
  void step(const Tick& tick) override {
    if (tick.index < 400) out_.write(msg::RobotPose{});
  }

 private:
  Output<msg::RobotPose> out_;
};

using Commands = std::map<std::int64_t, msg::TaskCommand>;

class ScriptedInput : public StatefulComponent<int> {
 public:
  ScriptedInput(Wiring& wiring, Commands commands)
      : out_(wiring.output(topics::kTaskCommand)), commands_(std::move(commands)) {}
  void step(const Tick& tick) override {
    const auto command = commands_.find(tick.index);
    if (command != commands_.end()) out_.write(command->second);
  }

 private:
  Output<msg::TaskCommand> out_;
  Commands commands_;
};

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
    setup.robot_file = SOURCE_DIR "/components/robot/mamba.yaml";
    run = std::make_unique<LocalRun>(
        std::vector<ComponentFactory>{
            {"physics", [](Wiring& w, const Setup&) { return std::make_unique<StillRobot>(w); }},
            make_navigation_factory(),
            {"guidance", [](Wiring& w, const Setup&) { return std::make_unique<StillPose>(w); }},
            {"input", [commands](Wiring& w, const Setup&) { return std::make_unique<ScriptedInput>(w, commands); }}},
        setup);
    run->subscribe<msg::TaskEvent>(topics::kTaskEvent, [this](const msg::TaskEvent& event) { events.push_back(event); });
  }
  /// How often a goal was said to be in this state.
  [[nodiscard]] int count(std::uint64_t goal_id, std::uint8_t state) const {
    int n = 0;
    for (const auto& e : events) n += e.goal_id == goal_id && e.event == msg::kEventNone && e.goal_state == state;
    return n;
  }
  [[nodiscard]] int ends(std::uint64_t goal_id) const {
    return count(goal_id, msg::kGoalSucceeded) + count(goal_id, msg::kGoalAborted) + count(goal_id, msg::kGoalPreempted) +
           count(goal_id, msg::kGoalCancelled);
  }
};

TEST(Goals, StandsStillWithoutAGoal) {
  GoalRun r({});
  r.run->advance(50);
  EXPECT_STREQ(r.run->latest(topics::kDesiredTrajectory)->method, "hold");
  EXPECT_EQ(r.run->latest(topics::kTaskStatus)->state, msg::kGoalIdle);
}

TEST(Goals, RotateEndsByItsTimeoutWithTheEvent) {
  msg::TaskCommand rotate = start(1, msg::kTaskRotate);
  rotate.parameters.timeout_s = 2.0;
  GoalRun r({{10, rotate}});
  r.run->advance(60);
  EXPECT_GT(r.run->latest(topics::kDesiredTrajectory)->curvature_1_m, 1.5);
  r.run->advance(100);
  EXPECT_EQ(r.count(1, msg::kGoalRunning), 1);
  EXPECT_EQ(r.count(1, msg::kGoalSucceeded), 1);
  EXPECT_EQ(std::count_if(r.events.begin(), r.events.end(), [](const auto& e) { return e.event == msg::kEventTimeout; }), 1);
  EXPECT_EQ(r.run->latest(topics::kTaskStatus)->progress, 1.0);
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
  EXPECT_STREQ(r.run->latest(topics::kDesiredTrajectory)->method, "hold");
}

TEST(Goals, RefusesWithAReasonAndLeavesTheRunningGoalAlone) {
  msg::TaskCommand bad = start(2, msg::kTaskFollowLine);
  bad.parameters.line_colour = msg::kColourUnknown;
  msg::TaskCommand unknown = start(7, msg::kTaskSearchObject);
  unknown.parameters.object_handle = 3;
  GoalRun r({{10, start(1, msg::kTaskRotate)}, {20, bad}, {30, start(3, msg::kTaskDrop)}, {40, start(4, msg::kTaskGrasp)},
         {50, start(5, msg::kTaskPregrasp)}, {60, start(6, msg::kTaskTrackObject)}, {70, unknown}});
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
  // No percept ever comes: nothing to follow, and nothing that says that it is lost either; it waits.
  GoalRun r({{10, start(1, msg::kTaskFollowLine)}});
  r.run->advance(60);
  EXPECT_EQ(r.run->latest(topics::kTaskStatus)->state, msg::kGoalRunning);
}

TEST(Goals, HoldsWhenThePoseIsStale) {
  GoalRun r({{10, start(1, msg::kTaskRotate)}});
  r.run->advance(400);
  EXPECT_STREQ(r.run->latest(topics::kDesiredTrajectory)->method, "undulation");
  r.run->advance(60);
  EXPECT_STREQ(r.run->latest(topics::kDesiredTrajectory)->method, "hold");
}

TEST(Goals, AreCancelledAlsoWhileThePoseIsStale) {
  msg::TaskCommand cancel{};
  cancel.command = msg::kCommandCancel;
  cancel.goal_id = 1;
  GoalRun r({{10, start(1, msg::kTaskRotate)}, {440, cancel}, {450, start(2, msg::kTaskRotate)}});
  r.run->advance(460);
  EXPECT_EQ(r.count(1, msg::kGoalCancelled), 1);
  EXPECT_EQ(r.ends(1), 1);
  EXPECT_EQ(r.count(2, msg::kGoalRefused), 1);
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
