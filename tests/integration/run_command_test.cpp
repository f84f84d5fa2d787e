// `constrictor run` and its companions on real processes: toy components, real barrier, real launcher.
#include <gtest/gtest.h>
#include <signal.h>

#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <thread>

#include "runtime/dds/domain.hpp"
#include "runtime/dds/endpoint.hpp"
#include "runtime/dds/wire.hpp"
#include "runtime/host.hpp"
#include "support/process.hpp"
#include "support/temporary_folder.hpp"

namespace constrictor::testing {
namespace {

namespace fs = std::filesystem;
using namespace std::chrono_literals;

constexpr const char* kManifest =
    "plant: physics\nrobot: components/robot/mamba.yaml\nscenario: sim/scenarios/case_study.yaml\npatience_s: 4\nprocesses:\n"
    "  - {components: [physics], program: toy_host}\n  - {components: [navigation], program: toy_host}\n"
    "  - {components: [control], program: toy_host}\n  - {components: [planner], program: toy_host}\n"
    "  - {components: [report], program: toy_host}\n";

/// True once `condition` holds; false if it does not within the bound.
template <class Condition>
bool eventually(Condition&& condition, std::chrono::seconds bound = 15s) {
  const auto end = std::chrono::steady_clock::now() + bound;
  while (!condition()) {
    if (std::chrono::steady_clock::now() > end) return false;
    std::this_thread::sleep_for(5ms);
  }
  return true;
}

class RunCommand : public ::testing::Test {
 protected:
  RunCommand() { write("toys.yaml", kManifest); }

  void write(const std::string& name, const std::string& text) const { std::ofstream(dir_ / name) << text; }
  [[nodiscard]] Process command(std::vector<std::string> arguments) const {
    arguments.insert(arguments.begin(), program("constrictor"));
    return Process(std::move(arguments), environment_);
  }
  /// A run of so many ticks of 20 ms that reports to `report`.
  [[nodiscard]] Process run(long ticks, const std::string& report, std::vector<std::string> more = {},
                            const std::string& manifest = "toys.yaml") const {
    const std::string scenario = std::to_string(ticks) + "_ticks.yaml";
    write(scenario, "");
    std::vector<std::string> arguments = {"run", (dir_ / scenario).string(), "--manifest", (dir_ / manifest).string(), "--report",
                                          (dir_ / report).string()};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return command(arguments);
  }
  [[nodiscard]] nlohmann::json report(const std::string& name) const {
    return nlohmann::json::parse(std::ifstream(dir_ / name / "report.json"), nullptr, false);
  }
  [[nodiscard]] std::string log(const std::string& report, const std::string& process) const {
    std::ifstream file(dir_ / report / "logs" / (process + ".log"));
    return {std::istreambuf_iterator<char>(file), {}};
  }
  /// Signals a member's process once it is there, and nobody else.
  void kill_member(const std::string& name, int signal) const {
    ASSERT_TRUE(eventually([&] { return members().contains(name); })) << name;
    const pid_t pid = members()[name];
    ASSERT_GT(pid, 0) << name;
    ::kill(pid, signal);
  }
  /// Processes that report into this test's directory: name of what each hosts, and pid.
  [[nodiscard]] std::map<std::string, pid_t> members() const {
    std::map<std::string, pid_t> found;
    for (const auto& entry : fs::directory_iterator("/proc")) {
      const std::string pid = entry.path().filename();
      if (pid.find_first_not_of("0123456789") != std::string::npos) continue;
      std::ifstream file(entry.path() / "cmdline");
      const std::string line{std::istreambuf_iterator<char>(file), {}};
      const auto name = line.find('\0');
      if (line.find(dir_.string()) == std::string::npos || line.find("--incarnation") == std::string::npos) continue;
      found[line.substr(name + 1).c_str()] = std::stoi(pid);
    }
    return found;
  }
  void expect_nobody_left() const {
    EXPECT_TRUE(eventually([&] { return members().empty(); })) << members().begin()->first << " is left";
  }
  [[nodiscard]] std::string state_hash(const std::string& name) const { return report(name).value("state_hash", "none"); }

