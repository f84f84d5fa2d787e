// Runs with injected faults (`run --faults`): the same in every distribution over processes, and survived by every
// component.
#include <fmt/format.h>

#include "constrictor/topics.hpp"
#include "integration/determinism_run.hpp"

namespace constrictor::testing {
namespace {

using namespace std::chrono_literals;

class FaultInjection : public DeterminismRun {
 protected:
  FaultInjection() : DeterminismRun("short", 120s) { limit_sim_time(8.0); }
  [[nodiscard]] std::string file(const std::string& name, const std::string& text) const {
    std::ofstream(dir_ / name) << text;
    return (dir_ / name).string();
  }
};

TEST_F(FaultInjection, FaultsOfTopicsAreTheSameInEveryDistributionAndThoseOfProcessesChangeNothing) {
  const std::string topics =
      "seed: 3\nfaults:\n"
      "  - {topic: camera/image, kind: drop, probability: 0.3}\n"
      "  - {topic: joint_command, kind: delay, delay_ticks: 2, probability: 0.2, from_s: 2}\n"
      "  - {topic: imu_state, kind: bias, field: angular_velocity_rad_s.z, amount: 0.05}\n"
      "  - {topic: joint_state, kind: freeze, from_s: 4, until_s: 4.2}\n"
      "  - {topic: perception/line, kind: corrupt, probability: 0.2}\n";
  const std::string processes =
      "  - {process: perception, kind: kill, at_s: 2}\n"
      "  - {process: guidance, kind: kill, at_s: 4}\n"
      "  - {process: control, kind: stop, at_s: 3, for_s: 0.5}\n"
      "  - {process: camera, kind: slow, step_ms: 5, from_s: 5, until_s: 6}\n";
  const std::string expected = run("one", {"--in-process", "--faults", file("topics.yaml", topics)});
  EXPECT_NE(run("none", {"--in-process"}), expected);
  Process process = start("many", {"--pace", "3x", "--faults", file("all.yaml", topics + processes)});
  EXPECT_EQ(hash_of("many", process), expected);
  for (const char* line : {"fault: kill of perception begins at 2.0 s", "fault: stop of control begins at 3.0 s",
                           "fault: freeze of joint_state ends at 4.2 s", "fault: slow of camera begins at 5.0 s"})
    EXPECT_NE(process.output().find(line), std::string::npos) << line << "\n" << process.output();
  int restarts = 0;
  const nlohmann::json many = report("many");
  for (const auto& each : many["processes"]) restarts += each["restarts"].get<int>();
  EXPECT_EQ(restarts, 2);
  EXPECT_TRUE(std::filesystem::exists(dir_ / "many" / "faults.yaml"))
      << "the report must contain the faults of the run";
  EXPECT_FALSE(std::filesystem::exists(dir_ / "none" / "faults.yaml"));
}

TEST_F(FaultInjection, NoComponentFailsWhateverIsLostLateFrozenOrDamaged) {
  for (const char* kind : {"kind: drop", "kind: drop, probability: 0.5", "kind: delay, delay_ticks: 7", "kind: freeze",
                           "kind: corrupt, probability: 0.5", "kind: duplicate"}) {
    std::string faults = "faults:\n";
    for (const auto& topic : topics::kInfos) faults += fmt::format("  - {{topic: {}, {}}}\n", topic.name, kind);
    Process process = start("out", {"--in-process", "--faults", file("faults.yaml", faults), "--max-sim-time", "6"});
    EXPECT_EQ(process.wait(60s), exit_status::kFailed) << kind << process.output() << process.errors();
    EXPECT_EQ(report("out").value("error", ""), "") << kind;
    // Damaged events may look like the end of the mission.
    EXPECT_GT(report("out").value("sim_time_s", 0.0), 4.0) << kind;
  }
}

TEST_F(FaultInjection, AWrongFileIsRefusedBeforeAnythingStarts) {
  Process process = start("out", {"--faults", file("faults.yaml", "faults:\n  - {topic: camera/imgae, kind: drop}\n")});
  EXPECT_EQ(process.wait(30s), exit_status::kConfiguration);
  EXPECT_NE(process.errors().find("faults.yaml:2: faults[0].topic: found camera/imgae"), std::string::npos)
      << process.errors();
  EXPECT_NE(process.errors().find("did you mean 'camera/image'?"), std::string::npos) << process.errors();
  EXPECT_FALSE(std::filesystem::exists(dir_ / "out"));
}

}  // namespace
}  // namespace constrictor::testing
