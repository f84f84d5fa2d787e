#include "cli/run_command.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <chrono>
#include <csignal>

#include "cli/companions.hpp"
#include "cli/keys/keys_command.hpp"
#include "cli/live_view.hpp"
#include "cli/log/launch_log.hpp"
#include "cli/log/log_files.hpp"
#include "cli/recording/recording_text.hpp"
#include "cli/remote/host_set.hpp"
#include "cli/run_ending.hpp"
#include "cli/run_faults.hpp"
#include "cli/run_observer.hpp"
#include "cli/run_record.hpp"
#include "cli/run_report.hpp"
#include "cli/signal_queue.hpp"
#include "cli/supervisor.hpp"
#include "cli/swap.hpp"
#include "client/run_control_client.hpp"
#include "client/run_registry.hpp"
#include "common/progress_display.hpp"
#include "configuration/counted.hpp"
#include "cyclone/run_token.hpp"
#include "cyclone/security.hpp"
#include "runtime/host.hpp"

namespace constrictor::cli {
namespace {

namespace fs = std::filesystem;
using namespace std::chrono_literals;
using Clock = std::chrono::steady_clock;

constexpr auto kMemoryEvery = 2s;
constexpr auto kAnswerBound = 5s;  // bound on the conductor's answer to the request to end the run
constexpr auto kEndGrace = 60s;    // when the plant has ended, the report component still draws its figure

/// A signal that arrived before the run began.
struct Interrupted {
  int signal;
};

/// One run, from the start of its processes to its report.
class Launcher {
 public:
  /// `resumed`: the run that is continued; null: a new one. `lock`: of its folder, if that exists.
  Launcher(const RunOptions& options, LaunchPlan plan, const RunRecord* resumed, Descriptor lock)
      : options_(options),
        plan_(std::move(plan)),
        resumed_(resumed != nullptr),
        record_(resumed ? *resumed : RunRecord{absolute_options(options, plan_), new_run_id(), {}, new_hosts_token()}),
        hosts_(
            plan_.manifest, {record_.hosts_token, options.secure, !options.no_checkpoints, resumed_},
            [this](const std::string& line) { display_.print(line); }, [this] { wait_for_hosts(); }),
        claim_(options.domain, hosts_.used_domains()),
        report_dir_(resumed ? options.report_dir : make_report_dir(options, plan_.manifest.scenario_file)),
        lock_(lock.open() ? std::move(lock) : lock_run(report_dir_)),
        scenario_(plan_.manifest.scenario_file.stem().string()),
        run_id_(record_.run_id),
        note_({claim_.domain(), ::getpid(), scenario_, options.seed, plan_.roster, plan_.manifest.plant, report_dir_,
               run_id_, new_token()}),
        hosts_prepared_((hosts_.prepare(claim_.domain(), report_dir_, note_.token_file()), true)),
        security_(claim_.domain(), options.secure),
        observer_(claim_.domain(), run_id_),
        log_(display_, report_dir_ / "logs", observer_.participant(), run_id_, resumed_),
        supervisor_(
            plan_.manifest,
            recorded(
                with_swaps(make_command_line(options, plan_, claim_.domain(), report_dir_, run_id_, note_.token_file()),
                           report_dir_)),
            run_environment(), report_dir_ / "logs", [this](const std::string& line) { log_.warn(line); },
            [this](const auto&... process) { return hosts_.start(process...); }) {}

  int run() {
    log_.say(fmt::format("run {}: {} seed {}, {} in {}, report in {}", claim_.domain(), scenario_, options_.seed,
                         counted(plan_.roster.size(), "component"),
                         counted(plan_.manifest.processes.size(), "process", "processes"), report_dir_.string()));
    display_.print(
        fmt::format("  token {} (for programs on other hosts: put it into a file, see --token-file)", note_.token()));
    if (!options_.faults_file.empty())
      fs::copy_file(options_.faults_file, report_dir_ / "faults.yaml", fs::copy_options::overwrite_existing);
    const auto start = Clock::now();
    if (resumed_) {
      fs::remove(report_dir_ / "report.json");  // it says why the run was interrupted
      log_.say(plan_.manifest.host_of_plant().empty() ? prepare_checkpoint(report_dir_) : hosts_.continued());
    }
    companions_.emplace(plan_.manifest, options_.seed, report_dir_, [this](const auto& line) { log_.warn(line); });
    supervisor_.start(resumed_ ? record_.incarnations : std::map<std::string, std::uint32_t>{});
    const auto print = [this](const auto& line) { display_.print(line); };
    if (options_.view) view_.emplace(claim_.domain(), options_.view_port, report_dir_ / "logs", print);
    memory_sampled_ = start - kMemoryEvery + 500ms;  // the first sample is taken early: a run may be short
    watch_run();
    const double wall_time_s = std::chrono::duration<double>(Clock::now() - start).count();
    end_processes();
    hosts_.finish(ended_in_order());
    for (const auto& line : observer_.poll()) display_.print(line);
    return report(wall_time_s);
  }

