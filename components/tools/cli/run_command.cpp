#include "cli/run_command.hpp"

#include <fmt/chrono.h>
#include <fmt/format.h>
#include <unistd.h>

#include <chrono>
#include <csignal>
#include <ctime>
#include <random>

#include "cli/progress_display.hpp"
#include "cli/remote/host_set.hpp"
#include "cli/run_ending.hpp"
#include "cli/run_observer.hpp"
#include "cli/run_report.hpp"
#include "cli/signal_queue.hpp"
#include "cli/supervisor.hpp"
#include "client/run_control_client.hpp"
#include "client/run_registry.hpp"
#include "cyclone/domain_claim.hpp"
#include "cyclone/run_token.hpp"
#include "runtime/host.hpp"

namespace constrictor::cli {
namespace {

namespace fs = std::filesystem;
using namespace std::chrono_literals;
using Clock = std::chrono::steady_clock;

constexpr auto kMemoryEvery = 2s;
constexpr auto kAnswerBound = 5s;  // bound on the conductor's answer to the request to end the run
constexpr auto kEndGrace = 60s;    // when the plant has ended, the report component still draws its figure

fs::path make_report_dir(const RunOptions& options, const fs::path& scenario) {
  fs::path dir = options.report_dir;
  if (dir.empty()) {
    const std::time_t now = std::time(nullptr);
    const auto name =
        fmt::format("{:%Y%m%d-%H%M%S}_{}_seed{}", fmt::localtime(now), scenario.stem().string(), options.seed);
    dir = make_new_directory(fs::path("runs") / name);
  } else {
    fs::create_directories(dir);
  }
  for (const char* old : {"mission.json", "report.json", "figure.png", "hashes.bin"}) fs::remove(dir / old);
  return fs::absolute(dir);
}

/// A number that distinguishes this run from others; nothing that a run computes depends on it.
std::uint64_t random_run_id() {
  std::random_device entropy;
  return (static_cast<std::uint64_t>(entropy()) << 32 | entropy()) | 1;
}

/// A signal that arrived before the run began.
struct Interrupted {
  int signal;
};

/// One run, from the start of its processes to its report.
class Launcher {
 public:
  Launcher(const RunOptions& options, LaunchPlan plan)
      : options_(options),
        plan_(std::move(plan)),
        hosts_(
            plan_.manifest, [this](const std::string& line) { display_.print(line); }, [this] { wait_for_hosts(); }),
        claim_(hosts_.domain(options.domain)),
        report_dir_(make_report_dir(options, plan_.manifest.scenario_file)),
        scenario_(plan_.manifest.scenario_file.stem().string()),
        run_id_(random_run_id()),
        note_({claim_.domain(), ::getpid(), scenario_, options.seed, plan_.roster, plan_.manifest.plant, report_dir_,
               run_id_, new_token()}),
        hosts_prepared_((hosts_.prepare(claim_.domain(), report_dir_, note_.token_file()), true)),
        observer_(claim_.domain(), run_id_),
        supervisor_(
            plan_.manifest,
            make_command_line(options, plan_, claim_.domain(), report_dir_, run_id_, note_.token_file()),
            run_environment(), report_dir_ / "logs", [this](const std::string& line) { display_.print(line); },
            [this](const auto&... process) { return hosts_.start(process...); }) {}

  int run() {
    const auto processes = plan_.manifest.processes.size();
    display_.print(fmt::format("run {}: {} seed {}, {} components in {} process{}, report in {}", claim_.domain(),
                               scenario_, options_.seed, plan_.roster.size(), processes, processes == 1 ? "" : "es",
                               report_dir_.string()));
    display_.print(
        fmt::format("  token {} (for programs on other hosts: put it into a file, see --token-file)", note_.token()));
    const auto start = Clock::now();
    supervisor_.start();
    memory_sampled_ = start - kMemoryEvery + 500ms;  // the first sample is taken early: a run may be short
    watch_run();
    const double wall_time_s = std::chrono::duration<double>(Clock::now() - start).count();
    end_processes();
    hosts_.finish();
    for (const auto& line : observer_.poll()) display_.print(line);
    return report(wall_time_s);
  }

 private:
  void wait_for_hosts() {
    if (const int signal = signals_.wait(20ms); signal != 0) throw Interrupted{signal};
  }

  /// Until the run has ended, a process failed, or the processes must be killed.
  void watch_run() {
    SpeedMeter speed;
    while (supervisor_.poll() == Supervisor::State::kRunning && !must_kill(200ms)) {
      update();
      display_.show_status(progress_line(observer_.view(), speed.factor(observer_.view().sim_time_s())));
    }
  }

  /// Reads the messages that the run has published, and passes their content to the supervisor and the note.
  void update() {
    for (const auto& line : observer_.poll()) display_.print(line);
    const RunView& view = observer_.view();
    note_.set_seed(view.seed(options_.seed));
    supervisor_.run_is_at(view.tick, view.held());
    // A launcher that was stopped (SIGSTOP) for long can miss the plant's last status; mission.json shows the same.
    const bool reported = supervisor_.plant_is_gone() && fs::exists(report_dir_ / "mission.json");
    if (reported || view.ended(plan_.manifest.plant)) supervisor_.expect_end();
    if (Clock::now() - memory_sampled_ > kMemoryEvery) {
      memory_sampled_ = Clock::now();
      supervisor_.sample_memory();
    }
  }

