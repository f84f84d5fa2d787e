#include "cli/run_command.hpp"

#include <fmt/chrono.h>
#include <fmt/format.h>
#include <poll.h>
#include <sys/signalfd.h>
#include <unistd.h>

#include <chrono>
#include <csignal>
#include <cstdio>
#include <ctime>
#include <random>

#include "cli/manifest.hpp"
#include "cli/run_observer.hpp"
#include "cli/run_registry.hpp"
#include "cli/run_report.hpp"
#include "cli/supervisor.hpp"
#include "cli/usage.hpp"
#include "configuration/configuration.hpp"
#include "runtime/domain_claim.hpp"
#include "runtime/host.hpp"
#include "runtime/numeric_profile.hpp"
#include "runtime/pacer.hpp"
#include "runtime/share.hpp"

namespace constrictor::cli {
namespace {

namespace fs = std::filesystem;
using namespace std::chrono_literals;
using Clock = std::chrono::steady_clock;

constexpr auto kMemoryEvery = 2s;
constexpr auto kProgressEvery = 5s;      // where the output is no terminal
constexpr auto kEndGrace = 60s;          // the report still draws its figure when the plant has ended

/// A name in `folder` of the project, or a path.
fs::path resolve(const std::string& text, const fs::path& folder, const char* what) {
  if (fs::exists(text)) return fs::absolute(text);
  const fs::path named = share_path(folder / (text + ".yaml"));
  if (fs::exists(named)) return named;
  throw ConfigurationError(fmt::format("{}: found '{}', accepted a file or a name in {}", what, text, named.parent_path().string()));
}

std::vector<std::string> pace_arguments(const std::string& pace) {
  if (pace == "lockstep") return {};
  if (pace == "realtime") return {"--realtime"};
  char* end = nullptr;
  const double factor = std::strtod(pace.c_str(), &end);
  if (end == pace.c_str() || std::string(end) != "x" || !(factor > 0 && Pacer::accepts(factor))) {
    throw UsageError(fmt::format("--pace: found '{}', accepted lockstep, realtime, or a factor such as 2x ({}x to {}x)", pace, Pacer::kSlowest,
                                 Pacer::kFastest));
  }
  return {"--pace", fmt::format("{}", factor)};
}

/// This process's environment with the run's numeric profile.
std::vector<std::string> run_environment() {
  for (const auto& [name, value] : numeric_environment()) ::setenv(name.c_str(), value.c_str(), 1);
  std::vector<std::string> variables;
  for (char** variable = environ; *variable; ++variable) variables.emplace_back(*variable);
  return variables;
}

/// Signals as something to wait for; blocked in this thread and in those it starts.
class SignalQueue {
 public:
  SignalQueue() {
    ::sigemptyset(&set_);
    for (const int number : {SIGINT, SIGTERM, SIGHUP, SIGCHLD}) ::sigaddset(&set_, number);
    ::pthread_sigmask(SIG_BLOCK, &set_, &before_);
    descriptor_ = ::signalfd(-1, &set_, SFD_CLOEXEC | SFD_NONBLOCK);
  }
  ~SignalQueue() {
    ::close(descriptor_);
    ::pthread_sigmask(SIG_SETMASK, &before_, nullptr);
  }
  SignalQueue(const SignalQueue&) = delete;
  SignalQueue& operator=(const SignalQueue&) = delete;
  /// Waits for a signal, at most so long; returns one that asks to end, or 0.
  int wait(std::chrono::milliseconds bound) const {
    pollfd descriptor{descriptor_, POLLIN, 0};
    ::poll(&descriptor, 1, static_cast<int>(bound.count()));
    int wish = 0;
    for (signalfd_siginfo info{}; ::read(descriptor_, &info, sizeof(info)) == sizeof(info);) {
      if (info.ssi_signo != SIGCHLD) wish = static_cast<int>(info.ssi_signo);
    }
    return wish;
  }

 private:
  sigset_t set_{};
  sigset_t before_{};
  int descriptor_ = -1;
};

/// One line that rewrites itself on a terminal; otherwise a line now and then.
class ProgressDisplay {
 public:
  void show(const std::string& line) {
    const auto now = Clock::now();
    if (!terminal_ && (now - shown_ < kProgressEvery)) return;
    shown_ = now;
    if (terminal_) std::printf("\r\033[K%s", line.c_str());
    else std::printf("%s\n", line.c_str());
    std::fflush(stdout);
  }
  /// A line that stays.
  void say(const std::string& line) {
    std::printf("%s%s\n", terminal_ ? "\r\033[K" : "", line.c_str());
    std::fflush(stdout);
  }

