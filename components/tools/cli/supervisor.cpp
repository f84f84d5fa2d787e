#include "cli/supervisor.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <csignal>
#include <thread>

#include "cli/launch_plan.hpp"
#include "cli/log/log_files.hpp"
#include "runtime/host.hpp"

namespace constrictor::cli {
namespace {

using namespace std::chrono_literals;

constexpr std::size_t kLastLines = 5;        // number of lines of a dead process's log that are shown to the user
constexpr int kMostDeathsWithoutTick = 5;    // deaths of one process by its own fault at the same tick
constexpr auto kEndTogether = 3s;            // a process may end this long before "the run is over" arrives
constexpr auto kTermination = 3s;            // from SIGTERM to SIGKILL
constexpr auto kTellWhoIsMissingAfter = 5s;  // while processes end
constexpr auto kChildPoll = 10ms;

/// True if a process that ended with this status would end in the same way after a restart.
bool is_final(int code) {
  return code == exit_status::kUsage || code == exit_status::kConfiguration || code == exit_status::kRefused ||
         code == exit_status::kWaitedTooLong || code == kNoSuchProgram;
}

}  // namespace

Supervisor::Supervisor(LaunchManifest manifest, CommandLine command_line, std::vector<std::string> environment,
                       std::filesystem::path log_dir, Print print, StartChild start_child)
    : manifest_(std::move(manifest)),
      command_line_(std::move(command_line)),
      environment_(std::move(environment)),
      log_dir_(std::move(log_dir)),
      print_(std::move(print)),
      start_child_(std::move(start_child)) {
  for (const auto& plan : manifest_.processes) {
    Supervised process;
    process.plan = plan;
    process.record.name = plan.name();
    process.record.components = plan.components;
    process.record.host = plan.host;
    processes_.push_back(std::move(process));
  }
}

Supervisor::~Supervisor() = default;

std::unique_ptr<Child> Supervisor::start_here(const ProcessPlan&, std::uint32_t, const std::vector<std::string>& argv,
                                              const std::vector<std::string>& environment,
                                              const std::filesystem::path& log) {
  return std::make_unique<ChildProcess>(argv, environment, log);
}

bool Supervisor::is_plant(const Supervised& process) const {
  const auto& components = process.plan.components;
  return std::find(components.begin(), components.end(), manifest_.plant) != components.end();
}

std::filesystem::path Supervisor::log_of(const Supervised& process) const {
  return log_dir_ / (process.record.name + ".log");
}

void Supervisor::start(const std::map<std::string, std::uint32_t>& last_incarnations) {
  std::filesystem::create_directories(log_dir_);
  for (auto& process : processes_) {
    if (last_incarnations.empty()) remove_log(log_of(process));
    const auto last = last_incarnations.find(process.record.name);
    if (last != last_incarnations.end()) process.incarnation = last->second;
    spawn(process);
  }
}

void Supervisor::spawn(Supervised& process) {
  const auto environment = with_variables(environment_, process.plan.environment);
  std::error_code no_log_yet;
  const auto size = std::filesystem::file_size(log_of(process), no_log_yet);
  process.log_offset = no_log_yet ? 0 : size;
  process.child.reset();
  if (is_plant(process)) plant_gone_ = false;
  ++process.incarnation;
  process.child = start_child_(process.plan, process.incarnation, command_line_(process.plan, process.incarnation),
                               environment, log_of(process));
  process.over = false;
}

void Supervisor::fail(const std::string& why, int status) {
  if (state_ == State::kFailed) return;
  state_ = State::kFailed;
  failure_ = why;
  failure_status_ = status;
}

void Supervisor::run_is_at(std::int64_t tick, bool held) {
  if (tick == tick_ && !held) return;
  tick_ = tick;
  for (auto& process : processes_) process.deaths_without_tick = 0;
}

void Supervisor::restart(Supervised& process, const std::string& why, bool own_fault) {
  // Without this limit, a process that always dies in the same step would be restarted forever, and the run would never
  // pass that tick. Processes killed from outside do not count: the run goes on after their restart.
  if (own_fault && ++process.deaths_without_tick >= kMostDeathsWithoutTick) {
    return fail(fmt::format("{} died {} times in a row while the run stood at tick {}; the last time it {}",
                            process.record.name, kMostDeathsWithoutTick, tick_, why),
                exit_status::kSoftware);
  }
  if (process.record.restarts >= static_cast<std::uint32_t>(process.plan.restarts)) {
    return fail(
        fmt::format("{} {}, and the manifest allows {} restarts", process.record.name, why, process.plan.restarts),
        exit_status::kSoftware);
  }
  ++process.record.restarts;
  process.started_at_end = ending_;
  print_(fmt::format("{} {}; restarted as incarnation {}", process.record.name, why, process.incarnation + 1));
  spawn(process);
}

void Supervisor::handle_exit(Supervised& process, const ChildExit& exit) {
  process.over = true;
  process.ended = Clock::now();
  process.record.cpu_s += exit.cpu_s;
  if (exit.clean()) {
    if (!is_plant(process)) return;
    plant_gone_ = true;
    // A member that died after its own end, and was restarted, would wait for the plant for ever. A report that draws
    // finishes its files before it reacts to the signal.
    for (const auto& other : processes_) {
      if (other.started_at_end && other.running()) other.child->signal(SIGTERM);
    }
    return;
  }
  const std::string& name = process.record.name;
  for (const auto& line : last_lines(log_of(process), process.log_offset, kLastLines))
    print_(line.starts_with(name + ": ") ? line : fmt::format("{}: {}", name, line));
  const std::string how = exit.describe();
  const int code = exit.code().value_or(0);
  const bool plant = is_plant(process);
  if (plant && (process.plan.restarts == 0 || is_final(code)))
    return fail(fmt::format("{}, the plant, {}", name, how),
                code && code != kNoSuchProgram ? code : exit_status::kSoftware);
  // Without the plant, the others would not learn that the run is over: it is restarted also after the run's end.
  // As long as the plant runs, a member that dies at the end of the run is restarted: it may have a report to write.
  if (!plant && plant_gone_) {
    return print_(fmt::format("{} {} after the end of the {}", name, how, ending_ ? "run" : "plant"));
  }
  if (is_final(code))
    return fail(fmt::format("{} {}", name, how), code == kNoSuchProgram ? exit_status::kSoftware : code);
  if (state_ == State::kRunning) restart(process, how, !exit.killed_from_outside());
}

void Supervisor::handle_plants_end(const Supervised& plant) {
  if (!plant_gone_ || state_ != State::kRunning) return;
  if (ending_) {
    state_ = State::kEnded;
  } else if (Clock::now() - plant.ended > kEndTogether) {
    // The other processes cannot go on: they wait for a tick that never comes.
    fail(fmt::format("{}, the plant (pid {}), ended before the run did", plant.record.name, plant.child->pid()),
         exit_status::kSoftware);
  }
}

Supervisor::State Supervisor::poll() {
  // Handle the plant first: its end makes other processes end, and these must not be reported as the cause.
  std::stable_partition(processes_.begin(), processes_.end(), [this](const Supervised& p) { return is_plant(p); });
  for (auto& process : processes_) {
    if (!process.running()) continue;
    if (const auto& exit = process.child->poll()) handle_exit(process, *exit);
  }
  for (const auto& process : processes_) {
    if (is_plant(process)) handle_plants_end(process);
  }
  for (auto& process : processes_) {
    const bool ended_alone = !ending_ && !plant_gone_ && process.over && state_ == State::kRunning &&
                             Clock::now() - process.ended > kEndTogether;
    if (!ended_alone) continue;
    restart(process, "ended before the run did", true);
    process.started_at_end = true;  // it may have received the end before the launcher
  }
  return state_;
}

void Supervisor::sample_memory() {
  for (auto& process : processes_) {
    if (!process.running()) continue;
    process.record.max_pss_mib = std::max(process.record.max_pss_mib, process.child->pss_mib());
  }
}

bool Supervisor::all_gone(bool handle_exits) {
  bool gone = true;
  for (auto& process : processes_) {
    if (!process.running()) continue;
    const auto& exit = process.child->poll();
    if (!exit) {
      gone = false;
    } else if (handle_exits) {
      handle_exit(process, *exit);
    } else {
      process.over = true;
      process.record.cpu_s += exit->cpu_s;
    }
  }
  return gone;
}

void Supervisor::finish(std::chrono::seconds grace, const std::function<bool()>& give_up) {
  const auto start = Clock::now();
  bool told = false;
  while (!all_gone(true) && Clock::now() - start < grace) {
    if (give_up()) return;
    if (!told && Clock::now() - start > kTellWhoIsMissingAfter) {
      told = true;
      for (const auto& process : processes_) {
        if (!process.over) print_("waiting for " + process.record.name + " to end");
      }
    }
    std::this_thread::sleep_for(kChildPoll);
  }
  for (const auto& process : processes_) {
    if (!process.over) {
      fail(fmt::format("{} did not end within {} s of the run's end", process.record.name, grace.count()),
           exit_status::kSoftware);
    }
  }
  stop();
}

void Supervisor::signal(const std::string& component, int number) const {
  for (const auto& process : processes_) {
    const auto& hosted = process.plan.components;
    if (process.running() && std::find(hosted.begin(), hosted.end(), component) != hosted.end())
      process.child->signal(number);
  }
}

void Supervisor::signal_all(int number) const {
  for (const auto& process : processes_) {
    if (process.running()) process.child->signal(number);
  }
}

void Supervisor::stop(bool at_once) {
  if (!at_once) {
    signal_all(SIGTERM);
    signal_all(SIGCONT);  // a process stopped by SIGSTOP could not handle SIGTERM
    const auto start = Clock::now();
    while (!all_gone(false) && Clock::now() - start < kTermination) std::this_thread::sleep_for(kChildPoll);
  }
  signal_all(SIGKILL);
  while (!all_gone(false)) std::this_thread::sleep_for(1ms);
}

std::vector<ProcessRecord> Supervisor::records() const {
  std::vector<ProcessRecord> records;
  for (const auto& plan : manifest_.processes) {
    const auto process = std::find_if(processes_.begin(), processes_.end(),
                                      [&](const Supervised& each) { return each.record.name == plan.name(); });
    records.push_back(process->record);
  }
  return records;
}

}  // namespace constrictor::cli
