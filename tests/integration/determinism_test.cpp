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
    const auto report = nlohmann::json::parse(std::ifstream(dir_ / name / "report.json"), nullptr, false);
    if (!report.contains("state_hash")) {
      ADD_FAILURE() << name << ": no state hash in the report";
      return "none of " + name;
    }
    return report["state_hash"];
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

TEST_F(Determinism, AStoppedProcessLeavesNoTrace) {
  const std::string expected = run("reference");
  for (const std::string stopped : {"physics", "perception"}) {
    Process process = start("stopped_" + stopped);
    const pid_t pid = running(stopped);
    ASSERT_GT(pid, 0);
    std::this_thread::sleep_for(1s);
    ::kill(pid, SIGSTOP);
    std::this_thread::sleep_for(2s);
    ::kill(pid, SIGCONT);
    EXPECT_EQ(hash_of("stopped_" + stopped, process), expected);
  }
}

}  // namespace
}  // namespace constrictor::testing
