// Starts the processes of a run, restarts those that died, and ends them all.
#pragma once

#include <chrono>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "cli/child_process.hpp"
#include "cli/manifest.hpp"

namespace constrictor::cli {

/// One process of a run over all of its incarnations.
struct ProcessRecord {
  std::string name;  ///< name of the process, as returned by ProcessPlan::name()
  std::vector<std::string> components;
  double cpu_s = 0;        ///< [s] user and system time
  double max_pss_mib = 0;  ///< [MiB] largest sample
  std::uint32_t restarts = 0;
  std::string host = {};  ///< ProcessPlan::host
};

class Supervisor {
 public:
  /// Shows one line to the user.
  using Print = std::function<void(const std::string& line)>;

  /// Starts the next incarnation of a process on the host that its plan names; appends its output to `log`.
  using StartChild = std::function<std::unique_ptr<Child>(
      const ProcessPlan& plan, std::uint32_t incarnation, const std::vector<std::string>& argv,
      const std::vector<std::string>& environment, const std::filesystem::path& log)>;

  /// `environment` is complete; each process's own variables are added to it. Output goes to `log_dir`/NAME.log.
  /// `start_child`: the default starts every process on this host.
  Supervisor(LaunchManifest manifest, CommandLine command_line, std::vector<std::string> environment,
             std::filesystem::path log_dir, Print print, StartChild start_child = start_here);
  ~Supervisor();  ///< kills the processes that still run
  Supervisor(const Supervisor&) = delete;
  Supervisor& operator=(const Supervisor&) = delete;

  /// Starts a process on this host.
  static std::unique_ptr<Child> start_here(const ProcessPlan& plan, std::uint32_t incarnation,
                                           const std::vector<std::string>& argv,
                                           const std::vector<std::string>& environment,
                                           const std::filesystem::path& log);

  /// Starts all processes. `last_incarnations`: of a run that is continued, by the name of the process; its logs are
  /// continued, too. Throws std::system_error.
  void start(const std::map<std::string, std::uint32_t>& last_incarnations = {});

  enum class State {
    kRunning,
    kEnded,   ///< the run is over (expect_end()), and the plant's process ended with status 0
    kFailed,  ///< see failure()
  };
  /// Looks at the processes without waiting, and restarts those that died, up to the manifest's `restarts`. The run
  /// fails if the plant's process ends without expect_end(); if a process ends with a status that a restart
  /// cannot change (usage, configuration, refusal, a peer waited for too long, no such program); and if a process dies
  /// five times by its own fault while the run stands at one tick.
  State poll();
  /// The newest tick of the run, -1 before the first. `held`: all members have finished it, and only the pace or a
  /// pause keeps the next one back.
  void run_is_at(std::int64_t tick, bool held);
  void sample_memory();
  /// Sends a signal to the process that hosts this component, if it runs.
  void signal(const std::string& component, int number) const;
  /// A member published that the run is over: processes end from now on.
  void expect_end() { ending_ = true; }
  /// True if the plant's process ended with status 0. Without expect_end() soon afterwards the run has failed.
  [[nodiscard]] bool plant_is_gone() const { return plant_gone_; }

  /// Waits up to `grace` for all processes to end by themselves, then stop()s the others, which is a failure. Returns
  /// early, with processes still running, once `give_up` returns true.
  void finish(
      std::chrono::seconds grace, const std::function<bool()>& give_up = [] { return false; });
  /// Sends SIGTERM to all processes, and SIGKILL to those that have not ended 3 s later. `at_once`: only SIGKILL.
  void stop(bool at_once = false);

  /// Why the run failed; empty: it did not.
  [[nodiscard]] const std::string& failure() const { return failure_; }
  /// The exit status of the command for this failure.
  [[nodiscard]] int failure_status() const { return failure_status_; }
  /// The records of the processes, in the order of the manifest.
  [[nodiscard]] std::vector<ProcessRecord> records() const;

 private:
  using Clock = std::chrono::steady_clock;
  struct Supervised {
    ProcessPlan plan;
    std::unique_ptr<Child> child;  ///< the present incarnation; null before the start
    ProcessRecord record;
    std::uint32_t incarnation = 0;
    Clock::time_point ended{};
    std::uintmax_t log_offset = 0;  ///< [byte] where the output of this incarnation begins in its log
    int deaths_without_tick = 0;    ///< number of deaths by its own fault since the newest tick
    bool over = false;              ///< the process has ended, and its exit was handled
    bool started_at_end = false;    ///< restarted after the final tick, or after it ended by itself
    [[nodiscard]] bool running() const { return !over && child; }
  };
  void spawn(Supervised& process);
  void handle_exit(Supervised& process, const ChildExit& exit);
  /// `own_fault`: the process was not killed from outside, so that it may die in the same way after a restart.
  void restart(Supervised& process, const std::string& why, bool own_fault);
  void handle_plants_end(const Supervised& plant);
  void fail(const std::string& why, int status);
  [[nodiscard]] bool is_plant(const Supervised& process) const;
  [[nodiscard]] std::filesystem::path log_of(const Supervised& process) const;
  /// True if no process runs. `handle_exits`: deaths are printed, and may be failures.
  bool all_gone(bool handle_exits);
  void signal_all(int number) const;

  LaunchManifest manifest_;
  CommandLine command_line_;
  std::vector<std::string> environment_;
  std::filesystem::path log_dir_;
  Print print_;
  StartChild start_child_;
  std::vector<Supervised> processes_;
  std::int64_t tick_ = -1;  ///< newest known tick of the run
  State state_ = State::kRunning;
  bool ending_ = false;
  bool plant_gone_ = false;
  std::string failure_;
  int failure_status_ = 0;
};

}  // namespace constrictor::cli