 private:
  // Notes each incarnation: one that continues the run later must be newer.
  CommandLine recorded(CommandLine command_line) {
    return [this, command_line = std::move(command_line)](const ProcessPlan& process, std::uint32_t incarnation) {
      record_.incarnations[process.name()] = incarnation;
      write_record();
      return command_line(process, incarnation);
    };
  }

  void write_record() {
    try {
      write_run_record(report_dir_, record_);
    } catch (const std::exception& error) {
      display_.print(fmt::format("{}; the run goes on, but it cannot be resumed", error.what()));
    }
  }
  [[nodiscard]] bool ended_in_order() const { return killed_.empty() && supervisor_.failure().empty(); }
  /// Removes the checkpoints of a run that ended in order. If it did not, says how to continue it.
  void note_end() {
    const bool begun = resumed_ || observer_.view().tick >= 0;
    if (ended_in_order()) {
      record_.over = true;
      write_record();
      remove_checkpoints(report_dir_);
    } else if ((begun || supervisor_.failure_status() != exit_status::kConfiguration) &&
               is_continuable(plan_.manifest, report_dir_, !options_.no_checkpoints)) {
      display_.print(fmt::format("to continue this run: constrictor run --resume {}", report_dir_.string()));
    }
  }

  void wait_for_hosts() {
    if (const int signal = signals_.wait(20ms); signal != 0) throw Interrupted{signal};
  }
  /// Returns when the run has ended, a process has failed, or the processes must be killed.
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
    companions_->poll();
    if (view_) view_->poll();
    const RunView& view = observer_.view();
    note_.set_seed(view.seed(options_.seed), [this](const auto& line) { log_.warn(line); });
    supervisor_.run_is_at(view.tick, view.held());
    log_.at(view);
    bound_logs(report_dir_ / "logs");
    faults_.poll(view, supervisor_, *companions_, [this](const auto& line) { log_.warn(line); });
    // A launcher that was stopped (SIGSTOP) for long can miss the last statuses; mission.json shows the same.
    const bool reported = supervisor_.plant_is_gone() && fs::exists(report_dir_ / "mission.json");
    if (reported || view.run_is_over()) supervisor_.expect_end();
    if (Clock::now() - memory_sampled_ > kMemoryEvery) {
      memory_sampled_ = Clock::now();
      supervisor_.sample_memory();
    }
  }

  /// Waits for signals, and asks the conductor to end the run if one arrived. True if the processes must be killed.
  bool must_kill(std::chrono::milliseconds bound) {
    const int signal = signals_.wait(bound);
    if (signal == SIGHUP && !options_.no_checkpoints && !ending_.requested()) {
      // The terminal is gone, but the user did not ask to end the mission.
      killed_ = left_ = "its terminal was closed";
    } else if (signal != 0) {
      note_signal(signal);
      if (run_is_over_) ending_.accepted(Clock::now());
      if (ending_.wants_answer()) ask_conductor_to_end();
    }
    if (killed_.empty()) killed_ = ending_.kill_reason(Clock::now());
    return !killed_.empty();
  }

  void note_signal(int signal) {
    ending_.signal_received(signal, observer_.view().tick >= 0, Clock::now());
    if (ending_.kill_reason(Clock::now()).empty()) log_.say("ending the run; a second signal kills its processes");
  }

  void ask_conductor_to_end() {
    const auto meanwhile = [this] {
      update();
      if (supervisor_.poll() != Supervisor::State::kRunning) return true;
      if (const int signal = signals_.wait(0ms); signal != 0) note_signal(signal);
      return ending_.at_once();
    };
    try {
      RunControlClient(observer_.participant(), claim_.domain(), kAnswerBound, meanwhile, note_.key()).end();
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
      log_.warn("killing all processes, the report will be incomplete: " + killed_);
      supervisor_.stop(ending_.at_once() || !left_.empty());
    }
  }