  const TemporaryFolder folder_;
  const fs::path dir_ = folder_.path();
  std::map<std::string, std::string> environment_;
};

TEST_F(RunCommand, EndsWellAndReportsOnEveryProcess) {
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

TEST_F(RunCommand, EveryGroupingGivesTheSameStateAndDiffFindsNone) {
  ASSERT_EQ(run(300, "each").wait(30s), exit_status::kOk);
  ASSERT_EQ(run(300, "one", {"--in-process"}).wait(30s), exit_status::kOk);
  ASSERT_EQ(run(300, "groups", {"--group", "planner,navigation", "--group", "report,physics", "--pace", "20x"}).wait(30s), exit_status::kOk);
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
  EXPECT_EQ(diff.output().rfind("first difference: tick 0, component physics, topic joint_state, field ", 0), 0u) << diff.output();
}

TEST_F(RunCommand, RestartsAMemberThatDiedWithoutATrace) {
  ASSERT_EQ(run(400, "undisturbed", {"--in-process"}).wait(30s), exit_status::kOk);
  Process launcher = run(400, "r", {"--pace", "2x"});
  ASSERT_TRUE(eventually([&] { return members().size() == 5; }));
  for (const char* victim : {"control", "navigation", "planner", "report"}) {
    std::this_thread::sleep_for(400ms);
    const pid_t pid = members()[victim];
    ASSERT_GT(pid, 0) << victim;
    ::kill(pid, SIGKILL);
    ASSERT_TRUE(eventually([&] { return members()[victim] > 0 && members()[victim] != pid; })) << launcher.output();
  }
  ASSERT_EQ(launcher.wait(60s), exit_status::kOk) << launcher.output();
  EXPECT_EQ(state_hash("r"), state_hash("undisturbed"));
  EXPECT_EQ(report("r")["processes"][2]["restarts"], 1);
  EXPECT_NE(launcher.output().find("control was killed by signal 9 (Killed); restarted as incarnation 2"), std::string::npos) << launcher.output();
}

// Each death soon after the start of its incarnation, and far more of them than a member may die in vain.
TEST_F(RunCommand, AMemberKilledAgainAndAgainEndsNothingAsLongAsTheRunGoesOn) {
  ASSERT_EQ(run(600, "undisturbed", {"--in-process"}).wait(30s), exit_status::kOk);
  Process launcher = run(600, "r", {"--pace", "2x"});
  ASSERT_TRUE(launcher.wait_for("run ", 15s));
  const dds::Domain domain(static_cast<std::uint32_t>(std::stoul(launcher.output().substr(4))));
  const auto statuses = dds::Reader<msg::ComponentStatus>::member(domain.participant(), dds::barrier_topics::kStatus);
  for (std::uint32_t incarnation = 1; incarnation <= 10; ++incarnation) {
    bool steps = false;
    ASSERT_TRUE(eventually([&] {
      statuses.take([&](const msg::ComponentStatus& status) {
        steps |= status.component == std::string("control") && status.incarnation == incarnation && status.tick >= 0;
      });
      return steps;
    })) << incarnation << ": " << launcher.output();
    std::this_thread::sleep_for(100ms);  // ten ticks, if it lets them pass
    kill_member("control", SIGKILL);
  }
  ASSERT_EQ(launcher.wait(60s), exit_status::kOk) << launcher.output();
  EXPECT_EQ(state_hash("r"), state_hash("undisturbed"));
  EXPECT_EQ(report("r")["processes"][2]["restarts"], 10);
}

TEST_F(RunCommand, ThePlantsDeathEndsTheRunWithAnError) {
  Process launcher = run(100'000, "r", {"--pace", "1x"});
  ASSERT_TRUE(eventually([&] { return members().size() == 5; }));
  kill_member("physics", SIGKILL);
  EXPECT_EQ(launcher.wait(15s), exit_status::kSoftware);
  EXPECT_NE(launcher.output().find("physics, the plant, ended: killed by signal 9"), std::string::npos) << launcher.output();
  EXPECT_EQ(report("r")["success"], false);
  expect_nobody_left();
}

TEST_F(RunCommand, CtrlCEndsEveryProcess) {
  Process launcher = run(100'000, "r", {"--pace", "1x"});
  ASSERT_TRUE(eventually([&] { return members().size() == 5; }));
  launcher.signal(SIGINT);
  EXPECT_EQ(launcher.wait(10s), 128 + SIGINT);
  EXPECT_TRUE(members().empty());
  EXPECT_EQ(report("r")["success"], false);
}

TEST_F(RunCommand, AKilledLauncherLeavesNobody) {
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

TEST_F(RunCommand, WithoutASuccessfulMissionTheStatusIsOne) {
  Process launcher = run(100'000, "r", {"--max-sim-time", "20", "--pace", "20x"});
  EXPECT_EQ(launcher.wait(30s), exit_status::kMissionFailed) << launcher.output();
  EXPECT_NEAR(report("r").value("ticks", 0.0), 1000, 1);  // the final tick is sent but not stepped
}

TEST_F(RunCommand, StatusShowsAndEndEndsTheOnlyRun) {
  environment_ = {{"XDG_RUNTIME_DIR", dir_.string()}};  // a registry of its own: this is the only run there
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
  EXPECT_EQ(status.output().find("not heard of"), std::string::npos) << status.output();
  Process end = command({"end"});
  EXPECT_EQ(end.wait(20s), exit_status::kOk) << end.errors();
  EXPECT_EQ(launcher.wait(5s), 128 + SIGTERM);
  expect_nobody_left();
}

TEST_F(RunCommand, RunsSideBySideTakeDifferentDomains) {
  Process a = run(100'000, "a", {"--pace", "1x"});
  ASSERT_TRUE(eventually([&] { return members().size() == 5; }));
  Process b = run(100, "b");
  EXPECT_EQ(b.wait(30s), exit_status::kOk) << b.output();
  const auto first_word = [](const Process& process) { return process.output().substr(0, process.output().find(':')); };
  EXPECT_NE(first_word(a), first_word(b));
  a.signal(SIGTERM);
  EXPECT_EQ(a.wait(10s), 128 + SIGTERM);
}

std::string replaced(std::string text, const std::string& what, const std::string& with) { return text.replace(text.find(what), what.size(), with); }

TEST_F(RunCommand, AMemberWithOtherNumbersIsRefusedByNameAndReason) {
  write("other.yaml", replaced(kManifest, "[planner], program: toy_host", "[planner], program: toy_host, environment: ['GLIBC_TUNABLES=']"));
  Process launcher = run(300, "r", {}, "other.yaml");
  EXPECT_EQ(launcher.wait(20s), exit_status::kRefused) << launcher.output();
  EXPECT_NE(launcher.output().find("planner: the run refuses this process: numeric profile differs"), std::string::npos)
      << launcher.output();
}

TEST_F(RunCommand, AMemberThatNeverJoinsIsNamed) {
  write("sleeper", "#!/bin/sh\nexec sleep 100\n");
  fs::permissions(dir_ / "sleeper", fs::perms::owner_all);
  write("lazy.yaml", replaced(kManifest, "[planner], program: toy_host", "[planner], program: " + (dir_ / "sleeper").string()));
  Process launcher = run(300, "r", {}, "lazy.yaml");
  EXPECT_EQ(launcher.wait(30s), exit_status::kWaitedTooLong) << launcher.output();
  EXPECT_NE(launcher.output().find("waits for Hello of planner"), std::string::npos) << launcher.output();
  expect_nobody_left();
}

TEST_F(RunCommand, AMemberThatDiesAgainAndAgainEndsTheRun) {
  write("faulty", "#!/bin/sh\necho no luck today\nexit 3\n");
  fs::permissions(dir_ / "faulty", fs::perms::owner_all);
  write("faulty.yaml", replaced(kManifest, "[planner], program: toy_host", "[planner], program: " + (dir_ / "faulty").string()));
  Process launcher = run(300, "r", {}, "faulty.yaml");
  EXPECT_EQ(launcher.wait(30s), exit_status::kSoftware);
  EXPECT_NE(launcher.output().find("planner: no luck today"), std::string::npos) << launcher.output();
  EXPECT_NE(launcher.output().find("died 5 times in a row"), std::string::npos) << launcher.output();
}

TEST_F(RunCommand, BadFilesAndArgumentsEndItBeforeAnythingStarts) {
  write("typo.yaml", replaced(kManifest, "plant:", "plannt:"));
  Process typo = run(300, "r", {}, "typo.yaml");
  EXPECT_EQ(typo.wait(10s), exit_status::kConfiguration);
  EXPECT_NE(typo.errors().find("typo.yaml:1"), std::string::npos) << typo.errors();
  Process pace = run(300, "r", {"--pace", "fast"});
  EXPECT_EQ(pace.wait(10s), exit_status::kUsage);
  Process scenario = command({"run", "nowhere"});
  EXPECT_EQ(scenario.wait(10s), exit_status::kConfiguration);
  Process option = command({"run", "--sead", "3"});
  EXPECT_EQ(option.wait(10s), exit_status::kUsage);
  write("missing.yaml", replaced(kManifest, "[planner], program: toy_host", "[planner], program: no_such_program"));
  Process missing = run(300, "r", {}, "missing.yaml");
  EXPECT_EQ(missing.wait(10s), exit_status::kSoftware);
  EXPECT_NE(missing.output().find("no_such_program: No such file or directory"), std::string::npos) << missing.output();
}

}  // namespace
}  // namespace constrictor::testing
