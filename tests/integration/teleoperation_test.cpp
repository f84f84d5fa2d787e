// People and scripts at a running robot, with the real components: who is obeyed, and what the joints do when an operator dies.
#include <csignal>
#include <cmath>

#include "integration/cli_fixture.hpp"
#include "runtime/dds/domain.hpp"
#include "runtime/dds/endpoint.hpp"
#include "runtime/host.hpp"
#include "runtime/topics.hpp"

namespace constrictor::testing {
namespace {

using namespace std::chrono_literals;
namespace fs = std::filesystem;
using Clock = std::chrono::steady_clock;

constexpr double kMaxSpeed_rad_s = 4.0;  // of Mamba's joints (components/robot/mamba.yaml)

/// Everything that matters of a run, as an observer that misses nothing.
class Watcher {
 public:
  explicit Watcher(std::uint32_t domain)
      : domain_(domain), authority_(reader<msg::Authority>(topics::kAuthority)), command_(reader<msg::JointCommand>(topics::kJointCommand)),
        joints_(reader<msg::JointState>(topics::kJointState)), mission_(reader<msg::MissionStatus>(topics::kMissionStatus)),
        task_(reader<msg::TaskStatus>(topics::kTaskStatus)) {}
  void poll() {
    authority_.take([this](const msg::Authority& m) { authorities.emplace_back(m, Clock::now()); });
    command_.take([this](const msg::JointCommand& m) { commands.push_back(m); });
    joints_.take([this](const msg::JointState& m) { joints.push_back(m); });
    mission_.take([this](const msg::MissionStatus& m) { mission = m; });
    task_.take([this](const msg::TaskStatus& m) { task = m; });
  }
  [[nodiscard]] bool wait_for_level(std::uint8_t level, std::chrono::milliseconds bound = 30s) {
    return eventually([&] { poll(); return !authorities.empty() && authorities.back().first.level == level; }, bound);
  }
  /// How fast the wave turns, by the last setpoints: greatest difference of two commands.
  [[nodiscard]] bool moves() {
    const std::size_t from = commands.size();
    return eventually([&] {
      poll();
      return commands.size() > from + 5 && commands.back().position_rad[8] != commands[from].position_rad[8];
    });
  }

  std::vector<std::pair<msg::Authority, Clock::time_point>> authorities;
  std::vector<msg::JointCommand> commands;
  std::vector<msg::JointState> joints;
  msg::MissionStatus mission{};
  msg::TaskStatus task{};

