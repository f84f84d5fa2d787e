// `constrictor swap`: another program takes the place of a component while the run goes on.
#include <fmt/format.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <chrono>
#include <csignal>
#include <memory>
#include <thread>

#include "cli/launch_plan.hpp"
#include "cli/run_record.hpp"
#include "cli/subcommands.hpp"
#include "cli/swap.hpp"
#include "cli/usage.hpp"
#include "client/run_registry.hpp"
#include "configuration/closest_name.hpp"
#include "cyclone/domain.hpp"
#include "cyclone/endpoint.hpp"
#include "runtime/host.hpp"

namespace constrictor::cli {
namespace {

namespace fs = std::filesystem;
using namespace std::chrono_literals;
using Clock = std::chrono::steady_clock;

constexpr auto kStatusBound = 5s;
constexpr auto kSwapBound = 30s;

struct SwapOptions {
  std::optional<std::uint32_t> domain;
  std::string component, program, config;
};

/// The newest status of the component, as its process publishes it; waits for one with an incarnation from `least`.
std::optional<msg::ComponentStatus> status_of(const dds::Reader<msg::ComponentStatus>& reader,
                                              const SwapOptions& options, std::uint32_t least,
                                              std::chrono::seconds bound) {
  std::optional<msg::ComponentStatus> found;
  for (const auto end = Clock::now() + bound; !found && Clock::now() < end; std::this_thread::sleep_for(20ms)) {
    reader.take([&](const msg::ComponentStatus& status) {
      if (options.component == status.component && status.incarnation >= least &&
          status.state == msg::kComponentRunning)
        found = status;
    });
  }
  return found;
}

const ProcessPlan& process_of(const SwapOptions& options, const LaunchPlan& plan) {
  for (const auto& process : plan.manifest.processes) {
    if (std::find(process.components.begin(), process.components.end(), options.component) == process.components.end())
      continue;
    if (process.components.size() != 1 || !process.host.empty())
      throw UsageError(
          fmt::format("swap: found {} in the process {}, accepted a component with a process of its own on "
                      "this host",
                      options.component, process.name()));
    return process;
  }
  throw UsageError(fmt::format("swap: found component '{}', accepted one of {}{}", options.component,
                               fmt::join(plan.roster, ", "), did_you_mean(options.component, plan.roster)));
}

int swap(const SwapOptions& options) {
  const RunNote run = find_run(options.domain);
  const RunRecord record = read_run_record(run.report_dir);
  const LaunchPlan plan = make_launch_plan(record.options);
  const ProcessPlan& process = process_of(options, plan);
  if (options.component == plan.manifest.plant)
    throw UsageError(fmt::format("swap: found the plant {}, accepted another member", options.component));
  if (!plan.manifest.real_time && record.options.pace != "realtime")
    throw UsageError(
        fmt::format("swap: found a run with --pace {}, accepted realtime: in lock-step the run would not stay "
                    "repeatable",
                    record.options.pace));
  const Swap wanted{options.program, options.config.empty() ? fs::path() : fs::absolute(options.config)};
  check_program(record.options, plan, process, wanted.program, wanted.config);

  const dds::Domain domain(run.domain);
  const auto statuses = dds::Reader<msg::ComponentStatus>::member(domain.participant(), barrier_topics::kStatus.name);
  const auto before = status_of(statuses, options, 1, kStatusBound);
  if (!before) throw CommandError(fmt::format("run {}: {} publishes no status", run.domain, options.component));
  write_swap(run.report_dir, process, wanted);
  // The launcher restarts a process that was killed, and then starts the other program.
  if (::kill(before->pid, SIGKILL) != 0)
    throw CommandError(
        fmt::format("run {}: cannot end the process {} of {}", run.domain, before->pid, options.component));
  const auto after = status_of(statuses, options, before->incarnation + 1, kSwapBound);
  if (!after)
    throw CommandError(fmt::format("run {}: {} has not come back within {} s; see {}", run.domain, options.component,
                                   kSwapBound.count(), (run.report_dir / "logs" / (process.name() + ".log")).string()));
  fmt::print("run {}: {} is now {} (incarnation {}, pid {})\n", run.domain, options.component, options.program,
             after->incarnation, after->pid);
  return exit_status::kOk;
}

}  // namespace

void add_swap(CLI::App& app, Action& action) {
  auto options = std::make_shared<SwapOptions>();
  auto* sub = add_subcommand(app, "swap", "let another program take the place of a component while the run goes on",
                             action, options, swap);
  sub->add_option("COMPONENT", options->component, "member of the run with a process of its own")->required();
  sub->add_option("--program", options->program, "program of this build, or an absolute path")->required();
  sub->add_option("--config", options->config, "its configuration (default: its own)")->check(existing_file());
  add_run_option(*sub, options->domain);
  sub->footer(help_footer(
      "The component's process is killed, and the launcher starts the other program as its next incarnation. It "
      "begins\n"
      "without the memory of its predecessor. The program and its configuration are checked before. The run must have\n"
      "the pace realtime, because a run in lock-step would not stay repeatable.",
      {"constrictor swap camera --program video_capture --config my_camera.yaml"},
      "0 done; 64 wrong usage; 70 no run, or the new program does not come; 78 the program's configuration is wrong"));
}

}  // namespace constrictor::cli