  int report(double wall_time_s) {
    const RunView& view = observer_.view();
    RunOutcome outcome{scenario_, view.seed(options_.seed), wall_time_s, "", ""};
    int status = ending_.requested() ? 128 + ending_.first_signal() : exit_status::kFailed;
    note_end();
    if (!left_.empty()) {
      outcome.error = fmt::format("the run was left at {:.1f} s because {}", view.sim_time_s(), left_);
      status = 128 + SIGHUP;
    } else if (ending_.requested()) {
      outcome.end_reason = fmt::format("ended by user at {:.1f} s", view.sim_time_s());
      outcome.error =
          killed_.empty() ? supervisor_.failure() : outcome.end_reason + "; processes killed because " + killed_;
    } else if (!supervisor_.failure().empty()) {
      outcome.error = supervisor_.failure();
      status = supervisor_.failure_status();
    } else if (options_.max_sim_time_s > 0 && view.sim_time_s() > options_.max_sim_time_s - 3 * view.period_s) {
      outcome.end_reason = fmt::format("time limit of {:g} s (--max-sim-time)", options_.max_sim_time_s);
    }
    if (options_.record) outcome.recording = recording_report(report_dir_);
    if (!outcome.recording.is_null()) display_.print(outcome.recording["text"].get<std::string>());
    view_.reset();
    companions_.reset();  // emulated devices write what really happened when they end
    const RunVerdict verdict = write_report(report_dir_, outcome, view, supervisor_.records(), hosts_.report());
    log_.say(fmt::format("mission {}: {:.1f} s simulated in {:.1f} s; {}",
                         verdict.success ? "succeeded" : "did not succeed (" + verdict.reason + ")", verdict.sim_time_s,
                         wall_time_s, (report_dir_ / "report.json").string()));
    for (const auto& notice : verdict.notices) display_.print(notice);
    return verdict.success ? exit_status::kOk : status;
  }

  const RunOptions& options_;
  LaunchPlan plan_;
  SignalQueue signals_;  // first, because it must exist before any thread or process is started
  ProgressDisplay display_;
  bool resumed_;
  RunRecord record_;
  HostSet hosts_;
  DomainClaim claim_;
  fs::path report_dir_;
  Descriptor lock_;  ///< of report_dir_
  std::string scenario_;
  std::uint64_t run_id_;
  PublishedNote note_;
  bool hosts_prepared_;              ///< before the observer, which needs the DDS configuration
  dds::PublishedSecurity security_;  ///< before the observer, which joins the run with an identity
  RunObserver observer_;
  LaunchLog log_;
  Supervisor supervisor_;
  RunFaults faults_{plan_.faults, resumed_};
  Clock::time_point memory_sampled_{};
  RunEnding ending_;
  std::optional<Companions> companions_;  ///< programs beside the run; they end after it
  std::optional<LiveView> view_;          ///< empty: the run is not shown
  bool run_is_over_ = false;              ///< the plant has ended; the other processes are ending
  std::string killed_;                    ///< why the processes are killed; empty if they are not killed
  std::string left_;                      ///< why the run is left without an end, so that it can be resumed; else empty
};

}  // namespace

int run_command(const RunOptions& given) {
  std::optional<RunRecord> resumed;
  Descriptor lock;
  RunOptions options = given;
  if (!given.resume_dir.empty()) {
    resumed = read_run_record(given.resume_dir);
    options = resumed->options;
    options.domain = given.domain;
    options.view = given.view;
    options.view_port = given.view_port;
  }
  if (fs::is_directory(options.report_dir)) lock = lock_run(options.report_dir);  // before anything in it is changed
  LaunchPlan plan = make_launch_plan(options);
  if (resumed) require_continuable(plan.manifest);
  show_warnings(check_components(options, plan));
  if (!options.secure.empty()) use_keys(options.secure, plan);
  try {
    return Launcher(options, std::move(plan), resumed ? &*resumed : nullptr, std::move(lock)).run();
  } catch (const Interrupted& interrupted) {
    return 128 + interrupted.signal;
  }
}

}  // namespace constrictor::cli
