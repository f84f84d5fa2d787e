#include "cli/launch_plan.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <charconv>
#include <map>
#include <sstream>
#include <system_error>

#include "cli/program_groups.hpp"
#include "cli/recording/run_files.hpp"
#include "cli/run_record.hpp"
#include "cli/usage.hpp"
#include "component/data_path.hpp"
#include "configuration/closest_name.hpp"
#include "configuration/configuration.hpp"
#include "constrictor/topics.hpp"
#include "robot/robot_model.hpp"
#include "runtime/numeric_profile.hpp"
#include "runtime/pacer.hpp"

namespace constrictor::cli {
namespace {

namespace fs = std::filesystem;

/// False also for a file that cannot be reached, for example because symbolic links form a loop.
bool is_file(const fs::path& file) {
  std::error_code error;
  return fs::is_regular_file(file, error);
}

void require_file(const std::string& what, const fs::path& file) {
  if (is_file(file)) return;
  throw ConfigurationError(fmt::format("{}: found no file {}, accepted a YAML file", what, file.string()));
}

void require_program_of(const ProcessPlan& process) {
  if (process.program.empty() || !process.host.empty()) return;  // another host checks its programs itself
  require_program(process.program, "process " + process.name());
}

/// The faults to inject into the run; the components and topics that they name must exist in this run.
FaultPlan load_faults(const std::string& file, const LaunchPlan& plan) {
  if (file.empty()) return {};
  const RobotModel robot = load_robot(plan.manifest.robot_file);
  std::vector<std::string> beside;
  for (const auto& companion : plan.manifest.beside) beside.push_back(companion.program);
  return load_fault_plan(file, {plan.roster, beside, robot.joints.size(), robot.module_count});
}

void add_config_files(LaunchManifest& manifest, const std::vector<std::string>& roster,
                      const std::vector<std::string>& texts) {
  for (const auto& text : texts) {
    const auto equals = text.find('=');
    if (equals == std::string::npos || equals == 0 || equals + 1 == text.size())
      throw UsageError("--config: found '" + text + "', accepted NAME=FILE");
    const std::string name = text.substr(0, equals);
    if (std::find(roster.begin(), roster.end(), name) == roster.end()) {
      throw ConfigurationError(fmt::format("--config: found component '{}', accepted {}{}", name,
                                           fmt::join(roster, ", "), did_you_mean(name, roster)));
    }
    const auto& file = manifest.config_files[name] = fs::absolute(text.substr(equals + 1));
    require_file("--config " + name, file);
  }
  for (const auto& [name, file] : manifest.config_files) require_file("manifest: config of " + name, file);
}

/// The options of the plant's process for --pace.
std::vector<std::string> pace_arguments(const std::string& pace) {
  if (pace == "lockstep") return {};
  if (pace == "realtime") return {"--realtime"};
  double factor = 0.0;
  const auto [end, error] = std::from_chars(pace.data(), pace.data() + pace.size(), factor);
  const bool is_factor = error == std::errc() && std::string_view(end, pace.data() + pace.size()) == "x";
  if (!is_factor || !(factor > 0) || !Pacer::accepts(factor)) {
    throw UsageError(fmt::format("--pace: found '{}', accepted lockstep, realtime, or a factor from {}x to {}x", pace,
                                 Pacer::kSlowest, Pacer::kFastest));
  }
  return {"--pace", fmt::format("{}", factor)};
}

/// The options of a process for its scheduling.
std::vector<std::string> scheduling_arguments(const Scheduling& scheduling) {
  std::vector<std::string> arguments;
  if (scheduling.priority > 0) arguments.insert(arguments.end(), {"--priority", std::to_string(scheduling.priority)});
  if (scheduling.lock_memory) arguments.emplace_back("--lock-memory");
  if (!scheduling.cpus.empty()) arguments.insert(arguments.end(), {"--cpus", cpus_text(scheduling.cpus)});
  return arguments;
}

/// A suggestion for a name that is not one of `names`: a name of another kind, or a similar one.
std::string hint_of(const std::string& text, const std::vector<std::string>& names) {
  for (const auto& [files, option] :
       {std::pair(kScenarios, ""), std::pair(kManifests, "--manifest "), std::pair(kRobots, "--robot ")}) {
    const auto others = names_of(files);
    if (std::find(others.begin(), others.end(), text) != others.end())
      return fmt::format(" (there is a {} of this name: constrictor run {}{})", files.kind, option, text);
  }
  return did_you_mean(text, names);
}

}  // namespace

std::vector<std::string> names_of(const NamedFiles& files) { return data_names(files.folder); }

fs::path find_file(const std::string& text, const NamedFiles& files) {
  if (is_file(text)) return fs::absolute(text);
  const auto names = names_of(files);
  if (std::find(names.begin(), names.end(), text) != names.end()) return data_path(files.folder / (text + ".yaml"));
  throw ConfigurationError(fmt::format("{}: found '{}', accepted a file or one of {}{}", files.kind, text,
                                       fmt::join(names, ", "), hint_of(text, names)));
}

fs::path program_folder() { return fs::read_symlink("/proc/self/exe").parent_path(); }

LaunchPlan make_launch_plan(const RunOptions& options) {
  pace_arguments(options.pace);  // only checks the option
  LaunchPlan plan;
  LaunchManifest& manifest = plan.manifest = load_manifest(find_file(options.manifest, kManifests));
  plan.roster = manifest.roster();
  if (manifest.real_time && options.pace != "lockstep" && options.pace != "realtime")
    throw UsageError(fmt::format("--pace: found {}, accepted realtime: the plant of manifest {} follows the wall clock",
                                 options.pace, options.manifest));
  for (const auto& process : manifest.processes) {
    const auto& hosted = process.components;
    const bool camera = std::find(hosted.begin(), hosted.end(), topics::kCameraImage.writer) != hosted.end();
    if (options.record && options.images == "recompute" && camera && !process.program.empty())
      throw UsageError(fmt::format(
          "--images: found recompute, accepted on or off: the images of {} cannot be computed again", process.program));
  }
  for (const auto& companion : manifest.beside) require_program(companion.program, "beside");
  if (!options.scenario.empty()) manifest.scenario_file = find_file(options.scenario, kScenarios);
  if (!options.robot.empty()) manifest.robot_file = find_file(options.robot, kRobots);
  require_file("scenario", manifest.scenario_file);
  require_file("robot", manifest.robot_file);
  add_config_files(manifest, plan.roster, options.config_files);
  for (const auto& process : manifest.processes) require_program_of(process);
  if (options.view) require_program("dashboard", "--view");
  plan.faults = load_faults(options.faults_file, plan);
  if (!options.faults_file.empty()) manifest.faults_file = fs::absolute(options.faults_file);
  std::vector<std::vector<std::string>> groups;
  if (options.in_process) {
    for (auto& process : manifest.processes) process.host.clear();
    manifest.hosts.clear();
    groups.push_back(plan.roster);
  }
  for (const auto& group : options.groups) groups.push_back(CLI::detail::split(group, ','));
  regroup(manifest, groups);
  for (auto& process : manifest.processes) {
    const auto& hosted = process.components;
    if (options.no_checkpoints && std::find(hosted.begin(), hosted.end(), manifest.plant) != hosted.end())
      process.restarts = 0;
  }
  return plan;
}

std::vector<std::string> mission_arguments(const LaunchManifest& manifest) {
  const std::string mission = Configuration::load(manifest.scenario_file).one_line("mission");
  return mission.empty() ? std::vector<std::string>{} : std::vector<std::string>{"--mission", mission};
}

CommandLine make_command_line(const RunOptions& options, const LaunchPlan& plan, std::uint32_t domain,
                              const fs::path& report_dir, std::uint64_t run_id, const fs::path& token_file) {
  const LaunchManifest manifest = plan.manifest;
  std::vector<std::string> common = {"--domain",   std::to_string(domain),
                                     "--roster",   fmt::format("{}", fmt::join(plan.roster, ",")),
                                     "--plant",    manifest.plant,
                                     "--robot",    manifest.robot_file.string(),
                                     "--scenario", manifest.scenario_file.string(),
                                     "--seed",     std::to_string(options.seed),
                                     "--output",   report_dir.string(),
                                     "--patience", fmt::format("{}", manifest.patience_s),
                                     "--run-id",   std::to_string(run_id)};
  // A file, because other users can read command lines.
  if (!token_file.empty()) common.insert(common.end(), {"--token-file", token_file.string()});
  const auto mission = mission_arguments(manifest);
  common.insert(common.end(), mission.begin(), mission.end());
  if (!manifest.faults_file.empty()) common.insert(common.end(), {"--faults", manifest.faults_file.string()});
  const auto latencies = latency_arguments(manifest);
  common.insert(common.end(), latencies.begin(), latencies.end());
  if (options.max_sim_time_s > 0)
    common.insert(common.end(), {"--max-sim-time", fmt::format("{}", options.max_sim_time_s)});
  const std::string pace = manifest.real_time ? "realtime" : options.pace;
  std::vector<std::string> of_plant = pace_arguments(pace);
  if (options.record) {
    of_plant.insert(of_plant.end(), {"--record", "--images", options.images});
    for (const auto& [name, file] : recorded_files(absolute_options(options, plan), plan.roster))
      of_plant.insert(of_plant.end(), {"--attach", name + "=" + file.string()});
  }
  if (options.no_checkpoints) of_plant.emplace_back("--no-checkpoints");
  return [=, programs = program_folder()](const ProcessPlan& process, std::uint32_t incarnation) {
    std::vector<std::string> arguments;
    if (process.program.empty() && process.components.size() == 1) {
      arguments = {(programs / process.components.front()).string()};
    } else {
      const std::string program = process.program.empty() ? "constrictor_host" : process.program;
      arguments = {(programs / program).string(), fmt::format("{}", fmt::join(process.components, ","))};
    }
    arguments.insert(arguments.end(), common.begin(), common.end());
    arguments.insert(arguments.end(), {"--incarnation", std::to_string(incarnation)});
    const auto configs = config_arguments(manifest, process.components);
    arguments.insert(arguments.end(), configs.begin(), configs.end());
    if (pace == "realtime") {
      const auto scheduling = scheduling_arguments(process.scheduling);
      arguments.insert(arguments.end(), scheduling.begin(), scheduling.end());
    }
    const auto& hosted = process.components;
    if (std::find(hosted.begin(), hosted.end(), manifest.plant) != hosted.end())
      arguments.insert(arguments.end(), of_plant.begin(), of_plant.end());
    return arguments;
  };
}

std::vector<std::string> run_environment() {
  for (const auto& [name, value] : numeric_environment()) ::setenv(name.c_str(), value.c_str(), 1);
  std::vector<std::string> variables;
  for (char** variable = environ; *variable; ++variable) variables.emplace_back(*variable);
  return variables;
}

std::vector<std::string> with_variables(std::vector<std::string> environment,
                                        const std::vector<std::string>& variables) {
  for (const auto& variable : variables) {
    const std::string name = variable.substr(0, variable.find('=') + 1);
    std::erase_if(environment, [&](const std::string& other) { return other.starts_with(name); });
    environment.push_back(variable);
  }
  return environment;
}

}  // namespace constrictor::cli
