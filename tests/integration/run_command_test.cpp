// `constrictor run` and `end` with real processes: the components are toys, the barrier and the launcher are real.
#include "cyclone/domain.hpp"
#include "cyclone/endpoint.hpp"
#include "integration/run_command_fixture.hpp"
#include "integration/run_ticks.hpp"
#include "runtime/wire.hpp"

namespace constrictor::testing {
namespace {

TEST_F(RunCommand, SucceedsAndReportsOnEveryProcess) {
  Process launcher = run(300, "r");
  ASSERT_EQ(launcher.wait(30s), exit_status::kOk) << launcher.output() << launcher.errors();
  expect_nobody_left();
  const auto json = report("r");
  EXPECT_EQ(json["success"], true);
  EXPECT_EQ(json["ticks"], 300);
  EXPECT_GT(json["wall_time_s"], 0.0);
  ASSERT_EQ(json["processes"].size(), 5u);
  EXPECT_EQ(json["processes"][2]["name"], "control");
  EXPECT_EQ(json["processes"][2]["restarts"], 0);
  EXPECT_GT(json["processes"][2]["cpu_s"], 0.0);
}

TEST_F(RunCommand, EveryGroupingGivesTheSameStateHashAndDiffFindsNoDifference) {
  ASSERT_EQ(run(300, "each").wait(30s), exit_status::kOk);
  ASSERT_EQ(run(300, "one", {"--in-process"}).wait(30s), exit_status::kOk);
  ASSERT_EQ(
      run(300, "groups", {"--group", "planner,navigation", "--group", "report,physics", "--pace", "20x"}).wait(30s),
      exit_status::kOk);
  EXPECT_EQ(report("one")["processes"].size(), 1u);
  EXPECT_EQ(report("groups")["processes"].size(), 3u);
  for (const char* other : {"one", "groups"}) {
    EXPECT_EQ(state_hash(other), state_hash("each")) << other;
    Process diff = command({"diff", (dir_ / "each").string(), (dir_ / other).string()});
    EXPECT_EQ(diff.wait(10s), 0);
    EXPECT_EQ(diff.output(), "equal\n");
  }
}

TEST_F(RunCommand, DiffNamesTheFirstFieldInWhichSeedsDiffer) {
  ASSERT_EQ(run(100, "a", {"--record", "--in-process"}).wait(30s), exit_status::kOk);
  ASSERT_EQ(run(100, "b", {"--record", "--in-process", "--seed", "2"}).wait(30s), exit_status::kOk);
  EXPECT_NE(state_hash("a"), state_hash("b"));
  Process diff = command({"diff", (dir_ / "a").string(), (dir_ / "b").string()});
  EXPECT_EQ(diff.wait(10s), 1);
  EXPECT_EQ(diff.output().rfind("first difference: tick 0, component physics, topic joint_state, field ", 0), 0u)
      << diff.output();
}

TEST_F(RunCommand, RestartsKilledMembersAndTheStateHashStays) {
  ASSERT_EQ(run(400, "undisturbed", {"--in-process"}).wait(30s), exit_status::kOk);
  Process launcher = run(400, "r", {"--pace", "2x"});
  ASSERT_TRUE(eventually([&] { return members().size() == 5; }));
  RunTicks ticks(launcher);
  for (const char* victim : {"control", "navigation", "planner", "report"}) {
    ASSERT_TRUE(ticks.pass(40)) << launcher.output();
    const pid_t pid = members()[victim];
    ASSERT_GT(pid, 0) << victim;
    ::kill(pid, SIGKILL);
    ASSERT_TRUE(eventually([&] { return members()[victim] > 0 && members()[victim] != pid; })) << launcher.output();
  }
  ASSERT_EQ(launcher.wait(60s), exit_status::kOk) << launcher.output();
  EXPECT_EQ(state_hash("r"), state_hash("undisturbed"));
  EXPECT_EQ(report("r")["processes"][2]["restarts"], 1);
  EXPECT_NE(launcher.output().find("control was killed by signal 9 (Killed); restarted as incarnation 2"),
            std::string::npos)
      << launcher.output();
}

// Each incarnation is killed soon after its first step. A member that dies five times while the run stands at one tick
// ends the run. Here ticks advance between the deaths, so ten of them do not.
TEST_F(RunCommand, AMemberKilledTenTimesDoesNotEndTheRunWhileTicksAdvance) {
  ASSERT_EQ(run(600, "undisturbed", {"--in-process"}).wait(30s), exit_status::kOk);
  Process launcher = run(600, "r", {"--pace", "2x"});
  RunTicks ticks(launcher);
  const auto statuses = dds::Reader<msg::ComponentStatus>::member(ticks.participant(), barrier_topics::kStatus);
  for (std::uint32_t incarnation = 1; incarnation <= 10; ++incarnation) {
    bool steps = false;
    ASSERT_TRUE(eventually([&] {
      statuses.take([&](const msg::ComponentStatus& status) {
        steps |= status.component == std::string("control") && status.incarnation == incarnation && status.tick >= 0;
      });
      return steps;
    })) << incarnation
        << ": " << launcher.output();
    ASSERT_TRUE(ticks.pass(10)) << launcher.output();
    kill_member("control", SIGKILL);
  }
  ASSERT_EQ(launcher.wait(60s), exit_status::kOk) << launcher.output();
  EXPECT_EQ(state_hash("r"), state_hash("undisturbed"));
  EXPECT_EQ(report("r")["processes"][2]["restarts"], 10);
}

TEST_F(RunCommand, TheDeathOfThePlantEndsTheRunWithAnErrorIfTheManifestAllowsNoRestart) {
  write("once.yaml", replaced(kManifest, "program: toy_host}", "program: toy_host, restarts: 0}"));
  Process launcher = run(100'000, "r", {"--pace", "1x"}, "once.yaml");
  ASSERT_TRUE(eventually([&] { return members().size() == 5; }));
  kill_member("physics", SIGKILL);
  EXPECT_EQ(launcher.wait(15s), exit_status::kSoftware);
  EXPECT_NE(launcher.output().find("physics, the plant, was killed by signal 9"), std::string::npos)
      << launcher.output();
  EXPECT_EQ(report("r")["success"], false);
  expect_nobody_left();
}

TEST_F(RunCommand, TheFirstCtrlCEndsTheRunThroughTheConductor) {
  Process launcher = run(100'000, "r", {"--pace", "2x"});
  ASSERT_TRUE(launcher.wait_for("simulated", 30s)) << launcher.output() << launcher.errors();
  launcher.signal(SIGINT);
  EXPECT_EQ(launcher.wait(30s), 128 + SIGINT) << launcher.output();
  EXPECT_TRUE(members().empty());
  EXPECT_EQ(launcher.output().find("kill"), launcher.output().rfind("kills its processes"))
      << "no process may be killed: " << launcher.output();
  const auto json = report("r");
  EXPECT_EQ(json["success"], false);
  const std::string reason = json["reason"];
  EXPECT_EQ(reason.rfind("ended by user at ", 0), 0u) << reason;
  EXPECT_FALSE(json.contains("error")) << json;
  EXPECT_NE(launcher.output().find("mission did not succeed (" + reason + ")"), std::string::npos)
      << "the last line has the same reason: " << launcher.output();
  // All members have finished the same last tick. Therefore `diff` finds complete logs and can compare them.
  Process diff = command({"diff", (dir_ / "r").string(), (dir_ / "r").string()});
  EXPECT_EQ(diff.wait(20s), 0) << diff.output() << diff.errors();
}

TEST_F(RunCommand, TheSecondCtrlCKillsARunThatDoesNotEnd) {
  Process launcher = run(100'000, "r", {"--pace", "2x"});
  ASSERT_TRUE(launcher.wait_for("simulated", 30s)) << launcher.output();
  kill_member("physics", SIGSTOP);
  launcher.signal(SIGINT);
  ASSERT_TRUE(launcher.wait_for("a second signal kills", 10s)) << launcher.output();
  // A signal that follows within RunEnding::kSameWish counts as the same wish, so the user presses again.
  EXPECT_TRUE(eventually([&] {
    launcher.signal(SIGINT);
    return !launcher.running();
  })) << launcher.output();
  EXPECT_EQ(launcher.wait(10s), 128 + SIGINT) << launcher.output();
  EXPECT_TRUE(members().empty());
  EXPECT_NE(report("r").value("reason", "").find("processes killed because a second signal arrived"), std::string::npos)
      << report("r");
}

TEST_F(RunCommand, ProcessesAreKilledIfTheConductorDoesNotAnswerAndTheReportNamesTheReason) {
  // The members must be more patient than the launcher, which waits 5 s for the conductor's answer.
  write("patient.yaml", replaced(kManifest, "patience_s: 4", "patience_s: 60"));
  Process launcher = run(100'000, "r", {"--pace", "2x"}, "patient.yaml");
  ASSERT_TRUE(launcher.wait_for("simulated", 30s)) << launcher.output();
  kill_member("physics", SIGSTOP);
  launcher.signal(SIGTERM);
  EXPECT_EQ(launcher.wait(30s), 128 + SIGTERM) << launcher.output();
  EXPECT_TRUE(members().empty());
  EXPECT_NE(report("r").value("reason", "").find("processes killed because"), std::string::npos) << report("r");
  EXPECT_NE(launcher.output().find("the report will be incomplete"), std::string::npos) << launcher.output();
}

TEST_F(RunCommand, CtrlCBeforeTheRunBeginsKillsItsProcesses) {
  Process launcher = run_with_planner("exec sleep 100");
  ASSERT_TRUE(eventually([&] { return members().size() >= 4; }));
  launcher.signal(SIGINT);
  EXPECT_EQ(launcher.wait(10s), 128 + SIGINT) << launcher.output();
  EXPECT_TRUE(members().empty());
  EXPECT_NE(report("r").value("reason", "").find("the run had not begun"), std::string::npos) << report("r");
}

TEST_F(RunCommand, AKilledLauncherLeavesNoProcess) {
  Process launcher = run(100'000, "r", {"--pace", "1x"});
  ASSERT_TRUE(eventually([&] { return members().size() == 5; }));
  kill_member("control", SIGSTOP);
  launcher.signal(SIGKILL);
  launcher.wait(5s);
  expect_nobody_left();
}

TEST_F(RunCommand, AStoppedLauncherDoesNotStopTheRun) {
  ASSERT_EQ(run(300, "undisturbed", {"--in-process"}).wait(30s), exit_status::kOk);
  Process launcher = run(300, "r", {"--pace", "4x"});
  ASSERT_TRUE(eventually([&] { return members().size() == 5; }));
  launcher.signal(SIGSTOP);
  EXPECT_TRUE(eventually([&] { return fs::exists(dir_ / "r/mission.json"); }));
  launcher.signal(SIGCONT);
  ASSERT_EQ(launcher.wait(20s), exit_status::kOk) << launcher.output();
  EXPECT_EQ(state_hash("r"), state_hash("undisturbed"));
}

TEST_F(RunCommand, TheExitStatusIsOneIfTheMissionDoesNotSucceed) {
  Process launcher = run(100'000, "r", {"--max-sim-time", "20", "--pace", "20x"});
  EXPECT_EQ(launcher.wait(30s), exit_status::kFailed) << launcher.output();
  EXPECT_EQ(report("r")["reason"], "time limit of 20 s (--max-sim-time)");
  EXPECT_NE(launcher.output().find("mission did not succeed (time limit of 20 s (--max-sim-time))"), std::string::npos)
      << launcher.output();
  EXPECT_NEAR(report("r").value("ticks", 0.0), 1000, 1);  // members take no step in the final tick
}

TEST_F(RunCommand, StatusShowsAndEndEndsTheOnlyRun) {
  environment_ = {{"XDG_RUNTIME_DIR", dir_.string()}};  // a registry of runs in which this run is the only one
  Process none = command({"status"});
  EXPECT_EQ(none.wait(10s), exit_status::kSoftware);
  EXPECT_NE(none.errors().find("no run on this host"), std::string::npos);
  Process launcher = run(100'000, "r", {"--pace", "2x"});
  ASSERT_TRUE(launcher.wait_for("simulated", 15s));
  Process status = command({"status"});
  EXPECT_EQ(status.wait(10s), exit_status::kOk);
  for (const char* name : {"physics", "navigation", "control", "planner", "report"}) {
    EXPECT_NE(status.output().find(std::string("\n") + name), std::string::npos) << status.output();
  }
  EXPECT_EQ(status.output().find("no status yet"), std::string::npos) << status.output();
  Process end = command({"end"});
  EXPECT_EQ(end.wait(30s), exit_status::kOk) << end.errors();
  EXPECT_NE(end.output().find("has ended: ended by user at "), std::string::npos) << end.output();
  EXPECT_EQ(launcher.wait(5s), 128 + SIGTERM);
  expect_nobody_left();
}

TEST_F(RunCommand, RunsAtTheSameTimeUseDifferentDomains) {
  Process a = run(100'000, "a", {"--pace", "1x"});
  ASSERT_TRUE(eventually([&] { return members().size() == 5; }));
  Process b = run(100, "b");
  EXPECT_EQ(b.wait(30s), exit_status::kOk) << b.output();
  const auto first_word = [](const Process& process) { return process.output().substr(0, process.output().find(':')); };
  EXPECT_NE(first_word(a), first_word(b));
  a.signal(SIGTERM);
  EXPECT_EQ(a.wait(10s), 128 + SIGTERM);
}

TEST_F(RunCommand, AMemberWithAnotherNumericProfileIsRefusedWithNameAndReason) {
  write("other.yaml", replaced(kManifest, "[planner], program: toy_host",
                               "[planner], program: toy_host, environment: ['GLIBC_TUNABLES=']"));
  Process launcher = run(300, "r", {}, "other.yaml");
  EXPECT_EQ(launcher.wait(20s), exit_status::kRefused) << launcher.output();
  EXPECT_NE(launcher.output().find("planner: the run refuses this process: numeric profile differs"), std::string::npos)
      << launcher.output();
}

TEST_F(RunCommand, AMemberThatNeverJoinsIsNamed) {
  Process launcher = run_with_planner("exec sleep 100");
  EXPECT_EQ(launcher.wait(30s), exit_status::kWaitedTooLong) << launcher.output();
  EXPECT_NE(launcher.output().find("waits for Hello of planner"), std::string::npos) << launcher.output();
  expect_nobody_left();
}

TEST_F(RunCommand, AMemberThatDiesFiveTimesInARowEndsTheRun) {
  Process launcher = run_with_planner("echo no luck today\nexit 3");
  EXPECT_EQ(launcher.wait(30s), exit_status::kSoftware);
  EXPECT_NE(launcher.output().find("planner: no luck today"), std::string::npos) << launcher.output();
  EXPECT_NE(launcher.output().find("died 5 times in a row"), std::string::npos) << launcher.output();
}

}  // namespace
}  // namespace constrictor::testing
