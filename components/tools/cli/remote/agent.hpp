// The agent: runs the processes of one run on a host to which the launcher has an ssh connection.
#pragma once

#include <chrono>
#include <cstdint>
#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <string>

#include "cli/child_process.hpp"
#include "cli/remote/message_channel.hpp"
#include "cyclone/domain_claim.hpp"
#include "cyclone/security.hpp"
#include "runtime/awake_clock.hpp"

namespace constrictor::cli {

/// The folder of an agent below run_directory(): its socket, its lock, files, logs and output of the run.
[[nodiscard]] std::filesystem::path agent_folder(const std::string& token);

/// The folder in the user's state folder that keeps the output of a run whose agent has the folder `agent`; empty: the
/// user has no state folder.
[[nodiscard]] std::filesystem::path kept_output(const std::filesystem::path& agent);

/// Removes the folders of agents that were killed; their processes were killed with them, by the kernel. A new folder
/// is left alone, because its agent may not have locked it yet, unless it is `own`, that of the calling agent's run:
/// the killed agent was its predecessor. In this one, the output of the processes is kept. Also removes output that was
/// kept for a run that was not continued for a week.
void remove_stale_agents(const std::filesystem::path& own);

/// Starts processes, reports how they end, forwards their logs and the files that they write. It outlives a broken
/// connection: the launcher connects again to its socket. It kills its processes and removes its folder when the
/// launcher says so, after the patience without a message from the launcher, and soon after the launcher has closed the
/// connection without a new one. If the agent itself is killed, the kernel kills its processes. Output of a run that is
/// not over is kept in the user's state folder, so that `constrictor run --resume` finds it.
class Agent {
 public:
  /// Makes the folder of the agent and listens on the socket in it. Throws std::system_error.
  explicit Agent(const std::string& token);
  ~Agent();
  Agent(const Agent&) = delete;
  Agent& operator=(const Agent&) = delete;
  /// Serves the launcher until the run is over. Returns the exit status.
  int run();

 private:
  using Clock = std::chrono::steady_clock;
  struct Managed {
    std::uint32_t incarnation = 0;
    std::unique_ptr<ChildProcess> child;
    std::uintmax_t log_sent = 0;  ///< [byte] of its log that the launcher has
    std::uintmax_t log_cut = 0;   ///< [byte] of its log that are no longer in the file
    double pss_mib = 0;
  };
  void accept_connection();
  void take(const nlohmann::json& message);
  void take_hello(const nlohmann::json& message);
  /// Another launcher continues the run: ends what runs of it, and keeps what has been written.
  void start_over();
  void prepare(const nlohmann::json& message);
  void store_files(const nlohmann::json& message);
  /// Stores the keys of this host's processes. Throws std::runtime_error if they cannot be used here.
  void store_keys(const nlohmann::json& message);
  void make_folders();
  void start(const nlohmann::json& message);
  void signal(const nlohmann::json& message);
  void collect();
  /// Opens a UDP socket whose packets are sent back: `constrictor doctor` checks with it whether packets pass.
  void open_echo(const nlohmann::json& message);
  void answer_echo() const;
  /// Sends packets to the echo of another host, and reports whether one comes back.
  void open_probe(const nlohmann::json& message);
  void probe();
  void end_probe(bool passed);
  void send_logs();
  /// Empties the log of a process when it is too large: the launcher has it, or has been out of reach for too long.
  void bound_log_of(const std::string& name, Managed& process) const;
  /// [byte] that a process has written into its log.
  [[nodiscard]] std::uintmax_t log_size(const std::string& name, const Managed& process) const;
  void send_state();
  void send_files();
  /// Looks for processes that have ended. True if one has.
  bool reap();
  /// Nobody needs the agent any more: the launcher has been away for too long.
  [[nodiscard]] bool abandoned();
  /// `at_once`: without SIGTERM first.
  void kill_all(bool at_once);
  /// Kills all processes, removes all files and frees the domain. What processes have written is kept if the run may
  /// be continued.
  void clean_up();
  [[nodiscard]] std::filesystem::path log_of(const std::string& name) const {
    return folder_ / "logs" / (name + ".log");
  }

  std::filesystem::path folder_;
  Descriptor lock_, listener_, signals_, echo_, probe_;
  Clock::time_point probe_until_{}, next_probe_{};
  std::unique_ptr<MessageChannel> channel_;
  AwakeClock awake_;
  std::optional<Clock::time_point> disconnected_at_;  ///< in the time of awake_, as the next one
  Clock::time_point last_word_ = awake_.now();
  Clock::time_point last_state_{};
  std::chrono::duration<double> patience_{60};
  std::unique_ptr<DomainClaim> claim_;
  PublishedDdsConfiguration dds_;
  std::unique_ptr<dds::PublishedSecurity> security_;
  std::string dds_xml_;
  std::map<std::string, Managed> processes_;
  std::map<std::string, std::uintmax_t> files_to_send_;  ///< output files by path: [byte] that have been sent
  nlohmann::json description_;                           ///< of this host; null before the first hello
  std::string launcher_;                                 ///< that sent the last hello; another one continues the run
  std::string continued_;  ///< how a run is continued whose plant is here; empty: it is not
  bool keep_ = false;      ///< the run may be continued later
  bool cleaned_up_ = false;
  bool prepared_ = false;
  bool collecting_ = false;
  bool greeted_ = false;  ///< the launcher has said hello on this connection, and which parts of the logs it has
  bool over_ = false;
};

}  // namespace constrictor::cli
