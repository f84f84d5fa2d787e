#include "cli/commands.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <chrono>
#include <csignal>
#include <cstdio>
#include <fstream>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <thread>
#include <vector>

#include "cli/launch_plan.hpp"
#include "cli/program_groups.hpp"
#include "cli/run_difference.hpp"
#include "cli/subcommands.hpp"
#include "cli/usage.hpp"
#include "client/run_control_client.hpp"
#include "client/run_registry.hpp"
#include "common/replay_control.hpp"
#include "cyclone/domain_claim.hpp"
#include "runtime/host.hpp"

namespace constrictor::cli {
namespace {

using namespace std::chrono_literals;
using Clock = std::chrono::steady_clock;

constexpr auto kEndPoll = 20ms;
constexpr auto kEndBound = 90s;  // longer than RunEnding's bounds together

/// Ends a run whose launcher is not on this host, or that has none: the conductor itself is asked.
int end_over_dds(const RunNote& run) {
  RunControlClient(run.domain).end();
  fmt::print("run {} ends: its processes make their last tick and end\n", run.domain);
  return exit_status::kOk;
}

}  // namespace

int become(const char* name, std::vector<std::string> arguments) {
  const std::filesystem::path program = program_folder() / name;
  if (::access(program.c_str(), X_OK) != 0) throw CommandError(missing_program(name));
  arguments.insert(arguments.begin(), program.string());
  std::vector<char*> pointers;
  for (auto& argument : arguments) pointers.push_back(argument.data());
  pointers.push_back(nullptr);
  ::execv(program.c_str(), pointers.data());
  std::perror(program.c_str());
  return exit_status::kSoftware;
}

int end_command(std::optional<std::uint32_t> domain) {
  refuse_replay(domain);
  const RunNote run = join_run(domain);
  if (!run.on_this_host) return end_over_dds(run);
  if (::kill(run.pid, SIGTERM) != 0) {
    throw CommandError(
        fmt::format("run {}: cannot signal its launcher (pid {}): {}", run.domain, run.pid, ::strerrordesc_np(errno)));
  }
  const auto end = Clock::now() + kEndBound;
  while (domain_claimed(run.domain)) {
    if (Clock::now() > end) {
      fmt::print(stderr, "end: run {} (pid {}) did not end within {} s; `constrictor end` again kills its processes\n",
                 run.domain, run.pid, kEndBound.count());
      return exit_status::kWaitedTooLong;
    }
    std::this_thread::sleep_for(kEndPoll);
  }
  const auto report = run.report_dir / "report.json";
  std::ifstream file(report);
  const auto json = nlohmann::json::parse(file, nullptr, false);
  const std::string reason = json.is_object() ? json.value("reason", std::string()) : "";
  fmt::print("run {} has ended{}; {}\n", run.domain, reason.empty() ? "" : ": " + reason, report.string());
  return exit_status::kOk;
}

int diff_command(const std::filesystem::path& a, const std::filesystem::path& b) {
  const auto difference = compare_runs(a, b);
  if (!difference) {
    fmt::print("equal\n");
    return exit_status::kOk;
  }
  fmt::print("first difference: tick {}, component {}, topic {}", difference->tick, difference->component,
             difference->topic);
  if (!difference->field.empty()) fmt::print(", field {}", difference->field);
  fmt::print("\n  {}: {}\n  {}: {}\n", a.string(), difference->a, b.string(), difference->b);
  if (difference->field.empty() && difference->a.starts_with("hash")) {
    fmt::print("  (for the field and its values, record both runs with `constrictor run --record`)\n");
  }
  return exit_status::kFailed;
}

int host_command(int argc, char** argv) {
  std::string names;
  int next = 0;
  for (; next < argc && argv[next][0] != '-'; ++next) names += (names.empty() ? "" : ",") + std::string(argv[next]);
  for (const auto& name : CLI::detail::split(names, ',')) require_component(name);
  std::vector<std::string> arguments;
  if (!names.empty()) arguments.push_back(names);
  arguments.insert(arguments.end(), argv + next, argv + argc);
  return become("constrictor_host", std::move(arguments));
}

int camera_command(int argc, char** argv) { return become("camera_setup", {argv, argv + argc}); }

int conform_command(int argc, char** argv) { return become("conform", {argv, argv + argc}); }

int dashboard_command(int argc, char** argv) { return become("dashboard", {argv, argv + argc}); }

void add_commands(CLI::App& app, Action& action) {
  auto domain = std::make_shared<std::optional<std::uint32_t>>();
  auto* end = add_subcommand(app, "end", "end a run in order, with a complete report", action, domain, end_command);
  add_run_option(*end, *domain);
  end->footer(help_footer(
      "Asks the run's launcher to end the run and waits until its last process has ended. All components finish the\n"
      "last tick, and the report component writes figure, objects, line and events. The same command again, while the\n"
      "run is ending, kills its processes.",
      {"constrictor end"},
      "0 the run has ended; 64 wrong usage; 70 no run, or several and none chosen; 75 it did not end within 90 s"));

  struct Directories {
    std::string a, b;
  };
  auto runs = std::make_shared<Directories>();
  auto* diff = add_subcommand(app, "diff", "name the first tick, component, topic and field in which two runs differ",
                              action, runs, [](const Directories& chosen) { return diff_command(chosen.a, chosen.b); });
  diff->add_option("RUN_A", runs->a, "report directory or recording (run.mcap) of a run")
      ->required()
      ->check(existing_path());
  diff->add_option("RUN_B", runs->b, "the same of another run")->required()->check(existing_path());
  diff->footer(
      "Compares the hashes of everything that was published at every tick. If both runs were made with\n"
      "`constrictor run --record`, it also names the field and both values. Equal runs are equal in every bit of "
      "every\n"
      "message. Two recordings can be compared without their directories; pixels are compared if both have them.\n\n"
      "EXAMPLES\n"
      "  constrictor run line --max-sim-time 5 --report a; constrictor run line --max-sim-time 5 --in-process --report "
      "b\n"
      "  constrictor diff a b\n\n"
      "EXIT STATUS\n"
      "  0 equal; 1 different; 64 wrong usage; 70 hashes.bin or run.mcap is missing, damaged, or has no tick\n\n"
      "ENVIRONMENT\n  none");

  app.add_subcommand("dashboard", "show a run in a web browser and in Foxglove")
      ->footer(
          "The process becomes the program `dashboard`, which shows its options with `dashboard --help`.\n\n"
          "EXAMPLES\n  constrictor dashboard\n  constrictor dashboard --port 0\n\n"
          "EXIT STATUS\n"
          "  0 the run has ended; 64 wrong usage; 70 no run, or the port cannot be opened; 130 Ctrl-C, 143 SIGTERM\n\n"
          "ENVIRONMENT\n  CONSTRICTOR_DOMAIN, CYCLONEDDS_URI");

  app.add_subcommand("camera", "set a new camera up: show, calibrate, mount, colours")
      ->footer(
          "The process becomes the program `camera_setup`, which shows its options with `constrictor camera "
          "--help`.\n\n"
          "EXAMPLES\n"
          "  constrictor camera show --source /dev/video0 --out picture.png\n"
          "  constrictor camera calibrate --source http://10.0.0.7:8080/stream --square 0.024 --out camera.yaml\n\n"
          "EXIT STATUS\n"
          "  0 done; 1 it did not succeed, with what to do; 64 wrong usage; 70 the source cannot be read; 78 a file "
          "is\n"
          "  wrong; 130 Ctrl-C\n\n"
          "ENVIRONMENT\n  CONSTRICTOR_DATA   directory of the default files");

  app.add_subcommand("conform", "check whether a part keeps the contract: plant, camera, perception, control, planner")
      ->footer(
          "The process becomes the program `conform`, which shows its options with `constrictor conform plant "
          "--help`.\n"
          "\nEXAMPLES\n"
          "  constrictor conform plant --domain 5          # a process that drives joints on the topics hardware/*\n"
          "  constrictor conform plant --list              # all checks, and what they expect\n"
          "  constrictor conform control --manifest mine.yaml   # a control of your own, in a run of its own\n\n"
          "EXIT STATUS\n"
          "  0 it conforms; 1 a check failed or was not made; 64 wrong usage, or not agreed; 78 a file is wrong;\n"
          "  130 Ctrl-C\n\n"
          "ENVIRONMENT\n  CONSTRICTOR_DOMAIN, CYCLONEDDS_URI, CONSTRICTOR_DATA");

  app.add_subcommand("host", "host components in one process: constrictor host NAME... [OPTION...]")
      ->footer(
          "The process becomes `constrictor_host`. Components in it exchange messages through queues, and use DDS to\n"
          "reach components elsewhere. If it hosts only some components of a run, --roster must name all of them.\n"
          "`constrictor run --group` does this for you.\n\n"
          "EXAMPLES\n"
          "  constrictor host navigation --help      # all options\n"
          "  constrictor host navigation control guidance --domain 5 --roster physics,navigation,control,guidance\n\n"
          "EXIT STATUS\n"
          "  0 the run is over, or SIGTERM; 64 wrong usage; 70 it failed; 75 it waited too long for another process;\n"
          "  76 it was refused; 78 wrong configuration\n\n"
          "ENVIRONMENT\n  CONSTRICTOR_DOMAIN, CYCLONEDDS_URI");
}

}  // namespace constrictor::cli