 private:
  template <class T>
  [[nodiscard]] dds::Reader<T> reader(const Topic<T>& topic) const {
    return dds::Reader<T>::member(domain_.participant(), std::string(topic.name));
  }
  dds::Domain domain_;
  dds::Reader<msg::Authority> authority_;
  dds::Reader<msg::JointCommand> command_;
  dds::Reader<msg::JointState> joints_;
  dds::Reader<msg::MissionStatus> mission_;
  dds::Reader<msg::TaskStatus> task_;
};

class Teleoperation : public CliFixture {
 protected:
  Teleoperation() {
    // Without eyes, so that it is quick: nothing here needs to see.
    write("blind.yaml",
          "plant: physics\nrobot: components/robot/mamba.yaml\nscenario: sim/scenarios/case_study.yaml\npatience_s: 20\nprocesses:\n"
          "  - {components: [physics, guidance, navigation, control]}\n  - {components: [input]}\n");
  }
  [[nodiscard]] Process run_blind(const std::string& pace) {
    Process process = start({"run", "--manifest", (dir_ / "blind.yaml").string(), "--report", (dir_ / "r").string(), "--pace", pace});
    EXPECT_TRUE(process.wait_for("simulated", 30s)) << process.output() << process.errors();
    return process;
  }
  void end(Process& launcher) {
    EXPECT_EQ(command({"end"}), exit_status::kOk) << output_;
    EXPECT_EQ(launcher.wait(10s), 128 + SIGTERM);
  }
};

/// Commands and measured joints after somebody died while driving: held from the next tick on, and nothing jerked.
void expect_held(Watcher& watcher, std::int64_t latched, bool lockstep) {
  double fastest_setpoint = 0.0;
  double fastest_joint = 0.0;
  std::int64_t held_from = -1;
  for (std::size_t i = 1; i < watcher.commands.size(); ++i) {
    const msg::JointCommand& a = watcher.commands[i - 1];
    const msg::JointCommand& b = watcher.commands[i];
    const double dt_s = 0.02 * static_cast<double>(b.header.tick - a.header.tick);
    bool same = true;
    for (int j = 0; j < b.joint_count; ++j) {
      fastest_setpoint = std::max(fastest_setpoint, std::abs(b.position_rad[j] - a.position_rad[j]) / dt_s);
      same = same && a.position_rad[j] == b.position_rad[j];
    }
    if (!same) held_from = b.header.tick;
  }
  for (const auto& state : watcher.joints) {
    if (state.header.tick < latched) continue;
    for (int j = 0; j < state.joint_count; ++j) fastest_joint = std::max(fastest_joint, std::abs(state.velocity_rad_s[j]));
  }
  EXPECT_LE(fastest_setpoint, kMaxSpeed_rad_s * 1.001);
  EXPECT_LE(fastest_joint, kMaxSpeed_rad_s);
  std::printf("latched at tick %ld, last setpoint that differs at tick %ld, fastest joint after that %.2f rad/s\n",
              static_cast<long>(latched), static_cast<long>(held_from), fastest_joint);
  if (lockstep) { EXPECT_LE(held_from, latched + 1); }
}

TEST_F(Teleoperation, KilledWhileDrivingTheJointsHoldWithinALeaseAndATick) {
  for (const std::string pace : {"2x", "realtime"}) {
    SCOPED_TRACE(pace);
    Process launcher = run_blind(pace);
    Watcher watcher(domain());
    Process teleop = start({"teleop", "--drive", "0.5,0.2"});
    ASSERT_TRUE(teleop.wait_for("driving", 20s)) << teleop.errors();
    ASSERT_TRUE(watcher.wait_for_level(msg::kAuthorityOperator));
    ASSERT_TRUE(watcher.moves());
    teleop.signal(SIGKILL);
    const auto killed = Clock::now();
    ASSERT_TRUE(watcher.wait_for_level(msg::kAuthorityNone));
    const auto [nobody, heard] = watcher.authorities.back();
    const double wall_s = std::chrono::duration<double>(heard - killed).count();
    std::printf("%s: held %.3f s of wall time after the kill\n", pace.c_str(), wall_s);
    EXPECT_LT(wall_s, 0.5 + 0.5) << "a lease of 0.5 s and what a busy machine adds";
    const std::int64_t latched = nobody.header.tick;
    ASSERT_TRUE(eventually([&] { watcher.poll(); return watcher.commands.back().header.tick > latched + 60; }));
    expect_held(watcher, latched, pace != "realtime");
    end(launcher);
  }
}

TEST_F(Teleoperation, AnOperatorCapsLockStepAtRealTimeUnlessToldOtherwise) {
  Process launcher = run_blind("lockstep");
  Watcher watcher(domain());
  Process teleop = start({"teleop", "--drive", "0.3,0"});
  ASSERT_TRUE(watcher.wait_for_level(msg::kAuthorityOperator));
  const auto ticks_in = [&](std::chrono::milliseconds wall) {
    watcher.poll();
    const std::int64_t from = watcher.joints.back().header.tick;
    std::this_thread::sleep_for(wall);
    watcher.poll();
    return watcher.joints.back().header.tick - from;
  };
  EXPECT_LE(ticks_in(1000ms), 62) << "fifty ticks are a second";
  EXPECT_EQ(command({"resume"}), exit_status::kOk) << output_;
  EXPECT_NE(output_.find("at most 1x real time while an operator has authority"), std::string::npos) << output_;
  EXPECT_EQ(command({"pace", "lockstep"}), exit_status::kOk) << output_;
  EXPECT_NE(output_.find("lock-step, as fast as it goes"), std::string::npos) << output_;  // how fast that is depends on the machine
  teleop.signal(SIGINT);
  EXPECT_EQ(teleop.wait(10s), 128 + SIGINT);
  EXPECT_TRUE(watcher.wait_for_level(msg::kAuthorityNone)) << "it gave authority back";
  end(launcher);
}

TEST_F(Teleoperation, AnEmergencyStopIsLatchedAndClearingItStartsNothing) {
  Process launcher = run_blind("4x");
  Watcher watcher(domain());
  ASSERT_EQ(command({"task", "start", "rotate", "--direction", "left"}), exit_status::kOk) << output_;
  ASSERT_TRUE(watcher.moves());
  ASSERT_EQ(command({"stop"}), exit_status::kOk) << output_;
  ASSERT_TRUE(watcher.wait_for_level(msg::kAuthorityStop));
  const std::int64_t stopped = watcher.authorities.back().first.header.tick;
  EXPECT_EQ(command({"task", "start", "rotate", "--direction", "left"}), exit_status::kMissionFailed);
  EXPECT_NE(output_.find("emergency stop"), std::string::npos) << output_;
  EXPECT_EQ(command({"teleop", "--drive", "0.3,0", "--for", "1s"}), exit_status::kMissionFailed);
  ASSERT_EQ(command({"clear-stop"}), exit_status::kOk) << output_;
  ASSERT_TRUE(watcher.wait_for_level(msg::kAuthorityNone));
  const std::int64_t cleared = watcher.authorities.back().first.header.tick;
  ASSERT_TRUE(eventually([&] { watcher.poll(); return watcher.commands.back().header.tick > cleared + 100; }));
  const auto at_stop = std::find_if(watcher.commands.begin(), watcher.commands.end(), [&](const auto& c) { return c.header.tick == stopped + 1; });
  ASSERT_NE(at_stop, watcher.commands.end());
  for (auto c = at_stop; c != watcher.commands.end(); ++c) {
    for (int j = 0; j < c->joint_count; ++j) ASSERT_EQ(c->position_rad[j], at_stop->position_rad[j]) << "tick " << c->header.tick;
  }
  ASSERT_EQ(command({"task", "start", "rotate", "--direction", "left", "--timeout-s", "2"}), exit_status::kOk) << output_;
  EXPECT_EQ(command({"task", "wait", "--event", "timeout", "--timeout", "30s"}), exit_status::kOk) << output_;
  EXPECT_EQ(command({"task", "wait", "--end", "--timeout", "30s"}), exit_status::kOk) << output_;
  EXPECT_EQ(command({"task", "wait", "--event", "line lost", "--timeout", "20s"}), exit_status::kMissionFailed) << "it has ended without";
  end(launcher);
}

TEST_F(Teleoperation, ATaskIsAnsweredByNavigationAndAwaitedByItsOwnEventsOnly) {
  EXPECT_EQ(command({"task", "start", "drop", "--drop-zone-colour", "pink"}), exit_status::kUsage) << "a wrong value before a missing run";
  Process launcher = run_blind("4x");
  ASSERT_EQ(command({"task", "start", "rotate", "--direction", "left"}), exit_status::kOk) << output_;
  const auto at = output_.find("goal ");
  ASSERT_NE(at, std::string::npos) << output_;
  const std::string first = std::to_string(std::stoull(output_.substr(at + 5)));
  ASSERT_EQ(command({"task", "start", "rotate", "--direction", "left", "--timeout-s", "2"}), exit_status::kOk) << output_;
  EXPECT_EQ(command({"task", "wait", "--end"}), exit_status::kOk) << "not the end of the goal before: " << output_;
  EXPECT_EQ(command({"task", "wait", "--end", "--goal", first}), exit_status::kMissionFailed);
  EXPECT_NE(output_.find("preempted"), std::string::npos) << output_;
  EXPECT_EQ(command({"task", "wait", "--event", "timeout", "--goal", "any", "--timeout", "500ms"}), exit_status::kWaitedTooLong)
      << "it was before: " << output_;

  EXPECT_EQ(command({"task", "start", "explore"}), exit_status::kMissionFailed);
  EXPECT_NE(output_.find("explore needs a direction"), std::string::npos) << output_;
  EXPECT_EQ(command({"task", "wait", "--end"}), exit_status::kMissionFailed);
  EXPECT_NE(output_.find("refused: explore needs a direction"), std::string::npos) << output_;
  EXPECT_EQ(command({"task", "start", "follow_path"}), exit_status::kUsage);
  EXPECT_NE(output_.find("--path"), std::string::npos) << output_;
  EXPECT_EQ(command({"task", "start", "follow_path", "--path", "50,0", "51,0"}), exit_status::kMissionFailed);
  EXPECT_NE(output_.find("too far"), std::string::npos) << output_;
  ASSERT_EQ(command({"topic", "echo", "guidance/pose", "--count", "1", "--json"}), exit_status::kOk) << output_;
  const auto pose = nlohmann::json::parse(output_);  // it has turned, and wandered
  const auto point = [&](double ahead_m) { return std::to_string(pose["x_m"].get<double>() + ahead_m) + "," + std::to_string(pose["y_m"].get<double>()); };
  ASSERT_EQ(command({"task", "start", "follow_path", "--path", point(0.0), point(30.0)}), exit_status::kOk) << output_;
  EXPECT_EQ(command({"task", "cancel"}), exit_status::kOk);
  EXPECT_NE(output_.find("constrictor release"), std::string::npos) << output_;
  EXPECT_EQ(command({"task", "wait", "--end"}), exit_status::kMissionFailed);
  EXPECT_NE(output_.find("preempted"), std::string::npos) << output_;
  end(launcher);
}

TEST_F(Teleoperation, TakesOverInMidMissionDrivesAndThePlannerGoesOn) {
  Process launcher = start({"run", "case_study", "--in-process", "--pace", "4x", "--report", (dir_ / "r").string()});
  ASSERT_TRUE(launcher.wait_for("simulated", 60s)) << launcher.output() << launcher.errors();
  Watcher watcher(domain());
  ASSERT_TRUE(watcher.wait_for_level(msg::kAuthorityPlanner));
  ASSERT_TRUE(eventually([&] { watcher.poll(); return watcher.task.goal_id != 0 && watcher.task.state == msg::kGoalRunning; }, 60s));
  ASSERT_EQ(command({"teleop", "--drive", "0.4,0.3", "--for", "3s"}), exit_status::kOk) << output_;
  watcher.poll();
  const auto level_seen = [&](std::uint8_t level) {
    return std::any_of(watcher.authorities.begin(), watcher.authorities.end(), [&](const auto& a) { return a.first.level == level; });
  };
  EXPECT_TRUE(level_seen(msg::kAuthorityOperator));
  ASSERT_TRUE(watcher.wait_for_level(msg::kAuthorityPlanner));
  EXPECT_TRUE(eventually([&] { watcher.poll(); return watcher.task.state == msg::kGoalRunning && watcher.task.goal_id >> 48 == msg::kAuthorityPlanner; }));
  // While the operator held authority no goal of the planner's ran, and no setpoint jumped at either change.
  double fastest = 0.0;
  for (std::size_t i = 1; i < watcher.commands.size(); ++i) {
    for (int j = 0; j < watcher.commands[i].joint_count; ++j) {
      fastest = std::max(fastest, std::abs(watcher.commands[i].position_rad[j] - watcher.commands[i - 1].position_rad[j]) / 0.02);
    }
  }
  EXPECT_LE(fastest, kMaxSpeed_rad_s * 1.001);
  EXPECT_EQ(watcher.mission.mission, msg::kMissionRunning);
  end(launcher);
}

}  // namespace
}  // namespace constrictor::testing
