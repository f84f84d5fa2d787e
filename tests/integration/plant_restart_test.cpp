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

TEST_F(PlantRestart, APausedRunStaysPausedWhenItsPlantIsKilled) {
  environment_ = {{"XDG_RUNTIME_DIR", dir_.string()}};  // a registry in which this run is the only one
  Process launcher = run(400, "r", {"--pace", "2x"});
  ASSERT_TRUE(eventually([&] {  // until the log has the messages of some ticks
    std::error_code not_yet;
    return fs::file_size(dir_ / "r" / "hashes.bin", not_yet) > 2'000 && !not_yet;
  })) << launcher.output();
  ASSERT_EQ(command({"pause"}).wait(20s), 0);
  kill_and_wait("physics", launcher);
  Process step = command({"step", "3"});
  EXPECT_EQ(step.wait(20s), 0) << step.output() << step.errors();
  EXPECT_NE(step.output().find("paused"), std::string::npos) << step.output();
  EXPECT_TRUE(launcher.running());
  ASSERT_EQ(command({"resume"}).wait(20s), 0);
  EXPECT_EQ(launcher.wait(60s), exit_status::kOk) << launcher.output();
}

TEST_F(PlantRestart, WithoutCheckpointsTheDeathOfThePlantEndsTheRun) {
  Process launcher = run(100'000, "r", {"--pace", "1x", "--no-checkpoints"});
  ASSERT_TRUE(eventually([&] { return members().size() == 5; }));
  kill_member("physics", SIGKILL);
  EXPECT_EQ(launcher.wait(15s), exit_status::kSoftware) << launcher.output();
  Process resume = command({"run", "--resume", (dir_ / "r").string()});
  EXPECT_EQ(resume.wait(20s), exit_status::kConfiguration) << resume.output() << resume.errors();
  EXPECT_NE(resume.errors().find("found no checkpoint.bin"), std::string::npos) << resume.errors();
}

class RunResume : public PlantRestart {
 protected:
  /// Starts a run, and kills its launcher at random moments, so that the kernel kills its processes. `between` is
  /// called while no process runs. Returns the launcher that ends the run.
  void run_with_kills(
      int kills, const std::function<void(int)>& between = [](int) {}) {
    ASSERT_EQ(run(500, "undisturbed").wait(30s), exit_status::kOk);
    auto launcher = std::make_unique<Process>(run(500, "r", {"--pace", "4x"}));
    for (int i = 0; i < kills; ++i) {
      ASSERT_TRUE(eventually([&] { return members().size() == 5; })) << launcher->output() << launcher->errors();
      ASSERT_TRUE(eventually([&] { return fs::exists(dir_ / "r" / "checkpoint.bin"); }));
      std::this_thread::sleep_for(std::chrono::microseconds(100'000 + random_() % 400'000));
      launcher->signal(SIGKILL);
      ASSERT_TRUE(launcher->wait(10s));
      expect_nobody_left();
      between(i);
      launcher = std::make_unique<Process>(command({"run", "--resume", (dir_ / "r").string()}));
    }
    EXPECT_EQ(launcher->wait(60s), exit_status::kOk) << launcher->output() << launcher->errors() << log("r", "physics");
    expect_equal_runs("r", "undisturbed");
    EXPECT_FALSE(fs::exists(dir_ / "r" / "checkpoint.bin")) << "a run that is over needs no checkpoint";
    output_ = launcher->output();
  }
  std::string output_;
};

TEST_F(RunResume, ARunWhoseLauncherIsKilledContinuesWithTheSameResult) {
  run_with_kills(3);
  Process again = command({"run", "--resume", (dir_ / "r").string()});
  EXPECT_EQ(again.wait(20s), exit_status::kConfiguration);
  EXPECT_NE(again.errors().find("the run is over: there is nothing to continue"), std::string::npos) << again.errors();
}

TEST_F(RunResume, ARunWhoseNewestCheckpointIsDamagedContinuesFromTheOneBefore) {
  run_with_kills(1, [this](int) {
    // The newer of the two slots: the numbers are at their begin.
    std::fstream file(dir_ / "r" / "checkpoint.bin", std::ios::binary | std::ios::in | std::ios::out);
    std::uint64_t numbers[2] = {};
    for (int i : {0, 1}) {
      file.seekg(4096 * (i + 1));
      file.read(reinterpret_cast<char*>(&numbers[i]), sizeof numbers[i]);
    }
    file.seekp(4096 * (numbers[0] > numbers[1] ? 1 : 2) + 16);
    file.put('x');
  });
  EXPECT_NE(log("r", "physics").find("one of the two checkpoints is not complete"), std::string::npos);
}

TEST_F(RunResume, RefusesWhatItCannotContinue) {
  const auto error_of = [this](const fs::path& folder) {
    Process resume = command({"run", "--resume", folder.string()});
    EXPECT_EQ(resume.wait(20s), exit_status::kConfiguration) << resume.output();
    return resume.errors();
  };
  fs::create_directory(dir_ / "empty");
  EXPECT_NE(error_of(dir_ / "empty").find("accepted the report directory of a run"), std::string::npos);
  {
    Process launcher = run(100'000, "r", {"--pace", "4x"});
    ASSERT_TRUE(launcher.wait_for("run ", 20s));
    ASSERT_TRUE(eventually([&] { return members().size() == 5; }));
    ASSERT_TRUE(eventually([&] { return fs::exists(dir_ / "r" / "checkpoint.bin"); }));
    EXPECT_NE(error_of(dir_ / "r").find("is the run still going on?"), std::string::npos);
    EXPECT_TRUE(launcher.running());
    launcher.signal(SIGKILL);
    ASSERT_TRUE(launcher.wait(10s));
    expect_nobody_left();
  }
  // The other process's checkpoint, in which both slots are damaged, and no copy.
  std::fstream file(dir_ / "r" / "checkpoint.bin", std::ios::binary | std::ios::in | std::ios::out);
  for (const int slot : {4096, 8192}) {
    file.seekp(slot + 16);
    file.write("damaged", 7);
  }
  file.close();
  fs::remove(dir_ / "r" / "checkpoint_on_disk.bin");
  EXPECT_NE(error_of(dir_ / "r").find("both checkpoints in it are damaged"), std::string::npos);
  Process mixed = command({"run", "--resume", (dir_ / "r").string(), "--seed", "2"});
  EXPECT_EQ(mixed.wait(20s), exit_status::kUsage) << mixed.output() << mixed.errors();
}

TEST_F(RunResume, ARunWhoseTerminalIsClosedIsLeftAndContinues) {
  ASSERT_EQ(run(300, "undisturbed").wait(30s), exit_status::kOk);
  Process launcher = run(300, "r", {"--pace", "4x"});
  ASSERT_TRUE(eventually([&] { return members().size() == 5; }));
  ASSERT_TRUE(eventually([&] { return fs::exists(dir_ / "r" / "checkpoint.bin"); }));
  launcher.signal(SIGHUP);
  EXPECT_EQ(launcher.wait(20s), 128 + SIGHUP) << launcher.output();
  EXPECT_NE(launcher.output().find("to continue this run: constrictor run --resume "), std::string::npos);
  expect_nobody_left();
  Process resume = command({"run", "--resume", (dir_ / "r").string()});
  ASSERT_EQ(resume.wait(60s), exit_status::kOk) << resume.output() << resume.errors();
  expect_equal_runs("r", "undisturbed");
}

}  // namespace
}  // namespace constrictor::testing
