#include "cli/supervisor.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <csignal>
#include <thread>

#include "runtime/host.hpp"

namespace constrictor::cli {
namespace {

using namespace std::chrono_literals;

constexpr std::size_t kLastWords = 5;             // lines
constexpr int kMostVainDeaths = 5;                // of one process, while the run stands at one tick
constexpr auto kEndTogether = 3s;                 // a process may end this long before the plant's word that the run is over arrives
constexpr auto kTermination = 3s;                 // from SIGTERM to SIGKILL
constexpr auto kPoll = 10ms;

/// A death that a restart would only repeat.
bool is_hopeless(int code) {
  return code == exit_status::kUsage || code == exit_status::kConfiguration || code == exit_status::kRefused ||
         code == exit_status::kWaitedTooLong || code == 127;
}

}  // namespace

Supervisor::Supervisor(LaunchManifest manifest, CommandLine command_line, std::vector<std::string> environment,
                       std::filesystem::path log_dir, Say say)
    : manifest_(std::move(manifest)),
      command_line_(std::move(command_line)),
      environment_(std::move(environment)),
      log_dir_(std::move(log_dir)),
      say_(std::move(say)) {
  for (const auto& plan : manifest_.processes) {
    Member member;
    member.plan = plan;
    member.record.name = plan.name();
    member.record.components = plan.components;
    members_.push_back(std::move(member));
  }
}

Supervisor::~Supervisor() = default;

bool Supervisor::is_plant(const Member& member) const {
  return std::count(member.plan.components.begin(), member.plan.components.end(), manifest_.plant) > 0;
}

std::filesystem::path Supervisor::log_of(const Member& member) const { return log_dir_ / (member.record.name + ".log"); }

void Supervisor::start() {
  std::filesystem::create_directories(log_dir_);
  for (auto& member : members_) {
    std::error_code ignored;
    std::filesystem::remove(log_of(member), ignored);
    spawn(member);
  }
}

void Supervisor::spawn(Member& member) {
  std::vector<std::string> environment = environment_;
  for (const auto& variable : member.plan.environment) {
    const std::string name = variable.substr(0, variable.find('=') + 1);
    std::erase_if(environment, [&](const std::string& other) { return other.rfind(name, 0) == 0; });
    environment.push_back(variable);
  }
  std::error_code no_log_yet;
  const auto size = std::filesystem::file_size(log_of(member), no_log_yet);
  member.log_offset = no_log_yet ? 0 : size;
  member.child.clear();
  member.child.emplace_back(command_line_(member.plan, ++member.incarnation), environment, log_of(member));
  member.over = false;
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
  for (auto& member : members_) member.vain_deaths = 0;
}

void Supervisor::restart(Member& member, const std::string& why, bool in_vain) {
  // No tick passes a step that its member always dies of. Whoever is killed and comes back lets the run go on, however often.
  if (in_vain && ++member.vain_deaths >= kMostVainDeaths) {
    return fail(fmt::format("{} died {} times in a row while the run stood still; last: {}", member.record.name, kMostVainDeaths, why),
                exit_status::kSoftware);
  }
  if (member.record.restarts >= static_cast<std::uint32_t>(member.plan.restarts)) {
    return fail(fmt::format("{} {} and was restarted {} times already", member.record.name, why, member.record.restarts),
                exit_status::kSoftware);
  }
  ++member.record.restarts;
  say_(fmt::format("{} {}; restarted as incarnation {}", member.record.name, why, member.incarnation + 1));
  spawn(member);
}

void Supervisor::take_exit(Member& member, const ChildExit& exit) {
  member.over = true;
  member.ended = Clock::now();
  member.record.cpu_s += exit.cpu_s;
  if (exit.clean()) {
    plant_gone_ = plant_gone_ || is_plant(member);
    return;
  }
  for (const auto& line : last_lines(log_of(member), member.log_offset, kLastWords)) say_(member.record.name + ": " + line);
  const std::string how = exit.describe();
  const int code = exit.code().value_or(0);
  if (is_plant(member)) return fail(fmt::format("{}, the plant, ended: {}", member.record.name, how), code ? code : exit_status::kSoftware);
  if (ending_ || plant_gone_) return say_(fmt::format("{} {} after the {}'s end", member.record.name, how, ending_ ? "run" : "plant"));
  if (is_hopeless(code)) return fail(fmt::format("{} ended: {}", member.record.name, how), code == 127 ? exit_status::kSoftware : code);
  if (state_ == State::kRunning) restart(member, how.rfind("killed", 0) == 0 ? "was " + how : "ended: " + how, !exit.killed_from_outside());
}

void Supervisor::take_plants_end(const Member& plant) {
  if (!plant_gone_ || state_ != State::kRunning) return;
  if (ending_) state_ = State::kEnded;
  else if (Clock::now() - plant.ended > kEndTogether) {
    // Nobody else can go on: they would wait for a tick that never comes.
    fail(fmt::format("{}, the plant (pid {}), ended before the run did", plant.record.name, plant.child.front().pid()), exit_status::kSoftware);
  }
}

Supervisor::State Supervisor::poll() {
  // The plant first: what follows from its end must not look like somebody else's failure.
  std::stable_partition(members_.begin(), members_.end(), [this](const Member& member) { return is_plant(member); });
  for (auto& member : members_) {
    if (member.over || member.child.empty()) continue;
    if (const auto& exit = member.child.front().poll()) take_exit(member, *exit);
  }
  for (const auto& member : members_) {
    if (is_plant(member)) take_plants_end(member);
  }
  for (auto& member : members_) {
    const bool ended_alone = !ending_ && !plant_gone_ && member.over && state_ == State::kRunning && Clock::now() - member.ended > kEndTogether;
    if (ended_alone) restart(member, "ended before the run did", true);
  }
  return state_;
}

void Supervisor::sample_memory() {
  for (auto& member : members_) {
    if (member.over || member.child.empty()) continue;
    member.record.max_pss_mib = std::max(member.record.max_pss_mib, member.child.front().pss_mib());
  }
}

bool Supervisor::all_gone(bool report_deaths) {
  bool gone = true;
  for (auto& member : members_) {
    if (member.over || member.child.empty()) continue;
    const auto& exit = member.child.front().poll();
    if (!exit) {
      gone = false;
    } else if (report_deaths) {
      take_exit(member, *exit);
    } else {
      member.over = true;
      member.record.cpu_s += exit->cpu_s;
    }
  }
  return gone;
}

void Supervisor::finish(std::chrono::seconds grace) {
  const auto start = Clock::now();
  bool told = false;
  while (!all_gone(true) && Clock::now() - start < grace) {
    if (!told && Clock::now() - start > 5s) {
      told = true;
      for (const auto& member : members_) {
        if (!member.over) say_("waiting for " + member.record.name + " to end");
      }
    }
    std::this_thread::sleep_for(kPoll);
  }
  for (const auto& member : members_) {
    if (!member.over) fail(member.record.name + " did not end with the run", exit_status::kSoftware);
  }
  stop();
}

void Supervisor::stop(bool at_once) {
  const auto tell_all = [this](int number) {
    for (auto& member : members_) {
      if (!member.over && !member.child.empty()) member.child.front().signal(number);
    }
  };
  if (!at_once) {
    tell_all(SIGTERM);
    tell_all(SIGCONT);  // a stopped process could not obey
    const auto start = Clock::now();
    while (!all_gone(false) && Clock::now() - start < kTermination) std::this_thread::sleep_for(kPoll);
  }
  tell_all(SIGKILL);
  while (!all_gone(false)) std::this_thread::sleep_for(1ms);
}

std::vector<ProcessRecord> Supervisor::records() const {
  std::vector<ProcessRecord> records;
  for (const auto& plan : manifest_.processes) {
    const auto member = std::find_if(members_.begin(), members_.end(), [&](const Member& m) { return m.record.name == plan.name(); });
    records.push_back(member->record);
  }
  return records;
}

}  // namespace constrictor::cli
