// Operators and scripts command a running robot that consists of the real components. The tests check which source has
// authority, and what the joints do when the process of an operator dies.
#include <algorithm>
#include <cmath>
#include <csignal>
#include <set>

#include "integration/commanded_run.hpp"
#include "runtime/wire.hpp"

namespace constrictor::testing {
namespace {

using namespace std::chrono_literals;

class Teleoperation : public CommandedRun {};

// The liveliness lease of `teleop` is 0.5 s of wall time. When it ends, `input` latches the loss of the operator at a
// tick boundary. In lock-step, control reads the new authority in the next tick, so the setpoints of tick latched + 1
// are held. At real-time pace the conductor does not wait for late members, so the hold begins later by as many ticks
// as `input` is late.
TEST_F(Teleoperation, JointsHoldWithinALeaseAndATickAfterTeleopIsKilled) {
  constexpr double kLease_s = 0.5;
  constexpr std::int64_t kSettle_ticks = 25;
  constexpr double kBusy_s = 0.25;  // allowance for a busy machine
  for (const std::string pace : {"2x", "realtime"}) {
    SCOPED_TRACE(pace);
    Process launcher = run(pace);
    Watcher watcher(domain());
    Process teleop = start({"teleop", "--drive", "0.5,0.2"});
    ASSERT_TRUE(teleop.wait_for("driving", 20s)) << teleop.errors();
    ASSERT_TRUE(watcher.wait_for_level(msg::kAuthorityOperator));
    ASSERT_TRUE(watcher.moves());
    const auto killed = Clock::now();
    teleop.signal(SIGKILL);
    ASSERT_TRUE(watcher.wait_for_level(msg::kAuthorityNone));
    const std::int64_t latched = watcher.authorities.back().first.header.tick;
    ASSERT_TRUE(eventually([&] {
      watcher.poll();
      return watcher.joints.back().header.tick > latched + 1 + kSettle_ticks + 55;
    }));
    ASSERT_EQ(watcher.authorities.back().first.level, msg::kAuthorityNone);
    const double wall_s = std::chrono::duration<double>(watcher.changed - killed).count();
    const std::int64_t held = watcher.changed_tick;
    const std::int64_t rest = held + kSettle_ticks;
    const double resting_rad = widest_range(watcher, rest, rest + 50);
    std::printf(
        "pace %s: the last setpoint changed %.3f s of wall time after the kill, %+ld ticks after the latch; the "
        "fastest joint moved at %.2f rad/s; in the second that begins 0.5 s after the hold, the joint that moved most "
        "moved by %.4f rad (in the second before the latch: %.2f rad), and the fastest joint had %.2f rad/s\n",
        pace.c_str(), wall_s, static_cast<long>(held - latched), fastest_joint(watcher, latched), resting_rad,
        widest_range(watcher, latched - 50, latched), fastest_joint(watcher, rest));
    EXPECT_LE(wall_s, kLease_s + kTick_s + kBusy_s);
    EXPECT_GT(wall_s, 0.0) << "the setpoints no longer changed when teleop was killed";
    EXPECT_LE(held, latched + 1 + (pace == "realtime" ? std::lround(kBusy_s / kTick_s) : 0));
    if (pace != "realtime") expect_hold_begins_after(watcher, latched);
    EXPECT_LE(fastest_setpoint(watcher, {held}), kMaxSpeed_rad_s * 1.001);
    EXPECT_LE(fastest_joint(watcher, latched), kMaxSpeed_rad_s);
    // Rest is judged by the angles, which have a noise of 0.001 rad. Velocities are not measure: contact forces make
    // held joints tremble with up to 0.4 rad/s within a step, although they move by less than the noise.
    EXPECT_LT(resting_rad, 0.02) << "a joint has not come to rest";
    end(launcher);
  }
}

TEST_F(Teleoperation, LockStepIsLimitedToRealTimeWhileAnOperatorHasAuthority) {
  Process launcher = run("lockstep");
  Watcher watcher(domain());
  Process teleop = start({"teleop", "--drive", "0.3,0"});
  ASSERT_TRUE(watcher.wait_for_level(msg::kAuthorityOperator));
  watcher.poll();
  const std::int64_t from = watcher.joints.back().header.tick;
  const auto begin = Clock::now();
  ASSERT_TRUE(eventually([&] {
    watcher.poll();
    return watcher.joints.back().header.tick > from + 62;
  }));
  EXPECT_GT(Clock::now() - begin, 1s) << "50 ticks are 1 s at real-time speed";
  EXPECT_EQ(command({"resume"}), exit_status::kOk) << output_;
  EXPECT_NE(output_.find("at most 1x real time while an operator has authority"), std::string::npos) << output_;
  EXPECT_EQ(command({"pace", "lockstep"}), exit_status::kOk) << output_;
  EXPECT_NE(output_.find("lock-step, as fast as possible"), std::string::npos)
      << output_;  // the speed is not checked: it depends on the machine
  teleop.signal(SIGINT);
  EXPECT_EQ(teleop.wait(10s), 128 + SIGINT);
  EXPECT_TRUE(watcher.wait_for_level(msg::kAuthorityNone)) << "teleop must release authority when it ends";
  end(launcher);
}

TEST_F(Teleoperation, ClearingAnEmergencyStopStartsNoMotion) {
  Process launcher = run("4x");
  Watcher watcher(domain());
  ASSERT_EQ(command({"task", "start", "rotate", "--direction", "left"}), exit_status::kOk) << output_;
  ASSERT_TRUE(watcher.moves());
  ASSERT_EQ(command({"stop"}), exit_status::kOk) << output_;
  ASSERT_TRUE(watcher.wait_for_level(msg::kAuthorityEmergencyStop));
  const std::int64_t stopped = watcher.authorities.back().first.header.tick;
  EXPECT_EQ(command({"task", "start", "rotate", "--direction", "left"}), exit_status::kFailed);
  EXPECT_NE(output_.find("emergency stop"), std::string::npos) << output_;
  EXPECT_EQ(command({"teleop", "--drive", "0.3,0", "--for", "1s"}), exit_status::kFailed);
  ASSERT_EQ(command({"clear-stop"}), exit_status::kOk) << output_;
  ASSERT_TRUE(watcher.wait_for_level(msg::kAuthorityNone));
  const std::int64_t cleared = watcher.authorities.back().first.header.tick;
  ASSERT_TRUE(eventually([&] {
    watcher.poll();
    return watcher.commands.back().header.tick > cleared + 100;
  }));
  const auto at_stop = std::find_if(watcher.commands.begin(), watcher.commands.end(),
                                    [&](const auto& c) { return c.header.tick == stopped + 1; });
  ASSERT_NE(at_stop, watcher.commands.end());
  for (auto c = at_stop; c != watcher.commands.end(); ++c) {
    for (int j = 0; j < c->joint_count; ++j)
      ASSERT_EQ(c->position_rad[j], at_stop->position_rad[j]) << "tick " << c->header.tick;
  }
  ASSERT_EQ(command({"task", "start", "rotate", "--direction", "left", "--timeout-s", "2"}), exit_status::kOk)
      << output_;
  EXPECT_EQ(command({"task", "wait", "--event", "timeout", "--timeout", "30s"}), exit_status::kOk) << output_;
  EXPECT_EQ(command({"task", "wait", "--end", "--timeout", "30s"}), exit_status::kOk) << output_;
  EXPECT_EQ(command({"task", "wait", "--event", "line lost", "--timeout", "20s"}), exit_status::kFailed)
      << "the goal ended without this event";
  end(launcher);
}

TEST_F(Teleoperation, AScriptStartsATaskAndWaitsForEventsOfItsGoal) {
  EXPECT_EQ(command({"task", "start", "drop", "--drop-zone-colour", "pink"}), exit_status::kUsage)
      << "a wrong value is reported before a missing run";
  Process launcher = run("4x");
  ASSERT_EQ(command({"task", "start", "rotate", "--direction", "left"}), exit_status::kOk) << output_;
  const auto at = output_.find("goal ");
  ASSERT_NE(at, std::string::npos) << output_;
  const std::string first = std::to_string(std::stoull(output_.substr(at + 5)));
  ASSERT_EQ(command({"task", "start", "rotate", "--direction", "left", "--timeout-s", "2"}), exit_status::kOk)
      << output_;
  EXPECT_EQ(command({"task", "wait", "--end"}), exit_status::kOk)
      << "the wait must end with the new goal, not with the first: " << output_;
  EXPECT_EQ(command({"task", "wait", "--end", "--goal", first}), exit_status::kFailed);
  EXPECT_NE(output_.find("preempted"), std::string::npos) << output_;
  EXPECT_EQ(command({"task", "wait", "--event", "timeout", "--goal", "any", "--timeout", "500ms"}),
            exit_status::kWaitedTooLong)
      << "the event came before the wait: " << output_;

  EXPECT_LE(first.size(), 3u) << "the number of a goal must be short enough to type: " << first;
  EXPECT_EQ(command({"task", "start", "explore"}), exit_status::kUsage);
  EXPECT_NE(output_.find("explore needs a direction"), std::string::npos) << output_;
  EXPECT_EQ(command({"task", "start", "drop", "--drop-zone-colour", "green"}), exit_status::kFailed);
  EXPECT_NE(output_.find("the robot carries no object"), std::string::npos) << output_;
  EXPECT_EQ(command({"task", "wait", "--end"}), exit_status::kFailed);
  EXPECT_NE(output_.find("refused: drop cannot run"), std::string::npos) << output_;
  EXPECT_EQ(command({"task", "start", "follow_path"}), exit_status::kUsage);
  EXPECT_NE(output_.find("--path"), std::string::npos) << output_;
  EXPECT_EQ(command({"task", "start", "follow_path", "--path", "50,0", "51,0"}), exit_status::kFailed);
  EXPECT_NE(output_.find("too far"), std::string::npos) << output_;
  ASSERT_EQ(command({"topic", "echo", "guidance/pose", "--count", "1", "--json"}), exit_status::kOk) << output_;
  const auto pose = nlohmann::json::parse(output_);  // the robot has turned and moved
  const auto point = [&](double ahead_m) {
    return std::to_string(pose["x_m"].get<double>() + ahead_m) + "," + std::to_string(pose["y_m"].get<double>());
  };
  ASSERT_EQ(command({"task", "start", "follow_path", "--path", point(0.0), point(30.0)}), exit_status::kOk) << output_;
  EXPECT_EQ(command({"task", "cancel"}), exit_status::kOk);
  EXPECT_NE(output_.find("constrictor release"), std::string::npos) << output_;
  EXPECT_EQ(command({"task", "wait", "--end"}), exit_status::kFailed);
  EXPECT_NE(output_.find("preempted"), std::string::npos) << output_;
  end(launcher);
}

TEST_F(Teleoperation, CtrlCLeavesADefinedAuthorityAndPrintsIt) {
  Process launcher = run("1x");
  Watcher watcher(domain());
  // Interrupted, `teleop --drive` stops the robot and releases authority.
  Process teleop = start({"teleop", "--drive", "0.3,0"});
  ASSERT_TRUE(teleop.wait_for("driving", 20s)) << teleop.errors();
  teleop.signal(SIGINT);
  EXPECT_EQ(teleop.wait(10s), 128 + SIGINT);
  EXPECT_NE(teleop.output().find("authority was released"), std::string::npos) << teleop.output();
  ASSERT_TRUE(watcher.wait_for_level(msg::kAuthorityNone));
  // Interrupted, `task wait` leaves authority as it is.
  ASSERT_EQ(command({"task", "start", "rotate", "--direction", "left"}), exit_status::kOk) << output_;
  Process waiting = start({"task", "wait", "--end"});
  ASSERT_TRUE(watcher.wait_for_level(msg::kAuthorityOperator));
  EXPECT_TRUE(eventually([&] {
    waiting.signal(SIGINT);  // sent again until the process has installed its signal handler
    return !waiting.running();
  }));
  ASSERT_EQ(waiting.wait(10s), 128 + SIGINT);
  watcher.poll();
  EXPECT_EQ(watcher.authorities.back().first.level, msg::kAuthorityOperator);
  // Interrupted before it is answered, `task start` withdraws its request: the task does not begin when the run
  // resumes.
  ASSERT_EQ(command({"release"}), exit_status::kOk) << output_;
  ASSERT_TRUE(watcher.wait_for_level(msg::kAuthorityNone));
  ASSERT_EQ(command({"pause"}), exit_status::kOk) << output_;
  const auto requests = dds::Reader<msg::Request>::observer(watcher.participant(), barrier_topics::kRequest, 16);
  Process starting = start({"task", "start", "rotate", "--direction", "left"});
  bool asked = false;  // a paused run answers nothing that could be waited for
  ASSERT_TRUE(eventually([&] {
    requests.take([&](const msg::Request& request) { asked |= request.kind == msg::kRequestTask; });
    return asked;
  }));
  starting.signal(SIGINT);
  EXPECT_EQ(starting.wait(10s), 128 + SIGINT) << starting.errors();
  EXPECT_NE(starting.errors().find("releases authority as soon as it resumes"), std::string::npos) << starting.errors();
  ASSERT_EQ(command({"resume"}), exit_status::kOk) << output_;
  ASSERT_EQ(command({"step", "10"}), exit_status::kOk) << output_;
  watcher.poll();
  EXPECT_EQ(watcher.authorities.back().first.level, msg::kAuthorityNone);
  ASSERT_EQ(command({"resume"}), exit_status::kOk) << output_;
  end(launcher);
}

TEST_F(Teleoperation, ThePlannerContinuesAfterAnOperatorHasDriven) {
  // At this pace the operator drives on the line. At a faster pace the robot may have reached the object, and the drive
  // presses the body against it: a joint that slips off then moves faster than its setpoint while authority changes.
  Process launcher = start({"run", "case_study", "--in-process", "--pace", "1x", "--report", (dir_ / "r").string()});
  ASSERT_TRUE(launcher.wait_for("simulated", 60s)) << launcher.output() << launcher.errors();
  Watcher watcher(domain());
  ASSERT_TRUE(watcher.wait_for_level(msg::kAuthorityPlanner));
  ASSERT_TRUE(eventually(
      [&] {
        watcher.poll();
        return watcher.task.goal_id != 0 && watcher.task.goal_state == msg::kGoalRunning;
      },
      60s));
  ASSERT_EQ(command({"teleop", "--drive", "0.4,0.3", "--for", "3s"}), exit_status::kOk) << output_;
  watcher.poll();
  const auto level_seen = [&](std::uint8_t level) {
    return std::any_of(watcher.authorities.begin(), watcher.authorities.end(),
                       [&](const auto& a) { return a.first.level == level; });
  };
  EXPECT_TRUE(level_seen(msg::kAuthorityOperator));
  ASSERT_TRUE(watcher.wait_for_level(msg::kAuthorityPlanner));
  EXPECT_TRUE(eventually([&] {
    watcher.poll();
    return watcher.task.goal_state == msg::kGoalRunning && watcher.task.goal_id >> 48 == msg::kAuthorityPlanner;
  }));
  std::set<std::int64_t> begun;  // ticks in which control first reads a change of authority
  for (std::size_t i = 1; i < watcher.authorities.size(); ++i) {
    const msg::Authority& now = watcher.authorities[i].first;
    if (now.level != watcher.authorities[i - 1].first.level) begun.insert(now.header.tick + 1);
  }
  EXPECT_GE(begun.size(), 2u);
  EXPECT_LE(fastest_setpoint(watcher, begun), kMaxSpeed_rad_s * 1.001);
  // The setpoints of the new source begin where the joints are, so that none jumps. Later, a joint that the drive has
  // pressed against an object may slip off it and catch up with its setpoint faster than the setpoint moves.
  for (const std::int64_t tick : begun) EXPECT_LE(fastest_joint(watcher, tick, tick + 25), kMaxSpeed_rad_s) << tick;
  EXPECT_EQ(watcher.mission.outcome, msg::kMissionRunning);
  end(launcher);
}

}  // namespace
}  // namespace constrictor::testing
