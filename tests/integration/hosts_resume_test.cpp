// Runs whose plant is on another host are continued by another launcher: what the host has kept of them is enough.
#include "integration/hosts_fixture.hpp"
#include "integration/run_ticks.hpp"

namespace constrictor::testing {
namespace {

class HostsResume : public Hosts {
 protected:
  static constexpr long kTicks = 500;

  /// Writes hosts.yaml: the plant and report run on the host `robot`.
  void plant_there(int patience_s) const {
    std::string manifest = replaced(kManifest, "patience_s: 4", "patience_s: " + std::to_string(patience_s));
    for (const char* name : {"physics", "report"}) {
      const std::string entry = std::string("[") + name + "], program: toy_host";
      manifest = replaced(manifest, entry, entry + ", host: robot");
    }
    write("hosts.yaml",
          manifest + "hosts: {here: local, robot: {ssh: snake@10.0.0.2, directory: " + bin_.string() + "}}\n");
  }
  /// Starts a run and waits until its plant has stored checkpoints.
  [[nodiscard]] Process begun(const std::string& pace = "4x") const {
    Process launcher = run_there(kTicks, "r", {"--pace", pace});
    EXPECT_TRUE(eventually([&] { return members().size() == 5; })) << launcher.output() << launcher.errors();
    EXPECT_TRUE(eventually([&] { return !kept().empty() && fs::exists(kept() / "checkpoint.bin"); }));
    EXPECT_TRUE(RunTicks(launcher).pass(20)) << launcher.output();  // somewhere in the run
    return launcher;
  }
  /// The folder in which the other host keeps the plant's files; empty: there is none.
  [[nodiscard]] fs::path kept() const {
    std::error_code none;
    for (const auto& entry : fs::directory_iterator(state() / "constrictor", none)) return entry.path();
    return {};
  }
  [[nodiscard]] Process resume() const { return command({"run", "--resume", (dir_ / "r").string()}); }
  void expect_result_of_an_undisturbed_run() {
    ASSERT_EQ(run_there(kTicks, "one", {"--in-process"}).wait(30s), exit_status::kOk);
    EXPECT_EQ(state_hash("r"), state_hash("one"));
    EXPECT_NE(state_hash("one"), "none");
    Process diff = command({"diff", (dir_ / "one").string(), (dir_ / "r").string()});
    EXPECT_EQ(diff.wait(10s), 0) << diff.output();
  }
};

TEST_F(HostsResume, AfterTheAgentHasEndedTooTheRunIsContinuedFromWhatTheHostHasKept) {
  plant_there(3);
  Process launcher = begun();
  launcher.signal(SIGKILL);
  ASSERT_TRUE(launcher.wait(10s));
  expect_nothing_runs();  // the agent waits for its patience only
  ASSERT_FALSE(kept().empty());
  EXPECT_EQ(fs::status(kept()).permissions(), fs::perms::owner_all);
  Process resumed = resume();
  ASSERT_EQ(resumed.wait(60s), exit_status::kOk) << resumed.output() << resumed.errors();
  EXPECT_NE(resumed.output().find("the run continues from its newest checkpoint"), std::string::npos)
      << resumed.output();
  expect_result_of_an_undisturbed_run();
  expect_nothing_left();
}

TEST_F(HostsResume, ALauncherThatComesBackAtOnceEndsWhatIsLeftOfItsPredecessorAndContinues) {
  plant_there(20);
  Process first = begun();
  for (int i = 0; i < 3; ++i) {
    first.signal(SIGKILL);
    ASSERT_TRUE(first.wait(10s));
    ASSERT_GT(agent(), 0) << "it waits for its launcher";
    first = resume();
    ASSERT_TRUE(eventually([&] { return members().size() == 5; })) << first.output() << first.errors();
    ASSERT_TRUE(RunTicks(first).pass(20)) << first.output() << first.errors();
  }
  ASSERT_EQ(first.wait(60s), exit_status::kOk) << first.output() << first.errors();
  expect_result_of_an_undisturbed_run();
  expect_nothing_left();
}

TEST_F(HostsResume, ARunThatGoesOnIsNotTakenFromItsLauncher) {
  plant_there(20);
  Process launcher = begun("1x");
  Process second = resume();
  EXPECT_EQ(second.wait(20s), exit_status::kConfiguration) << second.output();
  EXPECT_NE(second.errors().find("is the run still going on?"), std::string::npos) << second.errors();
  EXPECT_TRUE(launcher.running());
  EXPECT_EQ(members().size(), 5u);
  launcher.signal(SIGHUP);  // its terminal is closed
  EXPECT_EQ(launcher.wait(30s), 128 + SIGHUP) << launcher.output();
  EXPECT_NE(launcher.output().find("to continue this run: constrictor run --resume "), std::string::npos);
  expect_nobody_left();
  ASSERT_FALSE(kept().empty());
  Process resumed = resume();
  ASSERT_EQ(resumed.wait(60s), exit_status::kOk) << resumed.output() << resumed.errors();
  expect_result_of_an_undisturbed_run();
  expect_nothing_left();
}

TEST_F(HostsResume, AnInterruptedRunLeavesNothing) {
  plant_there(20);
  Process launcher = begun("1x");
  ASSERT_TRUE(launcher.wait_for("simulated", 60s)) << launcher.output();  // before that, it would kill the processes
  launcher.signal(SIGINT);
  EXPECT_EQ(launcher.wait(30s), 130) << launcher.output() << launcher.errors();
  expect_nothing_left();
}

}  // namespace
}  // namespace constrictor::testing
