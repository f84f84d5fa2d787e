// The plant's process, in which the conductor is, is killed and restarted: the run goes on with the same result. Real
// processes with toy components, the real barrier and the real launcher.
#include <random>

#include "integration/run_command_fixture.hpp"

namespace constrictor::testing {
namespace {

class PlantRestart : public RunCommand {
 protected:
  /// Kills the process that hosts `name` and waits until its successor runs.
  void kill_and_wait(const std::string& name, Process& launcher) const {
    pid_t dead = -1;
    ASSERT_TRUE(eventually([&] { return (dead = members()[name]) > 0; })) << name;
    ::kill(dead, SIGKILL);
    ASSERT_TRUE(eventually([&] {
      const pid_t pid = members()[name];
      return !launcher.running() || (pid > 0 && pid != dead);
    })) << launcher.output();
  }
  /// Kills a process of the run `count` times, at random moments.
  void kill_often(const std::vector<std::string>& victims, int count, Process& launcher) {
    for (int i = 0; i < count; ++i) {
      std::this_thread::sleep_for(std::chrono::microseconds(random_() % 400'000));
      if (!launcher.running()) break;
      for (const auto& victim : victims) kill_and_wait(victim, launcher);
      ++kills_;
    }
  }
  void expect_equal_runs(const std::string& a, const std::string& b) const {
    EXPECT_EQ(state_hash(a), state_hash(b));
    Process diff = command({"diff", (dir_ / a).string(), (dir_ / b).string()});
    EXPECT_EQ(diff.wait(20s), 0) << diff.output() << diff.errors();
  }
  std::mt19937 random_{20261122};
  int kills_ = 0;
};

TEST_F(PlantRestart, ThePlantMayBeKilledAtAnyTick) {
  ASSERT_EQ(run(400, "undisturbed", {"--in-process"}).wait(30s), exit_status::kOk);
  Process launcher = run(400, "r", {"--pace", "4x"});
  kill_often({"physics"}, 5, launcher);
  ASSERT_EQ(launcher.wait(60s), exit_status::kOk) << launcher.output() << log("r", "physics") << log("r", "control");
  EXPECT_GE(kills_, 4) << launcher.output();
  EXPECT_EQ(report("r")["processes"][0]["restarts"], kills_);
  expect_equal_runs("r", "undisturbed");
  expect_nobody_left();
}

TEST_F(PlantRestart, AProcessWithAllMembersMayBeKilledAtAnyTick) {
  ASSERT_EQ(run(400, "undisturbed").wait(30s), exit_status::kOk);
  Process launcher = run(400, "r", {"--pace", "4x", "--in-process"});
  kill_often({"physics,navigation,control,planner,report"}, 4, launcher);
  ASSERT_EQ(launcher.wait(60s), exit_status::kOk) << launcher.output();
  EXPECT_GE(kills_, 3) << launcher.output();
  expect_equal_runs("r", "undisturbed");
}

TEST_F(PlantRestart, ThePlantAndAnotherMemberMayBeKilledAtOnce) {
  ASSERT_EQ(run(400, "undisturbed").wait(30s), exit_status::kOk);
  Process launcher = run(400, "r", {"--pace", "4x", "--group", "physics,planner"});
  kill_often({"physics,planner", "navigation"}, 3, launcher);
  kill_often({"control", "physics,planner"}, 2, launcher);
  ASSERT_EQ(launcher.wait(60s), exit_status::kOk) << launcher.output();
  EXPECT_GE(kills_, 4) << launcher.output();
  expect_equal_runs("r", "undisturbed");
}

}  // namespace
}  // namespace constrictor::testing
