// The real components in a real mission, cut short: the same state hash however they are spread, stopped, killed or paced; another
// one for another seed and for one ulp in one command.
#include <gtest/gtest.h>
#include <signal.h>

#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <random>
#include <thread>

#include "runtime/host.hpp"
#include "support/process.hpp"

namespace constrictor::testing {
namespace {

namespace fs = std::filesystem;
using namespace std::chrono_literals;

const std::vector<std::string> kRestartable = {"camera", "overview", "perception", "guidance", "navigation",
                                               "control", "input", "planner", "report"};

class Determinism : public ::testing::Test {
 protected:
  Determinism() {
    std::string pattern = (fs::temp_directory_path() / "constrictor-determinism-XXXXXX").string();
    dir_ = ::mkdtemp(pattern.data());
    std::ofstream(dir_ / "report.yaml") << "max_sim_time_s: " << kSimTime_s
                                        << "\nsettle_s: 1.0\ntorque_decimation_ticks: 5\ntorque_window_s: 30\n";
  }
  ~Determinism() override { fs::remove_all(dir_); }

  [[nodiscard]] Process start(const std::string& name, std::vector<std::string> more = {},
                              const std::map<std::string, std::string>& environment = {}) const {
    std::vector<std::string> arguments = {program("constrictor"), "run",      "short",
                                          "--report",             (dir_ / name).string(), "--config",
                                          "report=" + (dir_ / "report.yaml").string()};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return Process(std::move(arguments), environment);
  }
  /// The state hash of a run that has ended; a run that was cut short by time is a mission without success.
  [[nodiscard]] std::string hash_of(const std::string& name, Process& process) const {
    const auto status = process.wait(120s);
    EXPECT_TRUE(status == exit_status::kOk || status == exit_status::kMissionFailed)
        << name << " ended with " << status.value_or(-1) << ": " << process.output() << process.errors();
    const nlohmann::json told = report(name);
    if (!told.contains("state_hash") || !told["state_hash"].is_string()) {
      ADD_FAILURE() << name << ": no state hash in the report";
      return "none of " + name;
    }
    return told["state_hash"];
  }
  [[nodiscard]] nlohmann::json report(const std::string& name) const {
    return nlohmann::json::parse(std::ifstream(dir_ / name / "report.json"), nullptr, false);
  }
  [[nodiscard]] std::string run(const std::string& name, std::vector<std::string> more = {},
                                const std::map<std::string, std::string>& environment = {}) const {
    Process process = start(name, std::move(more), environment);
    return hash_of(name, process);
  }
  /// The case study's manifest with one more line for one of its processes.
  void write_manifest(const std::string& name, const std::string& component, const std::string& line) const {
    std::ifstream file(std::string(CONSTRICTOR_SOURCE_DIR) + "/deploy/case_study.yaml");
    std::string text{std::istreambuf_iterator<char>(file), {}};
    const std::string plain = "components: [" + component + "]\n";
    ASSERT_NE(text.find(plain), std::string::npos);
    std::ofstream(dir_ / name) << text.replace(text.find(plain), plain.size(), plain + "    " + line + "\n");
  }
  /// Pid of the process of this test's run whose program is `name`; -1 if there is none.
  [[nodiscard]] pid_t pid_of(const std::string& name) const {
    for (const auto& entry : fs::directory_iterator("/proc")) {
      const std::string pid = entry.path().filename();
      if (pid.find_first_not_of("0123456789") != std::string::npos) continue;
      std::ifstream file(entry.path() / "cmdline");
      const std::string line{std::istreambuf_iterator<char>(file), {}};
      const std::string executable = fs::path(line.substr(0, line.find('\0'))).filename();
      if (executable == name && line.find(dir_.string()) != std::string::npos) return std::stoi(pid);
    }
    return -1;
  }
  /// Waits until `name` runs.
  [[nodiscard]] pid_t running(const std::string& name) const {
    for (int i = 0; i < 5000; ++i) {
      if (const pid_t pid = pid_of(name); pid > 0) return pid;
      std::this_thread::sleep_for(1ms);
    }
    return -1;
  }

