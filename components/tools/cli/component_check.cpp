// Runs constrictor_host to find out which components it hosts, and whether their files are correct.
#include <fmt/format.h>
#include <sys/mman.h>
#include <unistd.h>

#include <cerrno>
#include <chrono>
#include <system_error>
#include <thread>

#include "cli/child_process.hpp"
#include "cli/launch_plan.hpp"
#include "cli/program_groups.hpp"
#include "configuration/configuration.hpp"
#include "runtime/component_check.hpp"
#include "runtime/host.hpp"

namespace constrictor::cli {
namespace {

using namespace std::chrono_literals;
constexpr auto kBound = 30s;  // longest time that a program may take; normally 0.1 s
constexpr std::size_t kMostLines = 100;

/// A file in memory for the output of a process.
class MemoryFile {
 public:
  MemoryFile() : descriptor_(::memfd_create("check", MFD_CLOEXEC)) {
    if (descriptor_ < 0) throw std::system_error(errno, std::generic_category(), "memfd_create");
  }
  ~MemoryFile() { ::close(descriptor_); }
  MemoryFile(const MemoryFile&) = delete;
  MemoryFile& operator=(const MemoryFile&) = delete;
  [[nodiscard]] std::filesystem::path path() const { return fmt::format("/proc/self/fd/{}", descriptor_); }

 private:
  int descriptor_;
};

struct HostOutput {
  ChildExit exit;
  std::vector<std::string> lines;  ///< lines of standard output and standard error together
};

/// Runs a program of this build to its end, by default constrictor_host. Throws std::runtime_error if it does not end
/// within kBound. variables are NAME=VALUE, as in a process's `environment` of a manifest.
HostOutput run_program(std::vector<std::string> arguments, const std::string& program = "constrictor_host",
                       const std::vector<std::string>& variables = {}) {
  arguments.insert(arguments.begin(), (program_folder() / program).string());
  const MemoryFile output;
  ChildProcess host(arguments, with_variables(run_environment(), variables), output.path());
  const auto end = std::chrono::steady_clock::now() + kBound;
  while (!host.poll()) {
    if (std::chrono::steady_clock::now() > end)
      throw std::runtime_error(fmt::format("{} {} did not end within {} s", program, arguments[1], kBound.count()));
    std::this_thread::sleep_for(1ms);
  }
  return {*host.poll(), last_lines(output.path(), 0, kMostLines)};
}

/// The arguments with which a program checks these components for the run that is planned.
std::vector<std::string> check_arguments(const RunOptions& options, const LaunchPlan& plan,
                                         const std::vector<std::string>& components) {
  return {fmt::format("{}", fmt::join(components, ",")),
          "--check",
          "--robot",
          plan.manifest.robot_file.string(),
          "--scenario",
          plan.manifest.scenario_file.string(),
          "--seed",
          std::to_string(options.seed),
          "--plant",
          plan.manifest.plant,
          "--roster",
          fmt::format("{}", fmt::join(plan.roster, ","))};
}

/// Throws what a failed check has found.
void expect_clean(const HostOutput& output) {
  if (output.exit.clean()) return;
  const std::string errors =
      (output.lines.size() > 1 ? "\n  " : "") + fmt::format("{}", fmt::join(output.lines, "\n  "));
  const int code = output.exit.code().value_or(exit_status::kSoftware);
  if (code == exit_status::kConfiguration || code == exit_status::kUsage) throw ConfigurationError(errors);
  throw std::runtime_error("the check of the components failed: " + output.exit.describe() + ": " + errors);
}

/// Throws ConfigurationError if the program of a component that has a process of its own does not exist.
/// constrictor_host contains every component, so that it can check one whose own program was not built.
void require_own_programs(const LaunchPlan& plan) {
  for (const auto& process : plan.manifest.processes) {
    if (!process.program.empty() || !process.host.empty() || process.components.size() > 1) continue;
    const std::string& component = process.components.front();
    if (is_executable(program_folder() / component)) continue;
    throw ConfigurationError(fmt::format(
        "process {0}: found no program {1}. Build it, for example by the command cmake --build build/release --target "
        "{0}, or host the component in one process with others (--group, --in-process)",
        component, (program_folder() / component).string()));
  }
}

}  // namespace

std::vector<std::string> topics_of(const RunOptions& options, const LaunchPlan& plan, const ProcessPlan& process) {
  const std::string program = process.program.empty() ? "constrictor_host" : process.program;
  for (const auto& component : process.components) {
    if (process.program.empty()) require_component(component);
  }
  const HostOutput output = run_program(
      {fmt::format("{}", fmt::join(process.components, ",")), "--topics", "--robot", plan.manifest.robot_file.string(),
       "--scenario", plan.manifest.scenario_file.string(), "--seed", std::to_string(options.seed)},
      program, process.environment);
  if (output.exit.clean()) return output.lines;
  throw ConfigurationError(fmt::format("{} --topics {}: {}\n  {}", program, process.name(), output.exit.describe(),
                                       fmt::join(output.lines, "\n  ")));
}

std::vector<std::string> ask_host(const std::string& option) {
  const HostOutput output = run_program({option});
  if (!output.exit.clean()) throw std::runtime_error("constrictor_host " + option + ": " + output.exit.describe());
  return output.lines;
}

std::vector<std::string> hosted_components() { return ask_host("--components"); }

std::vector<std::string> check_components(const RunOptions& options, const LaunchPlan& plan) {
  std::vector<std::string> components;
  for (const auto& process : plan.manifest.processes) {
    if (!process.program.empty()) continue;
    for (const auto& component : process.components) {
      if (!process.host.empty() && !is_built(component)) continue;  // checked when it starts on its host
      require_component(component);
      components.push_back(component);
    }
  }
  // A program for one component cannot host a group.
  for (const auto& process : plan.manifest.processes) {
    const bool own = process.host.empty() && program_groups().contains(process.program);
    if (own && process.components.size() > 1) check_program(options, plan, process, process.program, {});
  }
  if (components.empty()) return {};
  std::vector<std::string> arguments = check_arguments(options, plan, components);
  const auto mission = mission_arguments(plan.manifest);
  arguments.insert(arguments.end(), mission.begin(), mission.end());
  if (plan.manifest.real_time || options.pace == "realtime") arguments.emplace_back("--realtime");
  const auto latencies = latency_arguments(plan.manifest);
  arguments.insert(arguments.end(), latencies.begin(), latencies.end());
  const auto configs = config_arguments(plan.manifest, components);
  arguments.insert(arguments.end(), configs.begin(), configs.end());
  const HostOutput output = run_program(std::move(arguments));
  expect_clean(output);
  require_own_programs(plan);
  std::vector<std::string> warnings;
  for (const auto& line : output.lines)
    if (line.starts_with(kWarningMark)) warnings.push_back(line);
  return warnings;
}

void show_warnings(const std::vector<std::string>& warnings) {
  for (const auto& warning : warnings) fmt::print(stderr, "constrictor: {}\n", warning);
}

void check_program(const RunOptions& options, const LaunchPlan& plan, const ProcessPlan& process,
                   const std::string& program, const std::filesystem::path& config) {
  require_program(program, "--program");
  const std::string component = process.components.front();
  std::vector<std::string> arguments = check_arguments(options, plan, process.components);
  if (!config.empty()) arguments.insert(arguments.end(), {"--config", component + "=" + config.string()});
  expect_clean(run_program(std::move(arguments), program, process.environment));
}

}  // namespace constrictor::cli
