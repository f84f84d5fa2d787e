// A fixture for tests that run the real components and compare the state hashes of the runs.
#pragma once

#include <gtest/gtest.h>
#include <signal.h>

#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <random>
#include <string>
#include <thread>

#include "integration/run_ticks.hpp"
#include "runtime/host.hpp"
#include "support/command_lines.hpp"
#include "support/eventually.hpp"
#include "support/process.hpp"
#include "support/project.hpp"
#include "support/temporary_folder.hpp"

namespace constrictor::testing {

/// All members of the case study except the plant: the members that the launcher restarts when they die.
inline const std::vector<std::string> kRestartable = {"camera",  "perception", "guidance", "navigation",
                                                      "control", "input",      "planner",  "report"};
/// The same for the manifest case_study_live.
inline const std::vector<std::string> kRestartableLive = [] {
  std::vector<std::string> members = kRestartable;
  members.insert(members.begin() + 1, "overview");
  return members;
}();

/// Random numbers of a new seed. Every failure during its life prints the seed.
class PrintedRandom {
 public:
  auto operator()() { return engine_(); }

 private:
  std::mt19937::result_type seed_ = std::random_device{}();
  ::testing::ScopedTrace trace_{__FILE__, __LINE__, "seed " + std::to_string(seed_)};
  std::mt19937 engine_{seed_};
};

class DeterminismRun : public ::testing::Test {
 protected:
  /// All runs of the test use `scenario`; each must end within `bound` of wall time.
  DeterminismRun(std::string scenario, std::chrono::seconds bound) : scenario_(std::move(scenario)), bound_(bound) {}

  /// Makes the report end each later run after `seconds` of simulated time.
  void limit_sim_time(double seconds) {
    std::ofstream(dir_ / "report.yaml") << "max_sim_time_s: " << seconds
                                        << "\nsettle_s: 1.0\ntorque_decimation_ticks: 5\ntorque_window_s: 30\n";
    always_ = {"--config", "report=" + (dir_ / "report.yaml").string()};
  }
  [[nodiscard]] Process start(const std::string& name, const std::vector<std::string>& more = {},
                              const std::map<std::string, std::string>& environment = {}) const {
    std::vector<std::string> arguments = {program("constrictor"), "run", scenario_, "--report", (dir_ / name).string()};
    arguments.insert(arguments.end(), always_.begin(), always_.end());
    arguments.insert(arguments.end(), more.begin(), more.end());
    return Process(std::move(arguments), environment);
  }
  /// Waits for the end of a run and returns its state hash. The run may end without success, because a run that the
  /// time limit ends is a mission without success.
  [[nodiscard]] std::string hash_of(const std::string& name, Process& process) const {
    const auto status = process.wait(bound_);
    EXPECT_TRUE(status == exit_status::kOk || status == exit_status::kFailed)
        << name << " ended with " << status.value_or(-1) << ": " << process.output() << process.errors();
    const nlohmann::json json = report(name);
    if (!json.contains("state_hash") || !json["state_hash"].is_string()) {
      ADD_FAILURE() << name << ": no state hash in the report";
      return "none of " + name;
    }
    return json["state_hash"];
  }
  [[nodiscard]] nlohmann::json report(const std::string& name) const {
    return nlohmann::json::parse(std::ifstream(dir_ / name / "report.json"), nullptr, false);
  }
  std::string run(const std::string& name, const std::vector<std::string>& more = {},
                  const std::map<std::string, std::string>& environment = {}) const {
    Process process = start(name, more, environment);
    return hash_of(name, process);
  }
  /// Writes a manifest of deploy/ into the test's folder. `lines` maps a component to lines that are added to the entry
  /// of its process; each is indented by four blanks.
  void write_manifest(const std::string& name, const std::map<std::string, std::string>& lines,
                      const std::string& original = "case_study") const {
    std::ifstream file(testing::source_path("deploy/" + original + ".yaml"));
    std::string text{std::istreambuf_iterator<char>(file), {}};
    for (const auto& [component, line] : lines) {
      const std::string plain = "components: [" + component + "]\n";
      const auto at = text.find(plain);
      ASSERT_NE(at, std::string::npos) << component;
      text.replace(at, plain.size(), plain + line);
    }
    std::ofstream(dir_ / name) << text;
  }
  /// Pid of the process of this test's run whose program or whose list of hosted components is `name`; -1 if there is
  /// none.
  [[nodiscard]] pid_t pid_of(const std::string& name) const {
    for (const auto& [pid, line] : command_lines()) {
      const std::string executable = std::filesystem::path(line.substr(0, line.find('\0'))).filename();
      const bool hosts = executable == "constrictor_host" && line.find('\0' + name + '\0') != std::string::npos;
      if ((executable == name || hosts) && line.find(dir_.string()) != std::string::npos) return pid;
    }
    return -1;
  }
  /// Waits until `name` runs in another process than `dead` and returns its pid; -1 after 20 s.
  [[nodiscard]] pid_t running(const std::string& name, pid_t dead = -1) const {
    pid_t pid = -1;
    const auto is_another = [&] { return (pid = pid_of(name)) > 0 && pid != dead; };
    return eventually(is_another, std::chrono::seconds(20), std::chrono::milliseconds(1)) ? pid : -1;
  }
  /// Starts a run and stops (SIGSTOP) each of its processes in turn, until the run stands: `longest_stopped` until
  /// another process has announced that it waits for it, and at least for `longest`; and the launcher last. Returns the
  /// state hash of the run.
  [[nodiscard]] std::string run_with_stops(const std::string& longest_stopped, std::chrono::seconds longest) {
    Process launcher = start("stopped", {"--pace", "2x"});
    EXPECT_GT(running("report"), 0);
    RunTicks ticks(launcher);
    std::vector<std::string> all = kRestartable;
    all.insert(all.begin(), "physics");
    for (const auto& name : all) {
      EXPECT_TRUE(ticks.pass(10)) << launcher.output();
      const pid_t pid = running(name);
      EXPECT_GT(pid, 0) << name << ": " << launcher.output();
      if (pid <= 0) break;
      const auto begin = std::chrono::steady_clock::now();
      ::kill(pid, SIGSTOP);
      EXPECT_TRUE(ticks.stand()) << name << " is stopped, but the run goes on";
      if (name == longest_stopped) {
        EXPECT_TRUE(is_awaited(ticks.participant(), name));
        std::this_thread::sleep_until(begin + longest);  // a stop of this length is what the test is about
      }
      EXPECT_TRUE(launcher.running()) << "over before " << name << " was stopped";
      ::kill(pid, SIGCONT);
    }
    launcher.signal(SIGSTOP);
    EXPECT_TRUE(ticks.pass(50)) << "no process waits for the launcher: the run must go on";
    launcher.signal(SIGCONT);
    return hash_of("stopped", launcher);
  }
  /// Waits until a process announces that it waits for `name`.
  [[nodiscard]] static bool is_awaited(dds_entity_t participant, const std::string& name) {
    const auto waitings = dds::Reader<msg::Waiting>::observer(participant, barrier_topics::kWaiting.name, 8);
    bool awaited = false;
    return eventually([&] {
      waitings.take([&](const msg::Waiting& waiting) { awaited |= waiting.writer == name; });
      return awaited;
    });
  }

  std::string scenario_;
  std::chrono::seconds bound_;
  std::vector<std::string> always_;
  const TemporaryFolder folder_;
  const std::filesystem::path dir_ = folder_.path();
};

}  // namespace constrictor::testing