  static constexpr double kSimTime_s = 12.0;
  fs::path dir_;
};

TEST_F(Determinism, SameHashForAnyGroupingAndPace) {
  const std::string expected = run("reference");
  EXPECT_EQ(run("again"), expected);
  EXPECT_EQ(run("one", {"--in-process"}), expected);
  EXPECT_EQ(run("two", {"--group", "physics,control,navigation"}), expected);
  EXPECT_EQ(run("three", {"--group", "camera,perception,guidance", "--group", "planner,input,report,overview"}), expected);
  EXPECT_EQ(run("capped", {"--pace", "2x"}), expected);
  // Guidance, which computes much, without what the others use of the CPU, as on an older host.
  write_manifest("masked.yaml", "guidance", "environment: ['GLIBC_TUNABLES=glibc.cpu.hwcaps=-FMA,-FMA4,-AVX2,-AVX,-AVX512F,-SSE4_2,-ERMS']");
  EXPECT_EQ(run("masked", {"--manifest", (dir_ / "masked.yaml").string()}), expected);
}

TEST_F(Determinism, AnotherSeedIsAnotherRunAndDiffNamesWhereTheyPart) {
  EXPECT_NE(run("one", {"--in-process", "--seed", "1"}), run("two", {"--in-process", "--seed", "2"}));
  Process diff({program("constrictor"), "diff", (dir_ / "one").string(), (dir_ / "two").string()});
  EXPECT_EQ(diff.wait(20s), 1);
  EXPECT_NE(diff.output().find("first difference: tick 0, component physics"), std::string::npos) << diff.output();
}

TEST_F(Determinism, OneUlpInOneCommandChangesTheHash) {
  write_manifest("nudged.yaml", "control", "program: nudged_control");
  const std::string expected = run("plain");
  const std::string nudged = run("nudged", {"--manifest", (dir_ / "nudged.yaml").string()}, {{"CONSTRICTOR_NUDGE_TICK", "200"}});
  EXPECT_NE(nudged, expected);
  Process diff({program("constrictor"), "diff", (dir_ / "plain").string(), (dir_ / "nudged").string()});
  EXPECT_EQ(diff.wait(20s), 1);
  EXPECT_NE(diff.output().find("tick 200, component control"), std::string::npos) << diff.output();
}

TEST_F(Determinism, KilledMembersLeaveNoTrace) {
  const std::string expected = run("reference");
  std::mt19937 random;
  const auto seed = std::random_device{}();
  SCOPED_TRACE("seed " + std::to_string(seed));
  random.seed(seed);
  Process process = start("killed", {"--pace", "2x"});  // time enough for one kill each
  ASSERT_GT(running("report"), 0);
  int kills = 0;
  for (const auto& victim : kRestartable) {
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

TEST_F(Determinism, EachProcessStoppedForTwoSecondsInTurnLeavesNoTrace) {
  const std::string expected = run("reference");
  Process launcher = start("stopped", {"--pace", "2x"});
  ASSERT_GT(running("report"), 0);
  std::vector<std::string> all = kRestartable;
  all.insert(all.begin(), "physics");
  for (const auto& name : all) {
    std::this_thread::sleep_for(200ms);
    const pid_t pid = running(name);
    ASSERT_GT(pid, 0) << name << ": " << launcher.output();
    ::kill(pid, SIGSTOP);
    std::this_thread::sleep_for(2s);
    ASSERT_TRUE(launcher.running()) << "over before " << name << " was stopped";
    ::kill(pid, SIGCONT);
  }
  launcher.signal(SIGSTOP);  // last: nobody waits for it, the run goes on
  std::this_thread::sleep_for(2s);
  launcher.signal(SIGCONT);
  EXPECT_EQ(hash_of("stopped", launcher), expected);
}

TEST_F(Determinism, ARunThatWasResetOnItsWayEqualsAFreshOneOfThatSeed) {
  const std::map<std::string, std::string> registry = {{"XDG_RUNTIME_DIR", dir_.string()}};  // in which this run is the only one
  const std::string expected = run("fresh", {"--in-process", "--seed", "5"});
  Process launcher = start("reset", {"--pace", "2x", "--seed", "3"}, registry);
  ASSERT_TRUE(launcher.wait_for("simulated", 30s)) << launcher.output() << launcher.errors();
  for (const std::vector<std::string>& words : {std::vector<std::string>{"reset", "5"}, {"pace", "lockstep"}}) {
    std::vector<std::string> arguments = {program("constrictor")};
    arguments.insert(arguments.end(), words.begin(), words.end());
    Process command(arguments, registry);
    ASSERT_EQ(command.wait(30s), exit_status::kOk) << command.output() << command.errors();
  }
  EXPECT_EQ(hash_of("reset", launcher), expected);
  // Members, journals and pictures began anew too.
  const nlohmann::json fresh = report("fresh"), reset = report("reset");
  for (const char* key : {"seed", "ticks", "events", "states", "objects", "line", "pose_error"}) EXPECT_EQ(reset[key], fresh[key]) << key;
  Process diff({program("constrictor"), "diff", (dir_ / "fresh").string(), (dir_ / "reset").string()});
  EXPECT_EQ(diff.wait(20s), 0) << diff.output();
}

// The final tick is not stepped: one tick later than the report's own limit ends the run after the same step.
TEST_F(Determinism, ARunEndedByTheLaunchersLimitIsToldLikeOneEndedByTheReportsOwn) {
  run("own", {"--in-process"});
  for (const std::vector<std::string>& spread : {std::vector<std::string>{"--in-process"}, {}}) {
    std::ofstream(dir_ / "report.yaml") << "max_sim_time_s: 900\nsettle_s: 1.0\ntorque_decimation_ticks: 5\ntorque_window_s: 30\n";
    std::vector<std::string> more = {"--max-sim-time", std::to_string(kSimTime_s + 0.02)};
    more.insert(more.end(), spread.begin(), spread.end());
    run("limited", more);
    const nlohmann::json own = report("own"), limited = report("limited");
    ASSERT_TRUE(own["events"].is_array() && !own["events"].empty());
    for (const char* key : {"success", "mission", "ticks", "state_hash", "events", "states", "objects", "line", "pose_error"}) {
      EXPECT_EQ(limited[key], own[key]) << key;
    }
    EXPECT_TRUE(fs::exists(dir_ / "limited/figure.png"));
  }
}

}  // namespace
}  // namespace constrictor::testing
