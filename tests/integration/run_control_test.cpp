// The commands pause, resume, step, pace and reset change when the ticks of a run happen, but never its result.
#include <csignal>

#include <algorithm>
#include <optional>
#include <set>

#include "cyclone/domain.hpp"
#include "cyclone/endpoint.hpp"
#include "integration/cli_fixture.hpp"
#include "runtime/host.hpp"
#include "runtime/wire.hpp"

namespace constrictor::testing {
namespace {

using namespace std::chrono_literals;
namespace fs = std::filesystem;

const std::string kToys = case_study_manifest(
    4,
    "  - {components: [physics], program: toy_host}\n  - {components: [navigation, control], program: toy_host}\n"
    "  - {components: [planner, report], program: toy_host}\n");

class RunControl : public CliFixture {
 protected:
  RunControl() { write("toys.yaml", kToys); }
  [[nodiscard]] Process run(long ticks, const std::string& name, std::vector<std::string> more = {}) const {
    const std::string scenario = std::to_string(ticks) + "_ticks.yaml";
    write(scenario, "");
    std::vector<std::string> arguments = {"run",        (dir_ / scenario).string(),
                                          "--manifest", (dir_ / "toys.yaml").string(),
                                          "--report",   (dir_ / name).string()};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return start(arguments);
  }
  /// Waits until the launcher's run is past `tick`; false if it does not get there within the bounds.
  [[nodiscard]] bool reaches(const Process& launcher, std::int64_t tick) const {
    if (!eventually([&] { return launcher.output().find("report in") != std::string::npos; })) return false;
    const dds::Domain observer(domain());
    const auto states = dds::Reader<msg::RunState>::member(observer.participant(), barrier_topics::kRunState);
    return eventually(
        [&] {
          bool there = false;
          states.take([&](const msg::RunState& state) { there |= state.tick > tick; });
          return there;
        },
        30s);
  }
  /// The next tick of the paused run, as the last command printed it; -1 if it printed none.
  [[nodiscard]] long next_tick() const {
    const auto at = output_.find("next tick ");
    return at == std::string::npos ? -1 : std::stol(output_.substr(at + 10));
  }
  /// Waits until the run has announced for longer than `time` that it is paused before the tick `next`; false if it
  /// says something else, or nothing.
  [[nodiscard]] bool stays_paused_at(std::int64_t next, std::chrono::milliseconds time) const {
    const dds::Domain observer(domain());
    const auto states = dds::Reader<msg::RunState>::member(observer.participant(), barrier_topics::kRunState);
    std::optional<std::chrono::steady_clock::time_point> first, last;
    bool paused = true;
    const bool announced = eventually([&] {
      states.take([&](const msg::RunState& state) {
        paused = paused && state.paused && state.tick == next;
        last = std::chrono::steady_clock::now();
        if (!first) first = last;
      });
      return !paused || (first && *last - *first > time);
    });
    return announced && paused;
  }
  [[nodiscard]] std::string hash(const std::string& name) const { return report(name).value("state_hash", "none"); }
};

TEST_F(RunControl, ARunThatIsPausedForLongerThanThePatienceAndSteppedHasTheSameHash) {
  std::string impatient = kToys;
  write("toys.yaml", impatient.replace(impatient.find("patience_s: 4"), 13, "patience_s: 2"));
  ASSERT_EQ(run(600, "reference", {"--in-process"}).wait(30s), exit_status::kOk);
  Process launcher = run(600, "paused", {"--pace", "1x"});
  ASSERT_TRUE(reaches(launcher, 5)) << launcher.output();
  ASSERT_EQ(command({"pause"}), exit_status::kOk) << output_;
  const long paused = next_tick();
  ASSERT_GT(paused, 0) << output_;
  ASSERT_EQ(command({"step"}), exit_status::kOk) << output_;
  EXPECT_EQ(next_tick(), paused + 1);
  ASSERT_EQ(command({"step", "25"}), exit_status::kOk) << output_;
  EXPECT_EQ(next_tick(), paused + 26);
  EXPECT_TRUE(stays_paused_at(paused + 26, 2500ms));
  EXPECT_EQ(command({"step"}), exit_status::kOk) << output_;
  EXPECT_EQ(next_tick(), paused + 27) << "the paused run did no tick on its own";
  ASSERT_EQ(command({"pace", "lockstep"}), exit_status::kOk) << output_;
  ASSERT_EQ(command({"resume"}), exit_status::kOk) << output_;
  ASSERT_EQ(launcher.wait(30s), exit_status::kOk) << launcher.output() << launcher.errors();
  EXPECT_EQ(hash("paused"), hash("reference"));
}

TEST_F(RunControl, AfterAResetTheRunHasTheSameHashAsANewRunWithThatSeed) {
  ASSERT_EQ(run(1000, "fresh", {"--in-process", "--seed", "5"}).wait(30s), exit_status::kOk);
  Process launcher = run(1000, "reset", {"--pace", "1x"});
  ASSERT_TRUE(reaches(launcher, 5)) << launcher.output();
  ASSERT_EQ(command({"reset", "5"}), exit_status::kOk) << output_;
  EXPECT_NE(output_.find("seed 5"), std::string::npos) << output_;
  ASSERT_EQ(command({"pace", "lockstep"}), exit_status::kOk) << output_;
  ASSERT_EQ(launcher.wait(30s), exit_status::kOk) << launcher.output() << launcher.errors();
  EXPECT_EQ(hash("reset"), hash("fresh"));
  Process diff = start({"diff", (dir_ / "fresh").string(), (dir_ / "reset").string()});
  EXPECT_EQ(diff.wait(10s), 0) << diff.output();
}

TEST_F(RunControl, AfterAResetCommandsAndReportShowTheNewSeedAndTick) {
  Process launcher = run(100'000, "r", {"--pace", "1x"});
  ASSERT_TRUE(reaches(launcher, 5)) << launcher.output();
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
  EXPECT_TRUE(eventually([&] {
    return command({"status"}) == exit_status::kOk && output_.find("seed 7") != std::string::npos;
  })) << output_;
  EXPECT_EQ(command({"end"}), exit_status::kOk);
  EXPECT_EQ(launcher.wait(20s), 128 + SIGTERM);
  EXPECT_EQ(report("r").value("seed", 0), 7);
}

// Two members cannot start before the file `go` is there.
TEST_F(RunControl, AStepOfARunThatHasNotBegunSaysWhatIsMissingAndIsMadeWhenItBegins) {
  write("late", "#!/bin/sh\nwhile [ ! -e " + (dir_ / "go").string() + " ]; do sleep 0.05; done\nexec " +
                    program("toy_host") + " \"$@\"\n");
  std::filesystem::permissions(dir_ / "late", std::filesystem::perms::owner_all);
  write("late.yaml",
        "plant: physics\nrobot: components/lib/robot/mamba.yaml\nscenario: sim/scenarios/case_study.yaml\nprocesses:\n"
        "  - {components: [physics, report], program: toy_host}\n  - {components: [navigation, control], program: " +
            (dir_ / "late").string() + "}\n");
  write("5000_ticks.yaml", "");
  Process launcher = start({"run", (dir_ / "5000_ticks.yaml").string(), "--manifest", (dir_ / "late.yaml").string(),
                            "--report", (dir_ / "late_run").string()});
  ASSERT_TRUE(launcher.wait_for("report in", 20s)) << launcher.errors();
  Process step = start({"step", "3"});
  ASSERT_TRUE(step.wait_for("has not begun: it waits for control, navigation; the steps are made when it begins", 20s))
      << step.errors();
  write("go", "");
  EXPECT_EQ(step.wait(30s), exit_status::kOk) << step.errors();
  output_ = step.output();
  EXPECT_EQ(next_tick(), 3) << output_;
  EXPECT_EQ(step.errors().find("interrupted"), std::string::npos) << step.errors();
  ASSERT_EQ(command({"end"}), exit_status::kOk) << output_;
  EXPECT_EQ(launcher.wait(30s), 128 + SIGTERM) << launcher.output();
}

TEST_F(RunControl, AStepBeyondTheEndOfTheRunReportsTheEnd) {
  Process launcher = run(100, "r", {"--pace", "1x"});
  ASSERT_TRUE(reaches(launcher, 5)) << launcher.output();
  const auto begin = std::chrono::steady_clock::now();
  EXPECT_EQ(command({"step", "5000"}), exit_status::kSoftware);
  EXPECT_NE(output_.find("the run ended before the command was done"), std::string::npos) << output_;
  EXPECT_LT(std::chrono::steady_clock::now() - begin, 10s) << "the command waited for ticks of a run that had ended";
  launcher.wait(20s);
}

// By these states, `step N` waits as long as ticks advance: run_control_client_test and tick_wait_test (unit/client).
TEST_F(RunControl, ARunThatMakesManyStepsAnnouncesItsTickMeanwhile) {
  Process launcher = run(1'000'000, "r", {"--pace", "1x"});
  ASSERT_TRUE(reaches(launcher, 5)) << launcher.output();
  ASSERT_EQ(command({"pause"}), exit_status::kOk) << output_;
  const long paused = next_tick();
  ASSERT_EQ(command({"step", "3000"}), exit_status::kOk) << output_;
  EXPECT_EQ(next_tick(), paused + 3000) << output_;
  const dds::Domain observer(domain());
  const auto states = dds::Reader<msg::RunState>::member(observer.participant(), barrier_topics::kRunState);
  Process steps = start({"step", "900000"});  // minutes
  std::set<std::int64_t> announced;
  EXPECT_TRUE(eventually([&] {
    states.take([&](const msg::RunState& state) {
      if (state.tick > paused + 3000) announced.insert(state.tick);
    });
    return announced.size() >= 3;
  }));
  EXPECT_TRUE(steps.running()) << steps.output() << steps.errors();
  EXPECT_EQ(command({"end"}), exit_status::kOk);
  EXPECT_EQ(steps.wait(20s), exit_status::kSoftware);
  EXPECT_NE(steps.errors().find("the run ended before the command was done"), std::string::npos) << steps.errors();
  launcher.wait(20s);
}

// Each command is a source of its own. It is answered although another source has used higher sequence numbers, and
// although several commands run at the same time.
TEST_F(RunControl, EachCommandIsAnsweredWhateverOtherSourcesSend) {
  Process launcher = run(100'000, "r", {"--pace", "1x"});
  ASSERT_TRUE(reaches(launcher, 5)) << launcher.output();
  const dds::Domain outside(domain());
  const auto answers =
      dds::Reader<msg::RunControlAnswer>::member(outside.participant(), barrier_topics::kRunControlAnswer);
  const dds::Writer<msg::RunControl> control(outside.participant(), barrier_topics::kRunControl, 1);
  msg::RunControl
      ahead{};  // its number is the time of a clock that is an hour ahead; several sources could use its name
  dds::set_text(ahead.source, "constrictor");
  ahead.command = msg::kRunResume;
  const auto hour_ahead = std::chrono::system_clock::now().time_since_epoch() + 1h;
  ahead.sequence_number =
      static_cast<std::uint64_t>(std::chrono::duration_cast<std::chrono::microseconds>(hour_ahead).count());
  control.write(ahead);
  ASSERT_TRUE(eventually([&] {
    bool ruled = false;
    answers.take(
        [&](const msg::RunControlAnswer& answer) { ruled |= answer.sequence_number == ahead.sequence_number; });
    return ruled;
  }));
  EXPECT_EQ(command({"pause"}), exit_status::kOk) << output_;
  EXPECT_EQ(command({"resume"}), exit_status::kOk) << output_;
  std::vector<Process> together;
  for (int i = 0; i < 6; ++i) together.push_back(start({"pace", std::to_string(i + 1) + "x"}));
  for (Process& one : together) EXPECT_EQ(one.wait(30s), exit_status::kOk) << one.errors();
  EXPECT_EQ(command({"end"}), exit_status::kOk);
  EXPECT_EQ(launcher.wait(20s), 128 + SIGTERM);
}

TEST_F(RunControl, AWrongValueIsAUsageErrorEvenWithoutARun) {
  for (const std::vector<std::string>& wrong :
       std::vector<std::vector<std::string>>{{"pace", "fast"},
                                             {"reset", "-1"},
                                             {"step", "-3"},
                                             {"teleop", "--drive", "9,0"},
                                             {"teleop", "--drive", "0.3,0", "--for", "0s"},
                                             {"task", "start", "nothing"},
                                             {"task", "start", "rotate", "--direction", "up"},
                                             {"task", "wait", "--event", "tea"},
                                             {"task", "wait", "--end", "--timeout", "soon"},
                                             {"run", "--seed", "-1"},
                                             {"run", "--pace", "fast"},
                                             {"param", "set", "a", "b"},
                                             {"pause", "--run", "-1"},
                                             {"topic", "echo", "joint_state", "--count", "-1"}}) {
    EXPECT_EQ(command(wrong), exit_status::kUsage) << wrong.front() << " " << wrong[1] << ": " << output_;
    EXPECT_NE(output_.find("accepted"), std::string::npos) << output_;
  }
}

TEST_F(RunControl, TheErrorNamesAnUnknownSubcommand) {
  EXPECT_EQ(command({"frobnicate"}), exit_status::kUsage);
  EXPECT_NE(output_.find("frobnicate"), std::string::npos) << output_;
  EXPECT_EQ(command({"task", "frobnicate"}), exit_status::kUsage);
  EXPECT_NE(output_.find("frobnicate"), std::string::npos) << output_;
}

TEST_F(RunControl, EveryHelpTextListsExamplesExitStatusesAndEnvironment) {
  for (const std::vector<std::string>& words : std::vector<std::vector<std::string>>{
           {"run"},           {"status"},       {"doctor"},         {"end"},          {"host"},
           {"pause"},         {"resume"},       {"step"},           {"pace"},         {"reset"},
           {"stop"},          {"clear-stop"},   {"release"},        {"teleop"},       {"task"},
           {"task", "start"}, {"task", "wait"}, {"task", "cancel"}, {"task", "list"}, {"topic"},
           {"node"},          {"param"},        {"diff"},           {"completion"},   {"topic", "delay"}}) {
    std::vector<std::string> arguments = words;
    arguments.emplace_back("--help");
    EXPECT_EQ(command(arguments), exit_status::kOk);
    const bool of_no_run = words.front() == "diff" || words.front() == "completion" || words.back() == "list";
    for (const char* part :
         {"EXAMPLES\n", "EXIT STATUS\n", "ENVIRONMENT\n", of_no_run ? "ENVIRONMENT\n  none" : "CONSTRICTOR_DOMAIN"}) {
      EXPECT_NE(output_.find(part), std::string::npos) << words.front() << " --help lacks " << part;
    }
  }
}

TEST_F(RunControl, PaceIsObeyedAndImpossibleCommandsAreRefused) {
  Process launcher = run(100'000, "r", {"--pace", "1x"});
  ASSERT_TRUE(reaches(launcher, 5)) << launcher.output();
  EXPECT_EQ(command({"pace", "3x"}), exit_status::kOk);
  EXPECT_NE(output_.find("at most 3x"), std::string::npos) << output_;
  EXPECT_EQ(command({"pace", "-1"}), exit_status::kUsage);
  EXPECT_EQ(command({"step", "0"}), exit_status::kUsage);
  EXPECT_EQ(command({"reset", "-1"}), exit_status::kUsage) << "-1 must not become 18446744073709551615";
  EXPECT_EQ(command({"stop"}), exit_status::kWaitedTooLong) << "the toys have no input member";
  EXPECT_EQ(command({"end"}), exit_status::kOk);
  EXPECT_EQ(launcher.wait(10s), 128 + SIGTERM);
  EXPECT_EQ(command({"pause"}), exit_status::kSoftware);
  EXPECT_NE(output_.find("no run on this host"), std::string::npos);
}

}  // namespace
}  // namespace constrictor::testing
