// Derives the processes of a run from the options of `constrictor run`: their files, components and arguments.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "cli/manifest.hpp"
#include "faults/fault_plan.hpp"

namespace constrictor::cli {

struct RunOptions {
  std::string scenario;                 ///< name in sim/scenarios or a path; empty: the scenario of the manifest
  std::string manifest = "case_study";  ///< name in deploy or a path
  std::string robot;                    ///< name in components/lib/robot or a path; empty: the robot of the manifest
  std::uint64_t seed = 1;
  std::string pace = "lockstep";          ///< "lockstep", "realtime" or "2x"
  bool in_process = false;                ///< every component in one process
  std::vector<std::string> groups;        ///< each a comma-separated list of components that share a process
  std::filesystem::path report_dir;       ///< empty: a new folder in runs/
  bool force = false;                     ///< a recording in the folder may be replaced
  double max_sim_time_s = 0;              ///< [s] simulated time at which the run ends; 0: no limit
  bool no_checkpoints = false;            ///< the plant keeps none: it is not restarted, and the run not resumed
  bool record = false;                    ///< record all topics in run.mcap
  std::string images = "on";              ///< of the recording: "on", "off" or "recompute"
  bool view = false;                      ///< start the dashboard with the run
  std::uint16_t view_port = 8765;         ///< of this dashboard; 0: any free one
  std::filesystem::path resume_dir;       ///< folder of a run to continue; empty: a new run
  std::optional<std::uint32_t> domain;    ///< empty: the first free domain
  std::vector<std::string> config_files;  ///< "NAME=FILE"
  std::filesystem::path secure;           ///< folder that `constrictor keys` has made; empty: without DDS Security
  std::filesystem::path faults_file;      ///< faults to inject into the run; empty: none
};

/// A folder of the project with YAML files that users choose by name.
struct NamedFiles {
  const char* kind;              ///< "scenario"
  std::filesystem::path folder;  ///< relative to the project's root
  const char* list_argument;     ///< argument of `constrictor list` that lists these names
};
inline const NamedFiles kScenarios{"scenario", "sim/scenarios", "scenarios"};
inline const NamedFiles kManifests{"manifest", "deploy", "manifests"};
inline const NamedFiles kRobots{"robot", "components/lib/robot", "robots"};

/// The names that users may choose, sorted.
[[nodiscard]] std::vector<std::string> names_of(const NamedFiles& files);

/// The file with this path. If there is no such file: the file of the project with this name. Throws ConfigurationError
/// if there is neither.
[[nodiscard]] std::filesystem::path find_file(const std::string& text, const NamedFiles& files);

struct LaunchPlan {
  FaultPlan faults;
  LaunchManifest manifest;          ///< components as --in-process and --group distribute them
  std::vector<std::string> roster;  ///< in the manifest's order, which does not depend on the distribution
};

/// Chooses files and processes. Throws UsageError if the text of an option is invalid, and ConfigurationError if a
/// file, program or component does not exist. May start constrictor_host for its descriptions of components, but starts
/// no process of the run.
[[nodiscard]] LaunchPlan make_launch_plan(const RunOptions& options);

/// Lets the components that constrictor_host hosts read all of their files, in one process that joins no run.
/// Components with a program of their own are not checked, but whether a program of this project can host its group of
/// components is. Throws ConfigurationError with one line for each component whose files are wrong, or if the program
/// of a component on this host was not built. Returns the warnings: what the run may begin with, and often fails with.
[[nodiscard]] std::vector<std::string> check_components(const RunOptions& options, const LaunchPlan& plan);

/// Prints them to standard error, which has no results.
void show_warnings(const std::vector<std::string>& warnings);

/// The same for one process that gets another program. `config`: of its component; empty: the default.
void check_program(const RunOptions& options, const LaunchPlan& plan, const ProcessPlan& process,
                   const std::string& program, const std::filesystem::path& config);

/// The topics that a process of the plan uses, as its program prints them with --topics. Throws ConfigurationError if
/// the program does not print them.
[[nodiscard]] std::vector<std::string> topics_of(const RunOptions& options, const LaunchPlan& plan,
                                                 const ProcessPlan& process);

/// The components that constrictor_host can host: all components of this build. Throws std::runtime_error if it does
/// not start.
[[nodiscard]] std::vector<std::string> hosted_components();

/// The lines that constrictor_host prints with this option. Throws std::runtime_error if it fails.
[[nodiscard]] std::vector<std::string> ask_host(const std::string& option);

/// Arguments that give a component the mission of the scenario; no arguments if the scenario has no mission. The
/// planner receives its mission in this way, because it must not read the scenario.
[[nodiscard]] std::vector<std::string> mission_arguments(const LaunchManifest& manifest);

/// `token_file`: with the run's token; empty: the run has none.
[[nodiscard]] CommandLine make_command_line(const RunOptions& options, const LaunchPlan& plan, std::uint32_t domain,
                                            const std::filesystem::path& report_dir, std::uint64_t run_id,
                                            const std::filesystem::path& token_file = {});

/// The complete environment for a new process: that of this process with the settings of the numeric profile.
[[nodiscard]] std::vector<std::string> run_environment();

/// `environment` ("NAME=VALUE") in which `variables` replace those of the same name.
[[nodiscard]] std::vector<std::string> with_variables(std::vector<std::string> environment,
                                                      const std::vector<std::string>& variables);

/// The folder of this program and of all component programs.
[[nodiscard]] std::filesystem::path program_folder();

}  // namespace constrictor::cli
