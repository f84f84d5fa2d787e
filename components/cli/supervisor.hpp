// Starts the processes of a run, restarts members that died, and ends them all.
#pragma once

#include <chrono>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "cli/child_process.hpp"
#include "cli/manifest.hpp"

namespace constrictor::cli {

/// What became of one process of a run.
struct ProcessRecord {
  std::string name;             ///< as ProcessPlan::name()
  std::vector<std::string> components;
  double cpu_s = 0;             ///< [s] of all of its incarnations
  double max_pss_mib = 0;       ///< [MiB] highest sample
  std::uint32_t restarts = 0;
};

class Supervisor {
 public:
  /// The program and its arguments for an incarnation of a process.
  using CommandLine = std::function<std::vector<std::string>(const ProcessPlan& process, std::uint32_t incarnation)>;
  /// Tells the user something, one line at a time.
  using Say = std::function<void(const std::string& line)>;

  /// `environment` is complete; each process's own is added to it. Output goes to `log_dir`/NAME.log.
  Supervisor(LaunchManifest manifest, CommandLine command_line, std::vector<std::string> environment,
             std::filesystem::path log_dir, Say say);
  ~Supervisor();  ///< kills what still runs
  Supervisor(const Supervisor&) = delete;
  Supervisor& operator=(const Supervisor&) = delete;

  void start();

  enum class State {
    kRunning,
    kEnded,   ///< the plant said that the run is over, and its process ended as it should
    kFailed,  ///< see failure()
  };
  /// Looks after the processes without waiting: restarts members that died, within their budget. The plant's death, its end before
  /// the run's (expect_end()), a bad configuration, a refusal, a peer waited for too long, and five deaths of a process without a
  /// tick between them end the run.
  State poll();
  /// How far the run is, -1 before it began. `held`: nobody keeps the next tick waiting, only its pace or a pause.
  void run_is_at(std::int64_t tick, bool held);
  void sample_memory();
  /// The plant said that the run is over: from now on members end, and none is restarted.
  void expect_end() { ending_ = true; }
  /// The plant's process ended without an error. Unless expect_end() is called soon, that was not the run's end.
  [[nodiscard]] bool plant_is_gone() const { return plant_gone_; }

  /// Lets everybody end by themselves within `grace`, then ends the rest.
  void finish(std::chrono::seconds grace);
  /// SIGTERM to all, and SIGKILL to those still there after a bounded time. `at_once` leaves out the first.
  void stop(bool at_once = false);

  [[nodiscard]] const std::string& failure() const { return failure_; }
  /// Exit status that tells of the failure.
  [[nodiscard]] int failure_status() const { return failure_status_; }
  [[nodiscard]] std::vector<ProcessRecord> records() const;

 private:
  using Clock = std::chrono::steady_clock;
  struct Member {
    ProcessPlan plan;
    std::vector<ChildProcess> child;        ///< the present incarnation, if it was started
    ProcessRecord record;
    std::uint32_t incarnation = 0;
    Clock::time_point ended{};
    std::uintmax_t log_offset = 0;          ///< where this incarnation's output begins
    int vain_deaths = 0;                    ///< since the run last moved on
    bool over = false;                      ///< ended, and its exit dealt with
  };
  void spawn(Member& member);
  void take_exit(Member& member, const ChildExit& exit);
  /// `in_vain`: of its own fault, so that another start may change nothing.
  void restart(Member& member, const std::string& why, bool in_vain);
  void take_plants_end(const Member& plant);
  void fail(const std::string& why, int status);
  [[nodiscard]] bool is_plant(const Member& member) const;
  [[nodiscard]] std::filesystem::path log_of(const Member& member) const;
  bool all_gone(bool report_deaths);

  LaunchManifest manifest_;
  CommandLine command_line_;
  std::vector<std::string> environment_;
  std::filesystem::path log_dir_;
  Say say_;
  std::vector<Member> members_;
  std::int64_t tick_ = -1;                  ///< newest that is known
  State state_ = State::kRunning;
  bool ending_ = false;
  bool plant_gone_ = false;
  std::string failure_;
  int failure_status_ = 0;
};

}  // namespace constrictor::cli
