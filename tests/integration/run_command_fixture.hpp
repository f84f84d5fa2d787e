// A fixture for tests that start a run of toy components with the real launcher, and check its processes and its
// report.
#pragma once

#include <gtest/gtest.h>
#include <signal.h>

#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>
#include <thread>

#include "integration/case_study_manifest.hpp"
#include "runtime/host.hpp"
#include "support/command_lines.hpp"
#include "support/eventually.hpp"
#include "support/process.hpp"
#include "support/temporary_folder.hpp"

namespace constrictor::testing {

namespace fs = std::filesystem;
using namespace std::chrono_literals;

inline const std::string kManifest = case_study_manifest(
    4,
    "  - {components: [physics], program: toy_host}\n  - {components: [navigation], program: toy_host}\n"
    "  - {components: [control], program: toy_host}\n  - {components: [planner], program: toy_host}\n"
    "  - {components: [report], program: toy_host}\n");

inline std::string replaced(std::string text, const std::string& what, const std::string& with) {
  return text.replace(text.find(what), what.size(), with);
}

class RunCommand : public ::testing::Test {
 protected:
  RunCommand() { write("toys.yaml", kManifest); }

  void write(const std::string& name, const std::string& text) const { std::ofstream(dir_ / name) << text; }
  [[nodiscard]] std::string read(const std::string& name) const {
    std::ifstream file(dir_ / name);
    return {std::istreambuf_iterator<char>(file), {}};
  }
  /// Runs the examples in the help of a subcommand, in the test's folder, and expects each to succeed. Returns how many
  /// there are.
  [[nodiscard]] int run_examples(std::vector<std::string> subcommand) const {
    subcommand.emplace_back("--help");
    Process help = command(subcommand);
    EXPECT_EQ(help.wait(20s), exit_status::kOk) << help.errors();
    std::istringstream text(help.output());
    std::string line;
    while (std::getline(text, line) && line != "EXAMPLES") {}
    auto environment = environment_;
    environment["PATH"] = fs::path(program("constrictor")).parent_path().string() + ":/usr/bin:/bin";
    int examples = 0;
    for (; std::getline(text, line) && line.starts_with("  constrictor "); ++examples) {
      Process example({"/bin/sh", "-c", "cd " + dir_.string() + " && " + line}, environment);
      EXPECT_EQ(example.wait(60s), exit_status::kOk) << line << example.errors();
    }
    return examples;
  }
  [[nodiscard]] Process command(std::vector<std::string> arguments) const {
    arguments.insert(arguments.begin(), program("constrictor"));
    return Process(std::move(arguments), environment_);
  }
  /// Starts a run of `ticks` ticks of 20 ms that writes its report into the folder `report`.
  [[nodiscard]] Process run(long ticks, const std::string& report, std::vector<std::string> more = {},
                            const std::string& manifest = "toys.yaml") const {
    const std::string scenario = std::to_string(ticks) + "_ticks.yaml";
    write(scenario, "");
    std::vector<std::string> arguments = {"run",        (dir_ / scenario).string(),
                                          "--manifest", (dir_ / manifest).string(),
                                          "--report",   (dir_ / report).string()};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return command(arguments);
  }
  /// Starts a run of 300 ticks, reported in "r", whose planner is a shell script with these commands.
  [[nodiscard]] Process run_with_planner(const std::string& commands) const {
    write("script", "#!/bin/sh\n" + commands + "\n");
    fs::permissions(dir_ / "script", fs::perms::owner_all);
    write("scripted.yaml",
          replaced(kManifest, "[planner], program: toy_host", "[planner], program: " + (dir_ / "script").string()));
    return run(300, "r", {}, "scripted.yaml");
  }
  [[nodiscard]] nlohmann::json report(const std::string& name) const {
    return nlohmann::json::parse(std::ifstream(dir_ / name / "report.json"), nullptr, false);
  }
  [[nodiscard]] std::string log(const std::string& report, const std::string& process) const {
    std::ifstream file(dir_ / report / "logs" / (process + ".log"));
    return {std::istreambuf_iterator<char>(file), {}};
  }
  /// Waits until a member's process exists, and sends `signal` to it alone.
  void kill_member(const std::string& name, int signal) const {
    ASSERT_TRUE(eventually([&] { return members().contains(name); })) << name;
    const pid_t pid = members()[name];
    ASSERT_GT(pid, 0) << name;
    ::kill(pid, signal);
  }
  /// The processes of this test's runs: the pid for each list of hosted components.
  [[nodiscard]] std::map<std::string, pid_t> members() const {
    std::map<std::string, pid_t> found;
    for (const auto& [pid, line] : command_lines()) {
      const auto name = line.find('\0');
      if (line.find(dir_.string()) == std::string::npos || line.find("--incarnation") == std::string::npos) continue;
      found[line.substr(name + 1).c_str()] = pid;
    }
    return found;
  }
  void expect_nobody_left() const {
    EXPECT_TRUE(eventually([&] { return members().empty(); })) << members().begin()->first << " is left";
  }
  [[nodiscard]] std::string state_hash(const std::string& name) const {
    return report(name).value("state_hash", "none");
  }

  const TemporaryFolder folder_;
  const fs::path dir_ = folder_.path();
  std::map<std::string, std::string> environment_;
};

}  // namespace constrictor::testing