 private:
  bool terminal_ = ::isatty(STDOUT_FILENO) == 1;
  Clock::time_point shown_ = Clock::now();
};

LaunchManifest make_manifest(const RunOptions& options) {
  LaunchManifest manifest = load_manifest(resolve(options.manifest, "deploy", "--manifest"));
  if (!options.scenario.empty()) manifest.scenario_file = resolve(options.scenario, "sim/scenarios", "SCENARIO");
  if (!options.robot.empty()) manifest.robot_file = resolve(options.robot, "components/robot", "--robot");
  for (const auto& text : options.config_files) {
    const auto equals = text.find('=');
    if (equals == std::string::npos) throw UsageError("--config: found '" + text + "', accepted NAME=FILE");
    manifest.config_files[text.substr(0, equals)] = fs::absolute(text.substr(equals + 1));
  }
  if (!fs::exists(manifest.scenario_file)) throw ConfigurationError(manifest.scenario_file.string() + ": no such scenario");
  if (options.in_process) regroup(manifest, {manifest.roster()});
  else regroup(manifest, options.groups);
  return manifest;
}

fs::path make_report_dir(const RunOptions& options, const fs::path& scenario) {
  fs::path dir = options.report_dir;
  if (dir.empty()) {
    const std::time_t now = std::time(nullptr);
    const auto name = fmt::format("{:%Y%m%d-%H%M%S}_{}_seed{}", fmt::localtime(now), scenario.stem().string(), options.seed);
    dir = make_new_directory(fs::path("runs") / name);
  } else {
    fs::create_directories(dir);
  }
  for (const char* old : {"mission.json", "report.json", "figure.png", "hashes.bin"}) fs::remove(dir / old);
  return fs::absolute(dir);
}

/// How each process of the run is called.
Supervisor::CommandLine command_line(const RunOptions& options, const LaunchManifest& manifest, std::uint32_t domain,
                                     const std::vector<std::string>& roster, const fs::path& report_dir, std::uint64_t run_id) {
  const fs::path programs = fs::read_symlink("/proc/self/exe").parent_path();
  std::vector<std::string> common = {"--domain",   std::to_string(domain),
                                     "--roster",   fmt::format("{}", fmt::join(roster, ",")),
                                     "--plant",    manifest.plant,
                                     "--robot",    manifest.robot_file.string(),
                                     "--scenario", manifest.scenario_file.string(),
                                     "--seed",     std::to_string(options.seed),
                                     "--output",   report_dir.string(),
                                     "--patience", fmt::format("{}", manifest.patience_s),
                                     "--run-id",   std::to_string(run_id)};
  std::vector<std::string> plants = pace_arguments(options.pace);
  if (options.max_sim_time_s > 0) plants.insert(plants.end(), {"--max-sim-time", fmt::format("{}", options.max_sim_time_s)});
  if (options.record) plants.emplace_back("--record");
  return [=](const ProcessPlan& process, std::uint32_t incarnation) {
    std::vector<std::string> arguments;
    if (process.program.empty() && process.components.size() == 1) {
      arguments = {(programs / process.components.front()).string()};
    } else {
      const std::string program = process.program.empty() ? "constrictor_host" : process.program;
      arguments = {(programs / program).string(), fmt::format("{}", fmt::join(process.components, ","))};
    }
    arguments.insert(arguments.end(), common.begin(), common.end());
    arguments.insert(arguments.end(), {"--incarnation", std::to_string(incarnation)});
    for (const auto& component : process.components) {
      const auto config = manifest.config_files.find(component);
      if (config != manifest.config_files.end()) arguments.insert(arguments.end(), {"--config", component + "=" + config->second.string()});
      if (component == manifest.plant) arguments.insert(arguments.end(), plants.begin(), plants.end());
    }
    return arguments;
  };
}

/// Speed over the last few seconds of wall time.
class Speedometer {
 public:
  double factor(double sim_time_s) {
    const auto now = Clock::now();
    const double wall_s = std::chrono::duration<double>(now - since_).count();
    if (wall_s < 1.0) return factor_;
    factor_ = std::max(0.0, sim_time_s - sim_time_s_) / wall_s;
    since_ = now;
    sim_time_s_ = sim_time_s;
    return factor_;
  }

