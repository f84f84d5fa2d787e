// The command `constrictor`.
#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdio>
#include <functional>
#include <string>

#include "cli/commands.hpp"
#include "cli/introspection/completion.hpp"
#include "cli/introspection/doctor_command.hpp"
#include "cli/introspection/node_command.hpp"
#include "cli/introspection/status_command.hpp"
#include "cli/introspection/topic_command.hpp"
#include "cli/param_command.hpp"
#include "cli/run_command.hpp"
#include "cli/run_control.hpp"
#include "cli/task_command.hpp"
#include "cli/teleop_command.hpp"
#include "cli/usage.hpp"
#include "configuration/configuration.hpp"
#include "runtime/host.hpp"
#include "runtime/version.hpp"

namespace {

using namespace constrictor;

int dispatch(int argc, char** argv) {
  CLI::App app{"Constrictor: a distributed component system for modular snake robots."};
  app.set_version_flag("--version", kVersion);
  app.require_subcommand(1);

  cli::RunOptions run;
  std::vector<std::string> groups;
  auto* run_app = app.add_subcommand("run", "run a scenario with every component a process of its own, and write a report");
  run_app->add_option("SCENARIO", run.scenario, "a name in sim/scenarios, or a file (default: the manifest's)");
  run_app->add_option("--seed", run.seed, "varies the scene, masses, friction, light, noise and start pose")
      ->capture_default_str()->check(cli::whole_number());
  run_app->add_option("--pace", run.pace, "lockstep, realtime, or at most N times real time (2x)")->capture_default_str();
  run_app->add_flag("--in-process", run.in_process, "all components in one process");
  run_app->add_option("--group", groups, "components, comma separated, that share a process; may be repeated")
      ->allow_extra_args(false)->excludes("--in-process");
  run_app->add_option("--report", run.report_dir, "directory for the report (default: a new one under runs/)");
  run_app->add_option("--manifest", run.manifest, "launch manifest: a name in deploy, or a file")->capture_default_str();
  run_app->add_option("--robot", run.robot, "robot: a name in components/robot, or a file (default: the manifest's)");
  run_app->add_option("--config", run.config_files, "NAME=FILE: configuration of a component; may be repeated")->allow_extra_args(false);
  run_app->add_option("--max-sim-time", run.max_sim_time_s, "[s] end the run at this simulated time")->check(CLI::Range(0.0, 1e6));
  run_app->add_flag("--record", run.record, "log all messages but images, so that `constrictor diff` can name fields");
  run_app->add_option("--domain", run.domain, "DDS domain (default: the first free of 1 to 100)")
      ->envname("CONSTRICTOR_DOMAIN")->check(CLI::Range(0, 229));

  run_app->footer(
      "Starts every component of a launch manifest in a DDS domain of its own, shows what happens, restarts what dies, and ends with the\n"
      "mission. The report directory then has report.json, figure.png, hashes.bin (for `constrictor diff`) and logs/.\n"
      "In lock-step the result depends on scenario, seed, configurations and robot only: not on grouping, pace, load, kills or hosts.\n\n"
      "EXAMPLES\n"
      "  constrictor run\n"
      "  constrictor run short --seed 7 --report /tmp/seven\n"
      "  constrictor run --in-process --pace realtime\n"
      "  constrictor run --group physics,camera --group navigation,control\n"
      "  constrictor run --manifest manual                       # no planner: for teleop and planners of your own\n"
      "  constrictor run --config navigation=mine.yaml --config input=changes.yaml\n\n"
      "EXIT STATUS\n"
      "  0 the mission succeeded; 1 it failed; 64 wrong usage; 70 a process failed; 75 one waited too long for another;\n"
      "  76 one was refused; 78 bad configuration; 128 + N ended by signal N (Ctrl-C: 130)\n\n"
      "FILES\n"
      "  runs/                       reports, unless --report says otherwise\n"
      "  $XDG_RUNTIME_DIR/constrictor/  notes by which other commands find the run\n\n"
      "ENVIRONMENT\n"
      "  CONSTRICTOR_DOMAIN  the domain, like --domain\n"
      "  CONSTRICTOR_SHARE   where default files are, instead of the source tree or the install prefix\n"
      "  CYCLONEDDS_URI      how DDS reaches other hosts (deploy/cyclonedds)");

  std::optional<std::uint32_t> domain;
  auto* end_app = app.add_subcommand("end", "end a run and all of its processes");
  cli::add_run_option(*end_app, domain);
  end_app->footer("Asks the run's launcher to end and waits until the last process is gone; the report is written.\n\n"
                  "EXAMPLES\n  constrictor end\n  constrictor end --run 3\n\n"
                  "EXIT STATUS\n  0 it has ended; 64 wrong usage; 70 no run, or several and none chosen; 75 it did not end within 20 s\n\n"
                  "ENVIRONMENT\n  CONSTRICTOR_DOMAIN  the run, like --run");
  std::string a;
  std::string b;
  auto* diff_app = app.add_subcommand("diff", "name the first tick, component, topic and field in which two runs differ");
  diff_app->add_option("RUN_A", a, "report directory of a run")->required()->check(CLI::ExistingDirectory);
  diff_app->add_option("RUN_B", b, "report directory of another")->required()->check(CLI::ExistingDirectory);
  diff_app->footer("Compares what was written at every tick by its hash; of runs made with `constrictor run --record` it names the field and both\n"
                   "values, too. Equal runs are equal in every bit of every message.\n\n"
                   "EXAMPLES\n  constrictor run --seed 1 --report a && constrictor run --seed 1 --in-process --report b\n  constrictor diff a b\n\n"
                   "EXIT STATUS\n  0 equal; 1 different; 64 wrong usage; 70 a directory without hashes.bin, or a damaged one, or\n  one of a run that never ticked\n\n"
                   "ENVIRONMENT\n  none: it reads the two directories only");
  app.add_subcommand("host", "host components in one process: constrictor host NAME... [OPTION...]")
      ->footer("The process becomes `constrictor_host`: queues between the components inside, DDS to those elsewhere. One that hosts only a part\n"
               "of a run names the others by --roster. `constrictor run --group` does it for you.\n\n"
               "EXAMPLES\n  constrictor host navigation control guidance --domain 5 --roster physics,navigation,control,guidance\n"
               "  constrictor host navigation --help      # all options\n\n"
               "EXIT STATUS\n  0 the run is over, or SIGTERM; 64 wrong usage; 70 it failed; 75 it waited too long for a peer; 76 it was refused;\n"
               "  78 bad configuration\n\n"
               "ENVIRONMENT\n  CONSTRICTOR_DOMAIN, CYCLONEDDS_URI");
  std::function<int()> action;
  cli::add_run_control(app, action);
  cli::add_teleop(app, action);
  cli::add_task(app, action);
  cli::add_param(app, action);
  cli::add_topic(app, action);
  cli::add_node(app, action);
  cli::add_status(app, action);
  cli::add_doctor(app, action);
  cli::add_completion(app, action);

  try {
    app.parse(argc, argv);
  } catch (const CLI::RequiredError& error) {
    // A word that is no subcommand, rather than none.
    const auto rest = app.remaining(true);
    const auto word = std::find_if(rest.begin(), rest.end(), [](const std::string& text) { return !text.starts_with("-"); });
    if (word == rest.end()) return app.exit(error) == 0 ? exit_status::kOk : exit_status::kUsage;
    std::fprintf(stderr, "constrictor: no subcommand '%s' (constrictor --help)\n", word->c_str());
    return exit_status::kUsage;
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? exit_status::kOk : exit_status::kUsage;
  }
  if (*end_app) return cli::end_command(domain);
  if (action) return action();
  if (*diff_app) return cli::diff_command(a, b);
  for (const auto& group : groups) run.groups.push_back(CLI::detail::split(group, ','));
  return cli::run_command(run);
}

}  // namespace

int main(int argc, char** argv) {
  try {
    // The options after `host NAME...` are those of the process it becomes.
    const std::string first = argc > 1 ? argv[1] : "";
    const std::string second = argc == 3 ? argv[2] : "";
    if (first == "host" && second != "--help" && second != "-h") return cli::host_command(argc - 2, argv + 2);
    return dispatch(argc, argv);
  } catch (const cli::UsageError& error) {
    std::fprintf(stderr, "constrictor: %s\n", error.what());
    return exit_status::kUsage;
  } catch (const ConfigurationError& error) {
    std::fprintf(stderr, "constrictor: configuration: %s\n", error.what());
    return exit_status::kConfiguration;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "constrictor: %s\n", error.what());
    return exit_status::kSoftware;
  }
}
