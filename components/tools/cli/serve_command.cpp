// `constrictor serve`: keeps processes of a manifest alive on this host, for one run after the other, without a
// launcher.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdlib>
#include <deque>
#include <memory>
#include <set>

#include "cli/launch_plan.hpp"
#include "cli/run_command.hpp"
#include "cli/served_process.hpp"
#include "cli/signal_queue.hpp"
#include "cli/subcommands.hpp"
#include "cli/usage.hpp"
#include "configuration/closest_name.hpp"
#include "configuration/configuration.hpp"
#include "runtime/host.hpp"

namespace constrictor::cli {
namespace {

namespace fs = std::filesystem;
using namespace std::chrono_literals;

constexpr auto kServePoll = 50ms;
constexpr auto kStopBound = 3s;  // after SIGTERM, processes that still run are killed

struct ServeOptions {
  RunOptions run;
  std::vector<std::string> components;
  fs::path state_dir;
  fs::path token_file;
};

fs::path default_state_dir() {
  if (const char* folder = std::getenv("STATE_DIRECTORY")) return folder;  // set by systemd
  if (const char* folder = std::getenv("XDG_STATE_HOME")) return fs::path(folder) / "constrictor";
  if (const char* home = std::getenv("HOME")) return fs::path(home) / ".local/state/constrictor";
  throw UsageError("--state: found no folder in STATE_DIRECTORY, XDG_STATE_HOME or HOME, accepted a folder");
}

/// Leaves in `plan` only the processes that host one of `components`; all if there are none.
void keep_processes(LaunchPlan& plan, const std::vector<std::string>& components) {
  for (const auto& name : components) {
    if (std::find(plan.roster.begin(), plan.roster.end(), name) != plan.roster.end()) continue;
    throw ConfigurationError(fmt::format("serve: found component '{}', accepted {}{}", name,
                                         fmt::join(plan.roster, ", "), did_you_mean(name, plan.roster)));
  }
  if (components.empty()) return;
  std::erase_if(plan.manifest.processes, [&](const ProcessPlan& process) {
    return std::none_of(process.components.begin(), process.components.end(), [&](const std::string& name) {
      return std::find(components.begin(), components.end(), name) != components.end();
    });
  });
}

class Server {
 public:
  Server(const ServeOptions& options, LaunchPlan plan) : options_(options), plan_(std::move(plan)) {
    const fs::path state = options.state_dir.empty() ? default_state_dir() : options.state_dir;
    fs::create_directories(state);
    for (const auto& process : plan_.manifest.processes) {
      const auto file = state / fmt::format("{}-domain{}.incarnation", process.name(), *options.run.domain);
      processes_.emplace_back(
          process.name(),
          [this, &process, folder = fs::path()](std::uint32_t incarnation, bool same_run) mutable {
            if (!same_run || folder.empty()) {
              std::error_code not_empty;  // the folder of a process that has written nothing is used again
              if (!folder.empty()) fs::remove(folder, not_empty);
              folder = output_folder(process);
            }
            // The plant continues its run from the checkpoint in its folder. Otherwise a new run begins with it.
            const auto& hosted = process.components;
            const bool is_plant = std::find(hosted.begin(), hosted.end(), plan_.manifest.plant) != hosted.end();
            if (is_plant && (!same_run || folder.empty())) incarnation = 1;
            return make_command_line(options_.run, plan_, *options_.run.domain, folder, 0, options_.token_file)(
                process, incarnation);
          },
          with_variables(run_environment(), process.environment), file,
          [](const std::string& line) {
            fmt::print("{}\n", line);
            std::fflush(stdout);
          });
    }
  }

  int run() {
    fmt::print("serving {} in domain {}; the next run begins when all of {} are there\n", names(), *options_.run.domain,
               fmt::join(plan_.roster, ", "));
    std::fflush(stdout);
    for (;;) {
      for (auto& process : processes_) {
        if (const auto status = process.poll()) return stop(*status);
      }
      if (signals_.wait(kServePoll) != 0) return stop(exit_status::kOk);
    }
  }