 private:
  Clock::time_point since_ = Clock::now();
  double sim_time_s_ = 0;
  double factor_ = 0;
};

}  // namespace

fs::path make_new_directory(const fs::path& wanted) {
  if (wanted.has_parent_path()) fs::create_directories(wanted.parent_path());
  fs::path directory = wanted;
  for (int number = 2; !fs::create_directory(directory); ++number) directory = fmt::format("{}-{}", wanted.string(), number);
  return directory;
}

int run_command(const RunOptions& options) {
  pace_arguments(options.pace);  // before anything is done
  LaunchManifest manifest = make_manifest(options);
  // The run's identity must not depend on how its components are spread over processes.
  const std::vector<std::string> roster = load_manifest(resolve(options.manifest, "deploy", "--manifest")).roster();
  const DomainClaim claim(options.domain);
  const fs::path report_dir = make_report_dir(options, manifest.scenario_file);
  const std::string scenario = manifest.scenario_file.stem().string();
  PublishedNote note({claim.domain(), ::getpid(), scenario, options.seed, roster, manifest.plant, report_dir});
  const auto environment = run_environment();

  const SignalQueue signals;
  ProgressDisplay display;
  display.say(fmt::format("run {}: {} seed {}, {} components in {} process{}, report in {}", claim.domain(), scenario, options.seed,
                          roster.size(), manifest.processes.size(), manifest.processes.size() == 1 ? "" : "es", report_dir.string()));
  std::random_device entropy;  // names the run among others; nothing computed depends on it
  const std::uint64_t run_id = (static_cast<std::uint64_t>(entropy()) << 32 | entropy()) | 1;
  RunObserver observer(claim.domain(), run_id);
  Supervisor supervisor(manifest, command_line(options, manifest, claim.domain(), roster, report_dir, run_id), environment,
                        report_dir / "logs", [&](const std::string& line) { display.say(line); });
  RunOutcome outcome{scenario, options.seed, 0, ""};
  int status = exit_status::kOk;
  Speedometer speed;
  const auto start = Clock::now();
  auto sampled = start - kMemoryEvery + 500ms;  // the first sample soon: a run may be short
  supervisor.start();
  for (auto state = Supervisor::State::kRunning; state == Supervisor::State::kRunning;) {
    const int wish = signals.wait(200ms);
    if (wish != 0) {
      outcome.error = fmt::format("ended by signal {}", wish);
      status = 128 + wish;
      break;
    }
    for (const auto& line : observer.poll()) display.say(line);
    note.set_seed(observer.view().seed(options.seed));
    supervisor.run_is_at(observer.view().tick, observer.view().held());
    // The plant's word may be lost to a launcher that was stopped for long; that the mission was reported tells the same.
    const bool reported = supervisor.plant_is_gone() && fs::exists(report_dir / "mission.json");
    if (reported || observer.view().ended(manifest.plant)) supervisor.expect_end();
    state = supervisor.poll();
    if (Clock::now() - sampled > kMemoryEvery) {
      sampled = Clock::now();
      supervisor.sample_memory();
    }
    display.show(progress_line(observer.view(), speed.factor(observer.view().sim_time_s())));
  }
  outcome.wall_time_s = std::chrono::duration<double>(Clock::now() - start).count();
  if (status != exit_status::kOk || supervisor.poll() == Supervisor::State::kFailed) supervisor.stop();
  else supervisor.finish(kEndGrace);
  for (const auto& line : observer.poll()) display.say(line);
  if (status == exit_status::kOk && !supervisor.failure().empty()) {
    outcome.error = supervisor.failure();
    status = supervisor.failure_status();
  }
  outcome.seed = observer.view().seed(options.seed);
  const bool success = write_report(report_dir, outcome, observer.view(), supervisor.records());
  if (status == exit_status::kOk && !success) status = exit_status::kMissionFailed;
  display.say(fmt::format("{}{}: {:.1f} s simulated in {:.1f} s; {}", success ? "mission succeeded" : "mission did not succeed",
                          outcome.error.empty() ? "" : " (" + outcome.error + ")", observer.view().sim_time_s(), outcome.wall_time_s,
                          (report_dir / "report.json").string()));
  return status;
}

}  // namespace constrictor::cli
