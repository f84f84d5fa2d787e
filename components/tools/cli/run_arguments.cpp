// The command lines of `constrictor run` and `constrictor check`.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <memory>

#include "cli/run_command.hpp"
#include "cli/subcommands.hpp"
#include "cli/usage.hpp"
#include "configuration/counted.hpp"
#include "runtime/host.hpp"

namespace constrictor::cli {
namespace {

void add_scenario(CLI::App& app, RunOptions& options) {
  app.add_option("SCENARIO", options.scenario,
                 "a name (see `constrictor list scenarios`) or a file (default: the manifest's)");
}

}  // namespace

void add_file_options(CLI::App& app, RunOptions& options) {
  app.add_option("--seed", options.seed, "seed of scene, masses, friction, light, noise and start pose")
      ->capture_default_str()
      ->check(whole_number());
  app.add_option("--manifest", options.manifest, "launch manifest: a name (see `constrictor list manifests`) or a file")
      ->capture_default_str();
  app.add_option("--robot", options.robot,
                 "robot: a name (see `constrictor list robots`) or a file (default: the manifest's)");
  app.add_option("--config", options.config_files,
                 "NAME=FILE: configuration file of a component, instead of its default; may be repeated")
      ->allow_extra_args(false);
}

namespace {

void add_run_app(CLI::App& app, const std::shared_ptr<RunOptions>& options, Action& action) {
  auto* run = add_subcommand(app, "run", "run a scenario, each component in a process of its own, and write a report",
                             action, options, run_command);
  add_scenario(*run, *options);
  add_file_options(*run, *options);
  run->add_option("--pace", options->pace,
                  "speed of simulated time: lockstep (as fast as possible), realtime (on the wall clock, late "
                  "components\nare not waited for), or a limit such as 2x (0.001x to 1000x real time)")
      ->capture_default_str();
  run->add_flag("--in-process", options->in_process, "host all components in one process");
  run->add_option("--group", options->groups,
                  "host these components, separated by commas, in one process; may be repeated")
      ->allow_extra_args(false)
      ->excludes("--in-process");
  run->add_option("--report", options->report_dir,
                  "directory for the report (default: a new one below runs/); the report of an\n"
                  "earlier run there is replaced, but a recording only with --force");
  run->add_flag("--force", options->force, "replace the recording of an earlier run in the directory of --report");
  run->add_option("--faults", options->faults_file,
                  "file of faults (YAML): samples lost, late, wrong; processes killed, stopped, slow;\nemulated "
                  "devices broken; see\n"
                  "components/lib/faults/README.md");
  run->add_option("--max-sim-time", options->max_sim_time_s,
                  "[s] end the run at this simulated time (default: no limit but the report component's)")
      ->check(number(0.0, 1e6, "s"));
  auto* view = run->add_flag("--view", options->view,
                             "start `constrictor dashboard` with the run, print its address, open it in a browser if\n"
                             "there is a display, and end it with the run");
  run->add_option("--view-port", options->view_port, "TCP port of --view; 0: a free one")
      ->capture_default_str()
      ->check(whole_number(0, 65535))
      ->needs(view);
  auto* record = run->add_flag("--record", options->record,
                               "record all topics of the run's domain in run.mcap, in the report directory");
  run->add_option("--images", options->images,
                  "what --record records of images: on (whole), off (nothing), recompute (without their pixels,\n"
                  "which `constrictor replay --restore` computes again)")
      ->capture_default_str()
      ->check(one_of({"on", "off", "recompute"}))
      ->needs(record);
  run->add_flag("--no-checkpoints", options->no_checkpoints,
                "keep no checkpoints: if the process of the plant dies, the run is lost");
  run->add_option(
      "--secure", options->secure,
      "use DDS Security with the identities in this folder (constrictor keys); without it everybody who can\n"
      "send packets to the domain can read the run");
  run->add_option("--domain", options->domain, "DDS domain, 0 to 229 (default: the first free one of 1 to 100)")
      ->envname("CONSTRICTOR_DOMAIN")
      ->check(whole_number(0, 229));
  auto* resume =
      run->add_option("--resume", options->resume_dir,
                      "report directory of a run that was interrupted: continue it; only --domain and --view "
                      "may be given in addition")
          ->check(existing_folder());
  for (CLI::Option* other : run->get_options()) {
    const std::string name = other->get_name();
    if (other != resume && name != "--domain" && name != "--help" && !name.starts_with("--view"))
      resume->excludes(other);
  }
  run->footer(
      "Checks all files first. Then starts the components of a launch manifest in a DDS domain of their own, shows "
      "the\n"
      "progress, restarts processes that died, and ends when the mission ends. The report directory then contains\n"
      "report.json, figure.png, hashes.bin (for `constrictor diff`), run.mcap (with --record) and logs/.\n"
      "In lock-step the result depends only on scenario, seed, robot and configurations; grouping, pace, load, killed\n"
      "processes and hosts do not change it.\n"
      "The first Ctrl-C (or SIGTERM) ends the run in order and writes the complete report; the second kills all\n"
      "processes. If the launcher is killed, its terminal is closed, a process fails or the computer stops, --resume\n"
      "continues the run with the same result; a reboot loses at most the last 10 s of wall time.\n\n"
      "EXAMPLES\n"
      "  constrictor run\n"
      "  constrictor run line --seed 7 --report /tmp/seven\n"
      "  constrictor run --in-process --pace realtime\n"
      "  constrictor run --pace 1x --view                        # watch and drive it in a browser\n"
      "  constrictor run --resume /tmp/seven                     # the launcher was killed: go on\n"
      "  constrictor run --group physics,camera --group navigation,control\n"
      "  constrictor run --manifest manual                       # no planner: drive with `constrictor teleop`\n"
      "  constrictor run --manifest my_hosts.yaml                # on several hosts, see deploy/README.md\n"
      "  constrictor run --config planner=mine.yaml\n\n"
      "EXIT STATUS\n"
      "  0 the mission succeeded; 1 it did not; 64 wrong usage; 70 a process failed; 75 a process waited too long for\n"
      "  another one; 76 a process was refused; 78 wrong configuration; 129 its terminal was closed; 130 ended by\n"
      "  Ctrl-C, 143 by SIGTERM or `constrictor end`, before the mission succeeded\n\n"
      "FILES\n"
      "  runs/                          reports, unless --report names another directory\n"
      "  $XDG_RUNTIME_DIR/constrictor/  notes by which other commands find the run\n\n"
      "ENVIRONMENT\n"
      "  CONSTRICTOR_DOMAIN  the domain, like --domain\n"
      "  CONSTRICTOR_DATA    directory of the default files, instead of the source tree or the install prefix\n"
      "  CYCLONEDDS_URI      DDS configuration; on several hosts, its settings are added to those that the launcher "
      "makes\n"
      "  CONSTRICTOR_SSH     command in place of `ssh`, for example `ssh -F my_config`");
}

int check_command(const RunOptions& options) {
  const LaunchPlan plan = make_launch_plan(options);
  show_warnings(check_components(options, plan));
  fmt::print("no errors: scenario {}, robot {}, {}\n", plan.manifest.scenario_file.string(),
             plan.manifest.robot_file.string(), counted(plan.roster.size(), "component"));
  for (const auto& process : plan.manifest.processes) {
    if (!process.program.empty())
      fmt::print("not checked: the configuration of {}, which program {} hosts\n", process.name(), process.program);
  }
  return exit_status::kOk;
}

void add_check_app(CLI::App& app, const std::shared_ptr<RunOptions>& options, Action& action) {
  auto* check = add_subcommand(app, "check", "check manifest, scenario, robot and all configurations; start no run",
                               action, options, check_command);
  add_scenario(*check, *options);
  add_file_options(*check, *options);
  check->footer(help_footer(
      "Every component reads its own files, as it does at the start of a run. `constrictor run` makes the same check\n"
      "before it starts anything.",
      {"constrictor check", "constrictor check line --robot serpens --seed 7",
       "constrictor check --config planner=mine.yaml"},
      "0 no errors; 64 wrong usage; 78 wrong configuration, with file, line, key, what was found and what is accepted",
      kDataEnvironment));
}

}  // namespace

void add_run(CLI::App& app, Action& action) {
  add_run_app(app, std::make_shared<RunOptions>(), action);
  add_check_app(app, std::make_shared<RunOptions>(), action);
}

}  // namespace constrictor::cli
