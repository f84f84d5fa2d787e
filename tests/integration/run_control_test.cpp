// Pause, resume, step, pace and reset from the command line: a run's time is steered, its result is not.
#include <csignal>

#include "integration/cli_fixture.hpp"
#include "runtime/host.hpp"

namespace constrictor::testing {
namespace {

using namespace std::chrono_literals;
namespace fs = std::filesystem;

constexpr const char* kToys =
    "plant: physics\nrobot: components/robot/mamba.yaml\nscenario: sim/scenarios/case_study.yaml\npatience_s: 4\nprocesses:\n"
    "  - {components: [physics], program: toy_host}\n  - {components: [navigation, control], program: toy_host}\n"
    "  - {components: [planner, report], program: toy_host}\n";

class RunControl : public CliFixture {
 protected:
  RunControl() { write("toys.yaml", kToys); }
  [[nodiscard]] Process run(long ticks, const std::string& name, std::vector<std::string> more = {}) const {
    const std::string scenario = std::to_string(ticks) + "_ticks.yaml";
    write(scenario, "");
    std::vector<std::string> arguments = {"run", (dir_ / scenario).string(), "--manifest", (dir_ / "toys.yaml").string(), "--report", (dir_ / name).string()};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return start(arguments);
  }
  /// Tick that a paused run says comes next; -1 if it said none.
  [[nodiscard]] long next_tick() const {
    const auto at = output_.find("next tick ");
    return at == std::string::npos ? -1 : std::stol(output_.substr(at + 10));
  }
  [[nodiscard]] std::string hash(const std::string& name) const { return report(name).value("state_hash", "none"); }
};

TEST_F(RunControl, APausedAndSteppedRunHasTheSameHash) {
  ASSERT_EQ(run(600, "reference", {"--in-process"}).wait(30s), exit_status::kOk);
  Process launcher = run(600, "paused", {"--pace", "2x"});
  ASSERT_TRUE(launcher.wait_for("simulated", 20s)) << launcher.output();
  ASSERT_EQ(command({"pause"}), exit_status::kOk) << output_;
  const long paused = next_tick();
  ASSERT_GT(paused, 0) << output_;
  ASSERT_EQ(command({"step"}), exit_status::kOk) << output_;
  EXPECT_EQ(next_tick(), paused + 1);
  ASSERT_EQ(command({"step", "25"}), exit_status::kOk) << output_;
  EXPECT_EQ(next_tick(), paused + 26);
  std::this_thread::sleep_for(5s);  // longer than anybody's patience with a peer
  EXPECT_EQ(command({"step"}), exit_status::kOk) << output_;
  EXPECT_EQ(next_tick(), paused + 27) << "time stood still meanwhile";
  ASSERT_EQ(command({"pace", "lockstep"}), exit_status::kOk) << output_;
  ASSERT_EQ(command({"resume"}), exit_status::kOk) << output_;
  ASSERT_EQ(launcher.wait(30s), exit_status::kOk) << launcher.output() << launcher.errors();
  EXPECT_EQ(hash("paused"), hash("reference"));
}

TEST_F(RunControl, ARunThatWasResetEqualsAFreshOneOfThatSeed) {
  ASSERT_EQ(run(400, "fresh", {"--in-process", "--seed", "5"}).wait(30s), exit_status::kOk);
  Process launcher = run(400, "reset", {"--pace", "1x"});
  ASSERT_TRUE(launcher.wait_for("simulated", 20s)) << launcher.output();
  ASSERT_EQ(command({"reset", "5"}), exit_status::kOk) << output_;
  EXPECT_NE(output_.find("seed 5"), std::string::npos) << output_;
  ASSERT_EQ(command({"pace", "lockstep"}), exit_status::kOk) << output_;
  ASSERT_EQ(launcher.wait(30s), exit_status::kOk) << launcher.output() << launcher.errors();
  EXPECT_EQ(hash("reset"), hash("fresh"));
  Process diff = start({"diff", (dir_ / "fresh").string(), (dir_ / "reset").string()});
  EXPECT_EQ(diff.wait(10s), 0) << diff.output();
}

TEST_F(RunControl, AfterAResetEverybodySeesTheNewSeedAndTick) {
  Process launcher = run(100'000, "r", {"--pace", "1x"});
  ASSERT_TRUE(launcher.wait_for("simulated", 20s)) << launcher.output();
  ASSERT_EQ(command({"pause"}), exit_status::kOk) << output_;
  ASSERT_EQ(command({"step", "300"}), exit_status::kOk) << output_;
  ASSERT_EQ(command({"reset", "7"}), exit_status::kOk) << output_;
  ASSERT_EQ(command({"pause"}), exit_status::kOk) << output_;
  const long now = next_tick();
  ASSERT_LT(now, 250) << output_;
  ASSERT_EQ(command({"status", "--json"}), exit_status::kOk) << output_;
  const auto status = nlohmann::json::parse(output_, nullptr, false);
  ASSERT_TRUE(status.is_object()) << output_;
  EXPECT_EQ(status["seed"], 7);
  EXPECT_LE(status["tick"], now);
  EXPECT_TRUE(eventually([&] { return command({"status"}) == exit_status::kOk && output_.find("seed 7") != std::string::npos; })) << output_;
  EXPECT_EQ(command({"end"}), exit_status::kOk);
  EXPECT_EQ(launcher.wait(20s), 128 + SIGTERM);
  EXPECT_EQ(report("r").value("seed", 0), 7);
}

// A plant that is held up again and again, each time for less than anybody's patience.
TEST_F(RunControl, StepsMayTakeLongerThanTheBoundOnAnAnswer) {
  Process launcher = run(1'000'000, "r", {"--pace", "1x"});
  ASSERT_TRUE(launcher.wait_for("simulated", 20s)) << launcher.output();
  ASSERT_EQ(command({"pause"}), exit_status::kOk) << output_;
  const long paused = next_tick();
  ASSERT_EQ(command({"status", "--json"}), exit_status::kOk) << output_;
  const pid_t plant = nlohmann::json::parse(output_)["components"][0]["pid"];
  Process steps = start({"step", "12000"});
  for (int i = 0; i < 5; ++i) {
    std::this_thread::sleep_for(200ms);
    ::kill(plant, SIGSTOP);
    std::this_thread::sleep_for(2500ms);
    EXPECT_TRUE(steps.running()) << "else this tests nothing: " << steps.output() << steps.errors();
    ::kill(plant, SIGCONT);
  }
  EXPECT_EQ(steps.wait(100s), exit_status::kOk) << steps.errors();
  output_ = steps.output();
  EXPECT_EQ(next_tick(), paused + 12'000) << output_;
  EXPECT_EQ(command({"end"}), exit_status::kOk);
  launcher.wait(20s);
}

TEST_F(RunControl, WrongValuesAreWrongUsageWithOrWithoutARun) {
  for (const std::vector<std::string>& wrong : std::vector<std::vector<std::string>>{
           {"pace", "fast"}, {"reset", "-1"}, {"step", "-3"}, {"teleop", "--drive", "9,0"}, {"teleop", "--drive", "0.3,0", "--for", "0s"},
           {"task", "start", "nothing"}, {"task", "start", "rotate", "--direction", "up"}, {"task", "wait", "--event", "tea"},
           {"task", "wait", "--end", "--timeout", "soon"}, {"run", "--seed", "-1"}, {"run", "--pace", "fast"}, {"param", "set", "a", "b"}, {"pause", "--run", "-1"},
           {"topic", "echo", "joint_state", "--count", "-1"}}) {
    EXPECT_EQ(command(wrong), exit_status::kUsage) << wrong.front() << " " << wrong[1] << ": " << output_;
    EXPECT_NE(output_.find("accepted"), std::string::npos) << output_;
  }
}

TEST_F(RunControl, AWordThatIsNoSubcommandIsNamed) {
  EXPECT_EQ(command({"frobnicate"}), exit_status::kUsage);
  EXPECT_NE(output_.find("frobnicate"), std::string::npos) << output_;
  EXPECT_EQ(command({"task", "frobnicate"}), exit_status::kUsage);
  EXPECT_NE(output_.find("frobnicate"), std::string::npos) << output_;
}

TEST_F(RunControl, EveryHelpHasExamplesExitStatusesAndTheEnvironment) {
  for (const std::vector<std::string>& words : std::vector<std::vector<std::string>>{
           {"run"}, {"status"}, {"doctor"}, {"end"}, {"host"}, {"pause"}, {"resume"}, {"step"}, {"pace"}, {"reset"}, {"stop"}, {"clear-stop"},
           {"release"}, {"teleop"}, {"task"}, {"task", "start"}, {"task", "wait"}, {"task", "cancel"}, {"topic"}, {"node"}, {"param"}}) {
    std::vector<std::string> arguments = words;
    arguments.emplace_back("--help");
    EXPECT_EQ(command(arguments), exit_status::kOk);
    for (const char* part : {"EXAMPLES\n", "EXIT STATUS\n", "ENVIRONMENT\n", "CONSTRICTOR_DOMAIN"}) {
      EXPECT_NE(output_.find(part), std::string::npos) << words.front() << " --help lacks " << part;
    }
  }
}

TEST_F(RunControl, PaceIsObeyedAndWhatMakesNoSenseIsRefused) {
  Process launcher = run(100'000, "r", {"--pace", "1x"});
  ASSERT_TRUE(launcher.wait_for("simulated", 20s)) << launcher.output();
  EXPECT_EQ(command({"pace", "3x"}), exit_status::kOk);
  EXPECT_NE(output_.find("at most 3x"), std::string::npos) << output_;
  EXPECT_EQ(command({"pace", "-1"}), exit_status::kUsage);
  EXPECT_EQ(command({"step", "0"}), exit_status::kUsage);
  EXPECT_EQ(command({"reset", "-1"}), exit_status::kUsage) << "no 18446744073709551615";
  EXPECT_EQ(command({"stop"}), exit_status::kWaitedTooLong) << "the toys have no input member";
  EXPECT_EQ(command({"end"}), exit_status::kOk);
  EXPECT_EQ(launcher.wait(10s), 128 + SIGTERM);
  EXPECT_EQ(command({"pause"}), exit_status::kSoftware);
  EXPECT_NE(output_.find("no run on this host"), std::string::npos);
}

}  // namespace
}  // namespace constrictor::testing