 private:
  [[nodiscard]] std::string names() const {
    std::string text;
    for (const auto& process : processes_) text += (text.empty() ? "" : ", ") + process.name();
    return text;
  }

  /// A new folder for the files of a run; empty without --output.
  [[nodiscard]] fs::path output_folder(const ProcessPlan& process) const {
    if (options_.run.report_dir.empty()) return {};
    return fs::absolute(make_new_directory(options_.run.report_dir / process.name()));
  }

  int stop(int status) {
    for (auto& process : processes_) process.stop(SIGTERM);
    const auto kill_at = std::chrono::steady_clock::now() + kStopBound;
    const auto any_runs = [this] {
      return std::any_of(processes_.begin(), processes_.end(), [](const auto& process) { return process.running(); });
    };
    bool killed = false;
    while (any_runs()) {
      for (auto& process : processes_) process.poll();
      const bool again = signals_.wait(kServePoll) != 0;
      if (killed || (!again && std::chrono::steady_clock::now() < kill_at)) continue;
      for (auto& process : processes_) process.stop(SIGKILL);
      killed = true;
    }
    return status;
  }

  const ServeOptions& options_;
  LaunchPlan plan_;
  SignalQueue signals_;  // before any process is started
  std::deque<ServedProcess> processes_;
};

int serve_command(const ServeOptions& options) {
  LaunchPlan plan = make_launch_plan(options.run);
  keep_processes(plan, options.components);
  show_warnings(check_components(options.run, plan));
  return Server(options, std::move(plan)).run();
}

}  // namespace

void add_serve(CLI::App& app, Action& action) {
  auto options = std::make_shared<ServeOptions>();
  auto* serve = add_subcommand(app, "serve", "keep processes of a manifest alive on this host, from run to run", action,
                               options, serve_command);
  RunOptions& run = options->run;
  serve->add_option("COMPONENT", options->components,
                    "serve the processes that host these components (default: all processes of the manifest)");
  serve->add_option("--domain", run.domain, "DDS domain of the runs, 0 to 229; the same on all hosts")
      ->envname("CONSTRICTOR_DOMAIN")
      ->required()
      ->check(whole_number(0, 229));
  serve->add_option("--scenario", run.scenario, "a name or a file (default: the manifest's)");
  add_file_options(*serve, run);
  serve->add_option("--pace", run.pace, "of the plant's process: lockstep, realtime, or a limit such as 2x")
      ->capture_default_str();
  serve->add_option("--output", run.report_dir,
                    "folder for the files of the runs, a new folder below it for each (default: none are written)");
  serve->add_option("--state", options->state_dir,
                    "folder in which the numbers of the starts are kept (default: $STATE_DIRECTORY, or\n"
                    "constrictor in $XDG_STATE_HOME or ~/.local/state)");
  serve
      ->add_option("--token-file", options->token_file,
                   "file with the token of the runs, the same on all hosts and readable by its owner only;\n"
                   "without it any program in the domain may command the robot")
      ->check(existing_file());
  serve->footer(help_footer(
      "For a host that runs its part of the robot from the time when it is switched on. No launcher is needed: a run\n"
      "begins when the last member of the roster has joined, on whatever host. A process that dies comes back into "
      "the\n"
      "run; when the run is over, it waits for the next one. Manifest, robot, scenario and seed must be the same on "
      "all\n"
      "hosts; a process that differs is refused, and tries again after pauses that grow from 0.2 s to 10 s. Log lines\n"
      "go to the standard output. SIGTERM or Ctrl-C stops all processes. The systemd unit constrictor@.service runs "
      "this command.",
      {"constrictor serve --domain 7 --help", "constrictor serve physics camera control --domain 7",
       "constrictor serve planner report --domain 7 --output /var/lib/constrictor"},
      "0 ended by a signal; 64 wrong usage; 70 a process cannot be started; 78 wrong configuration; 127 no such "
      "program",
      "CONSTRICTOR_DOMAIN  the domain, like --domain\n"
      "  CYCLONEDDS_URI      DDS configuration, needed to reach other hosts (deploy/cyclonedds)\n"
      "  STATE_DIRECTORY     set by systemd, see --state"));
}

}  // namespace constrictor::cli
