// The report is killed while it draws the figure after the end of a run, and is restarted: it writes the same files.
#include <set>

#include "integration/determinism_run.hpp"

namespace constrictor::testing {
namespace {

using namespace std::chrono_literals;
namespace fs = std::filesystem;

class ReportRestart : public DeterminismRun {
 protected:
  ReportRestart() : DeterminismRun("short", 120s) {}

  /// Whether the report of this run has drawn a picture of the scene, but not all of its files.
  [[nodiscard]] bool draws(const std::string& name) const {
    if (fs::exists(dir_ / name / "mission.json") || !fs::exists(dir_ / name / "snapshots")) return false;
    for (const auto& entry : fs::directory_iterator(dir_ / name / "snapshots")) {
      if (entry.path().string().ends_with("_scene.png")) return true;
    }
    return false;
  }
  /// Runs 3 s of the mission, kills the process that hosts `victim` while the report draws, and compares all files with
  /// those of a run that was not disturbed.
  void kill_while_it_draws(const std::string& victim, const std::vector<std::string>& more) {
    std::vector<std::string> arguments = {"--max-sim-time", "3"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    const std::string expected = run("reference", arguments);
    Process process = start("killed", arguments);
    const pid_t pid = running(victim);
    ASSERT_GT(pid, 0) << process.output();
    ASSERT_TRUE(eventually([&] { return draws("killed"); }, 60s, 1ms)) << process.output();
    ::kill(pid, SIGKILL);
    EXPECT_EQ(hash_of("killed", process), expected) << process.output() << process.errors();
    EXPECT_NE(process.output().find("was killed by signal 9 (Killed); restarted as incarnation 2"), std::string::npos)
        << "it must have been killed before it had finished: " << process.output();
    std::set<std::string> names = {"mission.json", "figure.png", "joint_torques.csv", "events.jsonl", "states.jsonl"};
    for (const auto& entry : fs::directory_iterator(dir_ / "reference" / "snapshots"))
      names.insert("snapshots/" + entry.path().filename().string());
    EXPECT_GE(names.size(), 5u + 6u) << "three pictures of each of two moments";
    auto files = folder_.contents();
    for (const auto& name : names) {
      EXPECT_FALSE(files["reference/" + name].empty()) << name;
      EXPECT_TRUE(files["killed/" + name] == files["reference/" + name]) << name;
    }
  }
};

TEST_F(ReportRestart, AReportThatIsKilledWhileItDrawsWritesTheSameFiles) { kill_while_it_draws("report", {}); }

TEST_F(ReportRestart, TheSameHoldsIfThePlantIsInItsProcess) {
  kill_while_it_draws("physics,guidance,navigation,control,input,planner,report", {"--manifest", "case_study_fast"});
}

}  // namespace
}  // namespace constrictor::testing
