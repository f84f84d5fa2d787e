// The launcher's connection to the agent of one host. It is made again when it breaks.
#pragma once

#include <chrono>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "cli/child_process.hpp"
#include "cli/manifest.hpp"
#include "cli/remote/ssh_connection.hpp"
#include "runtime/awake_clock.hpp"

namespace constrictor::cli {

/// A host that cannot take part in the run. The text names the host, what was found and what to do.
class HostError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// All functions return at once. exchange() must be called often: it sends, receives, and connects again.
class HostLink {
 public:
  using Print = std::function<void(const std::string& line)>;
  /// The report of the agent on one process.
  struct Process {
    std::uint32_t incarnation = 0;
    nlohmann::json request;  ///< the message that starts it
    bool started = false;    ///< the agent has reported it
    bool lost = false;       ///< the host cannot be reached any more, and its agent ends the process by itself
    int wanted_signal = 0;   ///< SIGTERM or SIGKILL that was sent to it
    pid_t pid = 0;
    double pss_mib = 0;
    std::optional<ChildExit> exit;
    std::filesystem::path log;    ///< on the launcher's host
    std::uintmax_t received = 0;  ///< [byte] of the log on the other host
  };

  /// Begins to connect. `patience_s`: how long the host may be away before the run fails. `resume`: the run
  /// continues an earlier one, whose files the host has kept. The host keeps them until end().
  HostLink(std::string name, HostPlan plan, std::string token, double patience_s, Print print, bool resume = false);
  ~HostLink();
  HostLink(const HostLink&) = delete;
  HostLink& operator=(const HostLink&) = delete;

  /// Throws HostError if the host refuses the run, or cannot be reached within the patience before it was prepared.
  void exchange();
  /// The agent's description of its host; null before its first message.
  [[nodiscard]] const nlohmann::json& description() const { return description_; }
  [[nodiscard]] const std::string& name() const { return name_; }
  [[nodiscard]] const HostPlan& plan() const { return plan_; }
  /// The folder of the agent on its host.
  [[nodiscard]] std::string folder() const { return description_.value("folder", ""); }

  /// Claims the domain on the host and sends files and keys of the run. prepared() is true when that is done.
  void prepare(const nlohmann::json& request);
  [[nodiscard]] bool prepared() const { return prepared_; }
  /// The checkpoint from which the plant on this host continues the run, as a text; empty: the plant is not there, or
  /// the run is new.
  [[nodiscard]] const std::string& continued() const { return continued_; }
  void start(const std::string& process, std::uint32_t incarnation, nlohmann::json request,
             const std::filesystem::path& log);
  void signal(const std::string& process, int number);
  [[nodiscard]] const Process& process(const std::string& name) const { return processes_.at(name); }
  /// Asks for the files that the processes of the host have written. They are stored in `folder`.
  void collect(const std::filesystem::path& folder);
  [[nodiscard]] bool collected() const { return collected_; }
  /// [byte] of these files that have arrived.
  [[nodiscard]] std::uintmax_t collected_bytes() const { return collected_bytes_; }
  /// Why files of collect() are missing, and where they are; empty: all are there.
  [[nodiscard]] std::string missing_files() const;
  /// Asks the agent to send back what arrives at a UDP port.
  void echo(std::uint16_t port) { send({{"op", "echo"}, {"port", port}}); }
  /// Empty: the agent has not answered. Otherwise {error: text}, where an empty text means that the port is open.
  [[nodiscard]] const nlohmann::json& echo_answer() const { return echo_answer_; }
  /// Asks the agent to send packets from its host's address to a UDP port of another one that sends them back.
  void probe(const std::string& from, const std::string& to, std::uint16_t port) {
    probe_answer_ = nullptr;
    send({{"op", "probe"}, {"from", from}, {"to", to}, {"port", port}});
  }
  /// Null: the agent has not answered. Otherwise {passed: true or false}.
  [[nodiscard]] const nlohmann::json& probe_answer() const { return probe_answer_; }
  /// Ends the agent and all its processes. `keep`: what they have written is kept, to continue the run later.
  void end(bool keep);
  [[nodiscard]] bool ended() const { return ended_; }
  /// The host has been away for longer than the patience.
  [[nodiscard]] bool lost() const { return lost_; }
  /// Connected, and the agent has answered recently.
  [[nodiscard]] bool up() const { return up_; }

 private:
  using Clock = std::chrono::steady_clock;
  void connect();
  void say_hello(SshConnection& connection);
  void take(const nlohmann::json& message);
  void take_hello(const nlohmann::json& message);
  void take_state(const nlohmann::json& message);
  void take_log(const nlohmann::json& message);
  void take_file(const nlohmann::json& message);
  /// The agent has died, with its processes.
  void agent_is_gone();
  /// The host takes no part in the run any more.
  void give_up(const std::string& reason);
  void resend();
  void send(const nlohmann::json& message);
  void go_away(const std::string& why);
  void read_new_connection();
  [[noreturn]] void refuse(const std::string& reason) const;

  std::string name_;
  HostPlan plan_;
  std::string token_;
  std::chrono::duration<double> patience_;
  Print print_;
  std::unique_ptr<SshConnection> connection_;  ///< the one in use; kept while it is silent, until another one works
  std::unique_ptr<SshConnection> next_;        ///< being made
  nlohmann::json description_, preparation_, echo_answer_, probe_answer_;
  std::map<std::string, Process> processes_;
  std::filesystem::path collect_into_;
  std::uintmax_t collected_bytes_ = 0;
  std::map<std::string, std::string> not_stored_;  ///< files of collect() that cannot be written here, with the reason
  bool log_failed_ = false;                        ///< a log cannot be written here, which was printed
  bool begun_ = false;                             ///< an agent was started, so that connections attach to it
  bool up_ = false, prepared_ = false, lost_ = false, collecting_ = false, collected_ = false, ending_ = false,
       ended_ = false, away_printed_ = false;
  AwakeClock awake_;
  Clock::time_point away_since_ = awake_.now(), last_word_ = away_since_, last_ping_{}, next_attempt_ = away_since_,
                    attempt_began_{};  ///< in the time of awake_
  std::chrono::milliseconds pause_{250};
  std::string last_error_;
  std::string launcher_;  ///< identifies this process for the agent
  std::string continued_;
  bool resume_;
  bool keep_ = false;  ///< of end()
};

}  // namespace constrictor::cli
