// The first 12 s of a mission with the real components, or fewer. The state hash does not depend on the grouping of
// components into processes, on stops, kills or the pace, nor on the observer `overview`. It does depend on the seed,
// and on one ulp in one command.

#include "integration/determinism_run.hpp"
#include "integration/run_ticks.hpp"

namespace constrictor::testing {
namespace {

namespace fs = std::filesystem;
using namespace std::chrono_literals;

class Determinism : public DeterminismRun {
 protected:
  Determinism() : DeterminismRun("short", 120s) { limit_sim_time(kSimTime_s); }
  static constexpr double kSimTime_s = 12.0;
};

TEST_F(Determinism, SameHashForAnyGroupingAndPace) {
  const std::string expected = run("reference");
  {
    std::vector<Process> others;  // a load on both cores
    for (int i = 0; i < 2; ++i) others.emplace_back(std::vector<std::string>{"/bin/sh", "-c", "while :; do :; done"});
    EXPECT_EQ(run("again"), expected);
  }
  EXPECT_EQ(run("one", {"--in-process"}), expected);
  EXPECT_EQ(run("two", {"--group", "physics,control,navigation"}), expected);
  EXPECT_EQ(run("three", {"--manifest", "case_study_live", "--group", "camera,perception,guidance", "--group",
                          "planner,input,report,overview"}),
            expected);
  EXPECT_EQ(run("capped", {"--pace", "2x"}), expected);
  // Guidance has much floating-point work. It runs with fewer CPU features than the other members, as on an older host.
  write_manifest(
      "masked.yaml",
      {{"guidance",
        "    environment: ['GLIBC_TUNABLES=glibc.cpu.hwcaps=-FMA,-FMA4,-AVX2,-AVX,-AVX512F,-SSE4_2,-ERMS']\n"}});
  EXPECT_EQ(run("masked", {"--manifest", (dir_ / "masked.yaml").string()}), expected);
}

// As if perception, planner and report were on another host.
TEST_F(Determinism, LatenciesOfAManifestBelongToTheRunAndNotToItsProcesses) {
  const std::string line = "    latency_ticks: 5\n";
  write_manifest("far.yaml", {{"perception", line}, {"planner", line}, {"report", line}});
  const std::vector<std::string> far = {"--manifest", (dir_ / "far.yaml").string()};
  const auto with = [&far](std::vector<std::string> more) {
    more.insert(more.begin(), far.begin(), far.end());
    return more;
  };
  const std::string expected = run("one", with({"--in-process"}));
  EXPECT_NE(run("near", {"--in-process"}), expected) << "percepts that come later must change the run";
  Process process = start("many", with({"--pace", "1x"}));  // time enough for four kills on a busy computer, too
  RunTicks ticks(process);
  for (const std::string victim : {"perception", "planner", "report", "guidance"}) {
    const pid_t pid = running(victim);
    ASSERT_GT(pid, 0) << process.output();
    ASSERT_TRUE(ticks.pass(30)) << process.output();
    ::kill(pid, SIGKILL);
  }
  EXPECT_EQ(hash_of("many", process), expected);
}

TEST_F(Determinism, AnotherSeedGivesAnotherHashAndDiffNamesTheFirstDifference) {
  limit_sim_time(1.0);
  EXPECT_NE(run("one", {"--in-process", "--seed", "1"}), run("two", {"--in-process", "--seed", "2"}));
  Process diff({program("constrictor"), "diff", (dir_ / "one").string(), (dir_ / "two").string()});
  EXPECT_EQ(diff.wait(20s), 1);
  EXPECT_NE(diff.output().find("first difference: tick 0, component physics"), std::string::npos) << diff.output();
}

TEST_F(Determinism, OneUlpInOneCommandChangesTheHash) {
  limit_sim_time(5.0);
  write_manifest("nudged.yaml", {{"control", "    program: nudged_control\n"}});
  const std::string expected = run("plain");
  const std::string nudged =
      run("nudged", {"--manifest", (dir_ / "nudged.yaml").string()}, {{"CONSTRICTOR_NUDGE_TICK", "200"}});
  EXPECT_NE(nudged, expected);
  Process diff({program("constrictor"), "diff", (dir_ / "plain").string(), (dir_ / "nudged").string()});
  EXPECT_EQ(diff.wait(20s), 1);
  EXPECT_NE(diff.output().find("tick 200, component control"), std::string::npos) << diff.output();
}

// The delays are random: a kill may find any process in any state, also while it joins.
TEST_F(Determinism, KilledMembersDoNotChangeTheHash) {
  const std::string expected = run("reference");
  PrintedRandom random;
  Process process =
      start("killed", {"--manifest", "case_study_live", "--pace", "2x"});  // slow: to kill each member once
  ASSERT_GT(running("report"), 0);
  int kills = 0;
  for (const auto& victim : kRestartableLive) {
    std::this_thread::sleep_for(std::chrono::milliseconds(150 + random() % 250));
    const pid_t pid = running(victim);
    if (pid > 0 && process.running()) {
      ::kill(pid, SIGKILL);
      ++kills;
    }
  }
  EXPECT_EQ(hash_of("killed", process), expected);
  EXPECT_GE(kills, 7);
}

TEST_F(Determinism, AProcessOfSeveralMembersKilledTenTimesDoesNotChangeTheHash) {
  const std::string expected = run("reference");
  const std::string victim = "navigation,control,input,planner";
  Process process = start("killed", {"--pace", "1x", "--group", victim, "--group", "camera,perception,report"});
  RunTicks ticks(process);
  const auto hellos = dds::Reader<msg::Hello>::member(ticks.participant(), barrier_topics::kHello);
  std::uint32_t announced = 0;
  int kills = 0;
  for (pid_t dead = -1; kills < 10; ++kills) {
    const pid_t pid = running(victim, dead);
    ASSERT_GT(pid, 0) << process.output();
    const auto joins = [&] {
      hellos.take([&](const msg::Hello& hello) {
        if (hello.component == std::string_view("control")) announced = std::max(announced, hello.incarnation);
      });
      return announced > static_cast<std::uint32_t>(kills);
    };
    // Before, while and after it joins.
    if (kills >= 3 && kills < 6) {
      ASSERT_TRUE(eventually(joins)) << "incarnation " << announced << ": " << process.output();
    } else if (kills >= 6) {
      ASSERT_TRUE(ticks.pass(10 * (kills - 5))) << process.output();
    }
    if (!process.running()) break;
    ::kill(dead = pid, SIGKILL);
  }
  EXPECT_EQ(hash_of("killed", process), expected) << process.output();
  EXPECT_GE(kills, 8);
}

TEST_F(Determinism, EachProcessStoppedInTurnUntilTheRunStandsDoesNotChangeTheHash) {
  const std::string expected = run("reference");
  EXPECT_EQ(run_with_stops("physics", 0s), expected);
}

TEST_F(Determinism, ARunThatWasResetPausedAndSteppedEqualsANewRunWithThatSeed) {
  limit_sim_time(6.0);
  const std::map<std::string, std::string> registry = {
      {"XDG_RUNTIME_DIR", dir_.string()}};  // a registry in which this run is the only one
  const std::string expected = run("fresh", {"--in-process", "--seed", "5"});
  Process launcher = start("reset", {"--pace", "1x", "--seed", "3"}, registry);
  ASSERT_TRUE(launcher.wait_for("simulated", 30s)) << launcher.output() << launcher.errors();
  for (const std::vector<std::string>& words : {std::vector<std::string>{"reset", "5"},
                                                {"pause"},
                                                {"step"},
                                                {"step", "25"},
                                                {"pace", "lockstep"},
                                                {"resume"}}) {
    std::vector<std::string> arguments = {program("constrictor")};
    arguments.insert(arguments.end(), words.begin(), words.end());
    Process command(arguments, registry);
    ASSERT_EQ(command.wait(30s), exit_status::kOk) << command.output() << command.errors();
  }
  EXPECT_EQ(hash_of("reset", launcher), expected);
  // The reset also restarted what the report collects, and the hash logs that `diff` compares.
  const nlohmann::json fresh = report("fresh"), reset = report("reset");
  for (const char* key : {"seed", "ticks", "events", "states", "objects", "line", "pose_error"})
    EXPECT_EQ(reset[key], fresh[key]) << key;
  Process diff({program("constrictor"), "diff", (dir_ / "fresh").string(), (dir_ / "reset").string()});
  EXPECT_EQ(diff.wait(20s), 0) << diff.output();
}

// The camera is rendering in a thread of its own at almost any moment of a run in one process.
TEST_F(Determinism, AResetOfARunInOneProcessGivesANewRunWithThatSeed) {
  limit_sim_time(6.0);
  const std::map<std::string, std::string> registry = {{"XDG_RUNTIME_DIR", dir_.string()}};
  const std::string expected = run("fresh", {"--in-process", "--seed", "5"});
  Process launcher = start("reset", {"--in-process", "--pace", "1x", "--seed", "3"}, registry);
  ASSERT_TRUE(launcher.wait_for("simulated", 30s)) << launcher.output() << launcher.errors();
  for (const auto& [word, value] : {std::pair{"reset", "4"}, {"reset", "5"}, {"pace", "lockstep"}}) {
    Process command({program("constrictor"), word, value}, registry);
    ASSERT_EQ(command.wait(30s), exit_status::kOk) << command.output() << command.errors();
  }
  EXPECT_EQ(hash_of("reset", launcher), expected);
}

// Members take no step in the final tick. Therefore the launcher's limit must be one tick later than the report's
// limit, so that both end the run after the same step.
TEST_F(Determinism, TheLaunchersTimeLimitGivesTheSameReportAsTheReportsOwnLimit) {
  run("own", {"--in-process"});
  for (const std::vector<std::string>& spread : {std::vector<std::string>{"--in-process"}, {}}) {
    limit_sim_time(900.0);
    std::vector<std::string> more = {"--max-sim-time", std::to_string(kSimTime_s + 0.02)};
    more.insert(more.end(), spread.begin(), spread.end());
    run("limited", more);
    const nlohmann::json own = report("own"), limited = report("limited");
    ASSERT_TRUE(own["events"].is_array() && !own["events"].empty());
    for (const char* key :
         {"success", "mission", "ticks", "state_hash", "events", "states", "objects", "line", "pose_error"}) {
      EXPECT_EQ(limited[key], own[key]) << key;
    }
    EXPECT_TRUE(fs::exists(dir_ / "limited/figure.png"));
  }
}

}  // namespace
}  // namespace constrictor::testing