  /// Waits for signals, and asks the conductor to end the run if one arrived. True if the processes must be killed.
  bool must_kill(std::chrono::milliseconds bound) {
    if (const int signal = signals_.wait(bound); signal != 0) {
      note_signal(signal);
      if (run_is_over_) ending_.accepted(Clock::now());
      if (ending_.wants_answer()) ask_conductor_to_end();
    }
    if (killed_.empty()) killed_ = ending_.kill_reason(Clock::now());
    return !killed_.empty();
  }

  void note_signal(int signal) {
    ending_.signal_received(signal, observer_.view().tick >= 0, Clock::now());
    if (ending_.kill_reason(Clock::now()).empty())
      display_.print("ending the run; a second signal kills its processes");
  }

  void ask_conductor_to_end() {
    const auto meanwhile = [this] {
      update();
      if (supervisor_.poll() != Supervisor::State::kRunning) return true;
      if (const int signal = signals_.wait(0ms); signal != 0) note_signal(signal);
      return ending_.at_once();
    };
    try {
      RunControlClient(observer_.participant(), claim_.domain(), kAnswerBound, meanwhile).end();
      ending_.accepted(Clock::now());
    } catch (const CommandError& error) {
      // The wait was interrupted because the run has ended or a second signal arrived.
      if (error.cause() == CommandError::Cause::kInterrupted) ending_.accepted(Clock::now());
      else ending_.failed(error.what());
    }
  }

  void end_processes() {
    if (killed_.empty() && supervisor_.poll() == Supervisor::State::kFailed) return supervisor_.stop();
    if (killed_.empty()) {
      run_is_over_ = true;
      supervisor_.finish(kEndGrace, [this] { return must_kill(0ms); });
    }
    if (!killed_.empty()) {
      display_.print("killing all processes, the report will be incomplete: " + killed_);
      supervisor_.stop(ending_.at_once());
    }
  }

  int report(double wall_time_s) {
    const RunView& view = observer_.view();
    RunOutcome outcome{scenario_, view.seed(options_.seed), wall_time_s, "", ""};
    int status = ending_.requested() ? 128 + ending_.first_signal() : exit_status::kFailed;
    if (ending_.requested()) {
      outcome.end_reason = fmt::format("ended by user at {:.1f} s", view.sim_time_s());
      if (!killed_.empty()) outcome.error = outcome.end_reason + "; processes killed because " + killed_;
      else outcome.error = supervisor_.failure();
    } else if (!supervisor_.failure().empty()) {
      outcome.error = supervisor_.failure();
      status = supervisor_.failure_status();
    } else if (options_.max_sim_time_s > 0 && view.sim_time_s() > options_.max_sim_time_s - 3 * view.period_s) {
      outcome.end_reason = fmt::format("time limit of {:g} s", options_.max_sim_time_s);
    }
    const RunVerdict verdict = write_report(report_dir_, outcome, view, supervisor_.records(), hosts_.report());
    display_.print(fmt::format("mission {}: {:.1f} s simulated in {:.1f} s; {}",
                               verdict.success ? "succeeded" : "did not succeed (" + verdict.reason + ")",
                               verdict.sim_time_s, wall_time_s, (report_dir_ / "report.json").string()));
    return verdict.success ? exit_status::kOk : status;
  }

  const RunOptions& options_;
  LaunchPlan plan_;
  SignalQueue signals_;  // first, because it must exist before any thread or process is started
  ProgressDisplay display_;
  HostSet hosts_;
  DomainClaim claim_;
  fs::path report_dir_;
  std::string scenario_;
  std::uint64_t run_id_;
  PublishedNote note_;
  bool hosts_prepared_;  ///< before the observer, which needs the DDS configuration
  RunObserver observer_;
  Supervisor supervisor_;
  Clock::time_point memory_sampled_{};
  RunEnding ending_;
  bool run_is_over_ = false;  ///< the plant has ended; the other processes are ending
  std::string killed_;        ///< why the processes are killed; empty if they are not killed
};

}  // namespace

fs::path make_new_directory(const fs::path& wanted) {
  if (wanted.has_parent_path()) fs::create_directories(wanted.parent_path());
  fs::path directory = wanted;
  for (int number = 2; !fs::create_directory(directory); ++number)
    directory = fmt::format("{}-{}", wanted.string(), number);
  return directory;
}

int run_command(const RunOptions& options) {
  LaunchPlan plan = make_launch_plan(options);
  check_components(options, plan);
  try {
    return Launcher(options, std::move(plan)).run();
  } catch (const Interrupted& interrupted) {
    return 128 + interrupted.signal;
  }
}

}  // namespace constrictor::cli
