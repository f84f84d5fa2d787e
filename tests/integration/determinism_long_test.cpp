// The whole case study. The state hash does not depend on the grouping of components into processes, on the pace, the
// load, stops, kills or a reset. It does depend on the seed, and on one ulp in one command.
#include <cstdlib>

#include "integration/determinism_run.hpp"

namespace constrictor::testing {
namespace {

using namespace std::chrono_literals;
namespace fs = std::filesystem;

class WholeCaseStudy : public DeterminismRun {
 protected:
  WholeCaseStudy() : DeterminismRun("case_study", 900s) {}

  /// The hash with which all tests compare: of a run with each component in a process of its own. The first call makes
  /// this run.
  const std::string& reference() {
    static const std::string hash = [this] {
      Process process = start("reference");
      std::string found = hash_of("reference", process);
      reference_ticks_ = report("reference")["ticks"];
      EXPECT_TRUE(report("reference")["success"]) << report("reference")["objects"];
      std::printf("reference: %s, %d ticks, %.1f s of wall time\n", found.c_str(),
                  report("reference")["ticks"].get<int>(), report("reference")["wall_time_s"].get<double>());
      return found;
    }();
    return hash;
  }
  /// Number of ticks of that run.
  int reference_ticks() {
    reference();
    return reference_ticks_;
  }
  /// Sum of the restarts of all processes in the report of a run.
  [[nodiscard]] int restarts(const std::string& name) const {
    int sum = 0;
    const nlohmann::json json = report(name);
    for (const auto& process : json["processes"]) sum += process["restarts"].get<int>();
    return sum;
  }

