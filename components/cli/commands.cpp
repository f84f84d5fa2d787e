#include "cli/commands.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <chrono>
#include <csignal>
#include <cstdio>
#include <string>
#include <thread>
#include <vector>

#include "cli/run_difference.hpp"
#include "cli/run_observer.hpp"
#include "cli/run_registry.hpp"
#include "runtime/domain_claim.hpp"
#include "runtime/host.hpp"

namespace constrictor::cli {
namespace {

using namespace std::chrono_literals;
using Clock = std::chrono::steady_clock;

constexpr auto kPoll = 20ms;

void print_component(const std::string& name, const RunView& view) {
  const auto found = view.components.find(name);
  if (found == view.components.end()) {
    fmt::print("{:<14} not heard of\n", name);
    return;
  }
  const msg::ComponentStatus& status = found->second;
  fmt::print("{:<14} {:<9} {:>9} {:>5} {:>10.0f} {:>10.0f} {:>8.1f} {:>9} {:>8} {:>8}  {}\n", name,
             component_state_name(status.state), status.tick, status.incarnation, status.step_time_p50_us,
             status.step_time_p99_us, status.cpu_s, view.overruns.at(name), view.refused.at(name), status.pid, status.host);
  if (*status.last_refusal) fmt::print("{:<14} last refusal: {}\n", "", status.last_refusal);
}

}  // namespace

int status_command(std::optional<std::uint32_t> domain) {
  const auto runs = live_runs();
  for (const auto& run : runs) {
    fmt::print("run {}: {} seed {}, pid {}, report in {}\n", run.domain, run.scenario, run.seed, run.pid, run.report_dir.string());
  }
  if (runs.size() > 1 && !domain) {
    fmt::print("choose one with --run for its components\n");
    return exit_status::kOk;
  }
  const RunNote run = find_run(domain);
  RunObserver observer(run.domain);
  // Statuses are kept for late readers: they come as soon as the writers are found.
  const auto end = Clock::now() + 1500ms;
  while (observer.view().components.size() < run.roster.size() && Clock::now() < end) {
    for (const auto& line : observer.poll()) fmt::print("{}\n", line);
    std::this_thread::sleep_for(kPoll);
  }
  observer.poll();
  fmt::print("{}\n\n", progress_line(observer.view(), 0).substr(0, progress_line(observer.view(), 0).rfind(',')));
  fmt::print("{:<14} {:<9} {:>9} {:>5} {:>10} {:>10} {:>8} {:>9} {:>8} {:>8}  {}\n", "component", "state", "tick", "inc.",
             "p50 [us]", "p99 [us]", "cpu [s]", "overruns", "refused", "pid", "host");
  for (const auto& name : run.roster) print_component(name, observer.view());
  return exit_status::kOk;
}

int end_command(std::optional<std::uint32_t> domain) {
  const RunNote run = find_run(domain);
  ::kill(run.pid, SIGTERM);
  const auto end = Clock::now() + 20s;
  while (domain_claimed(run.domain)) {
    if (Clock::now() > end) {
      std::fprintf(stderr, "end: run %u (pid %d) did not end within 20 s\n", run.domain, run.pid);
      return exit_status::kWaitedTooLong;
    }
    std::this_thread::sleep_for(kPoll);
  }
  fmt::print("run {} ended\n", run.domain);
  return exit_status::kOk;
}

int diff_command(const std::filesystem::path& a, const std::filesystem::path& b) {
  const auto difference = compare_runs(a, b);
  if (!difference) {
    fmt::print("equal\n");
    return 0;
  }
  fmt::print("first difference: tick {}, component {}, topic {}", difference->tick, difference->component, difference->topic);
  if (!difference->field.empty()) fmt::print(", field {}", difference->field);
  fmt::print("\n  {}: {}\n  {}: {}\n", a.string(), difference->a, b.string(), difference->b);
  if (difference->field.empty() && difference->a.rfind("hash", 0) == 0) {
    fmt::print("  (runs recorded with `constrictor run --record` show the field and its values)\n");
  }
  return 1;
}

int host_command(int argc, char** argv) {
  const std::filesystem::path program = std::filesystem::read_symlink("/proc/self/exe").parent_path() / "constrictor_host";
  std::string names;
  int next = 0;
  for (; next < argc && argv[next][0] != '-'; ++next) names += (names.empty() ? "" : ",") + std::string(argv[next]);
  std::vector<std::string> arguments = {program.string()};
  if (!names.empty()) arguments.push_back(names);
  arguments.insert(arguments.end(), argv + next, argv + argc);
  std::vector<char*> pointers;
  for (auto& argument : arguments) pointers.push_back(argument.data());
  pointers.push_back(nullptr);
  ::execv(program.c_str(), pointers.data());
  std::perror(program.c_str());
  return exit_status::kSoftware;
}

}  // namespace constrictor::cli