 private:
  static inline int reference_ticks_ = 0;
};

TEST_F(WholeCaseStudy, SameHashInASecondRun) { EXPECT_EQ(run("again"), reference()); }

TEST_F(WholeCaseStudy, SameHashInOneProcess) { EXPECT_EQ(run("one", {"--in-process"}), reference()); }

TEST_F(WholeCaseStudy, SameHashInTwoGroupings) {
  EXPECT_EQ(run("two", {"--group", "physics,control,navigation"}), reference());
  EXPECT_EQ(run("three", {"--manifest", "case_study_live", "--group", "camera,perception,guidance", "--group",
                          "planner,input,report,overview"}),
            reference());
}

TEST_F(WholeCaseStudy, SameHashAtTwiceRealTime) { EXPECT_EQ(run("capped", {"--pace", "2x"}), reference()); }

TEST_F(WholeCaseStudy, SameHashWhenOtherProcessesLoadBothCores) {
  const std::vector<std::string> spin = {"/bin/sh", "-c", "while :; do :; done"};
  Process first(spin), second(spin);
  EXPECT_EQ(run("loaded"), reference());
  EXPECT_TRUE(first.running() && second.running());
}

TEST_F(WholeCaseStudy, SameHashWithCpuFeaturesMaskedForOneProcess) {
  write_manifest(
      "masked.yaml",
      {{"guidance",
        "    environment: ['GLIBC_TUNABLES=glibc.cpu.hwcaps=-FMA,-FMA4,-AVX2,-AVX,-AVX512F,-SSE4_2,-ERMS']\n"}});
  EXPECT_EQ(run("masked", {"--manifest", (dir_ / "masked.yaml").string()}), reference());
}

TEST_F(WholeCaseStudy, SameHashWhenEachProcessIsStoppedInTurnOneOfThemForFifteenSeconds) {
  EXPECT_EQ(run_with_stops("perception", 15s), reference());
}

// Each kill happens between the member's first output of a tick and its TickDone. The ticks are random.
TEST_F(WholeCaseStudy, SameHashWhenEachMemberIsKilledAtTwentyTicks) {
  constexpr int kDeaths = 20;
  const std::string expected = reference();
  const auto last_tick = static_cast<unsigned>(reference_ticks() - 10);
  PrintedRandom random;
  fs::create_directory(dir_ / "deaths");
  std::map<std::string, std::string> lines;
  for (const auto& member : kRestartableLive) {
    std::set<int> ticks;
    while (ticks.size() < kDeaths) ticks.insert(10 + static_cast<int>(random() % (last_tick - 10)));
    std::string list;
    for (const int tick : ticks) list += (list.empty() ? "" : ",") + std::to_string(tick);
    lines[member] = "    program: mortal_host\n    environment: ['CONSTRICTOR_DEATHS=" + list +
                    "', 'CONSTRICTOR_DEATHS_DIR=" + (dir_ / "deaths").string() + "']\n";
  }
  write_manifest("mortal.yaml", lines, "case_study_live");
  EXPECT_EQ(run("killed", {"--manifest", (dir_ / "mortal.yaml").string()}), expected);
  EXPECT_EQ(restarts("killed"), kDeaths * static_cast<int>(kRestartableLive.size()));
}

// The plant, which is also the conductor, is one of them. The moments are random.
TEST_F(WholeCaseStudy, SameHashWhenAnyProcessIsKilledAtRandomMoments) {
  const std::string expected = reference();
  PrintedRandom random;
  std::vector<std::string> all = kRestartable;
  all.emplace_back("physics");
  Process launcher = start("shot");
  std::map<std::string, int> kills;
  for (int i = 0; i < 60 && launcher.running(); ++i) {
    std::this_thread::sleep_for(std::chrono::milliseconds(random() % 1500));
    const std::string& victim = i % 3 == 0 ? all.back() : all[random() % all.size()];
    const pid_t pid = pid_of(victim);
    if (pid <= 0) continue;
    ::kill(pid, SIGKILL);
    ++kills[victim];
  }
  EXPECT_EQ(hash_of("shot", launcher), expected);
  EXPECT_GE(kills["physics"], 5);
  EXPECT_GE(restarts("shot"), 15);
}

TEST_F(WholeCaseStudy, SameHashWhenTheProcessWithAllMembersIsKilledAtRandomMoments) {
  const std::string expected = reference();
  PrintedRandom random;
  // Without this pace, the run may be over after three kills. It takes 25 s.
  Process launcher = start("all", {"--in-process", "--pace", "6x"});
  for (int i = 0; i < 10 && launcher.running(); ++i) {
    std::this_thread::sleep_for(std::chrono::milliseconds(500 + random() % 3000));
    for (const auto& [pid, line] : command_lines()) {
      if (line.find("--incarnation") != std::string::npos && line.find((dir_ / "all").string()) != std::string::npos)
        ::kill(pid, SIGKILL);
    }
  }
  EXPECT_EQ(hash_of("all", launcher), expected);
  EXPECT_GE(restarts("all"), 5);
}

TEST_F(WholeCaseStudy, SameHashWhenTheLauncherIsKilledAndTheRunIsResumed) {
  const std::string expected = reference();
  PrintedRandom random;
  // Without this pace, the run may be over when the launcher is killed, and then nothing is left to continue.
  auto launcher = std::make_unique<Process>(start("left", {"--pace", "4x"}));
  for (int kills = 0; kills < 6; ++kills) {  // in at most 30 s of wall time; the run takes 37 s
    ASSERT_TRUE(eventually([&] { return fs::exists(dir_ / "left" / "run.json"); }));
    std::this_thread::sleep_for(std::chrono::milliseconds(1000 + random() % 4000));
    launcher->signal(SIGKILL);
    ASSERT_TRUE(launcher->wait(20s));
    launcher = std::make_unique<Process>(
        std::vector<std::string>{program("constrictor"), "run", "--resume", (dir_ / "left").string()});
  }
  EXPECT_EQ(hash_of("left", *launcher), expected);
}

TEST_F(WholeCaseStudy, SameHashAfterAResetFromAnotherSeed) {
  const std::map<std::string, std::string> registry = {
      {"XDG_RUNTIME_DIR", dir_.string()}};  // a registry in which this run is the only one
  Process launcher = start("reset", {"--seed", "2"}, registry);
  ASSERT_TRUE(launcher.wait_for("simulated", 60s)) << launcher.output() << launcher.errors();
  Process reset({program("constrictor"), "reset", "1"}, registry);
  ASSERT_EQ(reset.wait(60s), exit_status::kOk) << reset.output() << reset.errors();
  EXPECT_EQ(hash_of("reset", launcher), reference());
}

TEST_F(WholeCaseStudy, AnotherSeedAndOneUlpAtTickThousandGiveOtherHashes) {
  EXPECT_NE(run("other", {"--in-process", "--seed", "2"}), reference());
  write_manifest("nudged.yaml", {{"control", "    program: nudged_control\n"}});
  const std::map<std::string, std::string> at = {{"CONSTRICTOR_NUDGE_TICK", "1000"}};
  limit_sim_time(40.0);
  const std::string nudged = run("nudged", {"--manifest", (dir_ / "nudged.yaml").string()}, at);
  const std::string plain = run("plain");
  EXPECT_NE(nudged, plain);
  Process diff({program("constrictor"), "diff", (dir_ / "plain").string(), (dir_ / "nudged").string()});
  EXPECT_EQ(diff.wait(60s), 1);
  EXPECT_NE(diff.output().find("tick 1000, component control"), std::string::npos) << diff.output();
}

}  // namespace
}  // namespace constrictor::testing
