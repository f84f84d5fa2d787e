// An operator of a run: asks `input` for authority, tasks, motions and stops, and hears what it rules.
#pragma once

#include <chrono>
#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <string>

#include "cli/authority_watch.hpp"
#include "constrictor/messages.hpp"
#include "runtime/unanswered_requests.hpp"

namespace constrictor::cli {

/// What is asked is said again, under its number, until it is answered: `input` hears nothing while its process is being restarted.
class OperatorClient {
 public:
  /// `source`: the name under which it asks. `lease` > 0: authority falls to nobody if assert_alive() is not called for so long;
  /// 0: with the end of this process. `detached`: authority stays until somebody releases it (for scripts).
  OperatorClient(std::uint32_t domain, std::string source, std::chrono::milliseconds lease, bool detached = false);
  ~OperatorClient();

  /// Waits until `input` listens. False if it does not within `bound`.
  bool connect(std::chrono::milliseconds bound);
  /// Sends a request, its source, level and number filled in. Returns its number.
  std::uint64_t ask(msg::Request request);
  std::uint64_t ask(std::uint8_t kind);
  std::uint64_t move(std::uint8_t motion, double frequency_hz = 0.0, double curvature_1_m = 0.0, double angle_rad = 0.0);
  std::uint64_t start(std::uint8_t task, const msg::TaskParameters& parameters);
  void assert_alive() const;

  /// Takes in what arrived, and repeats what was not answered.
  void poll();
  /// Newest word of `input`; empty before the first.
  [[nodiscard]] const std::optional<msg::Authority>& authority() const { return authority_.newest(); }
  [[nodiscard]] bool holds_authority() const;

  enum class Answer { kGranted, kRefused, kNone };
  /// Waits for the answer to a request; kNone if there is none within `bound`. Keeps this source alive meanwhile. An emergency stop
  /// counts as granted also when `authority` says, of a later tick than what was known when it was asked for, that one is latched.
  Answer wait_for_answer(std::uint64_t number, std::chrono::milliseconds bound);
  /// Why the last request that wait_for_answer() saw refused was.
  [[nodiscard]] const std::string& refusal() const { return refusal_; }
  /// Goal of the last task that wait_for_answer() saw granted, as on task/command.
  [[nodiscard]] std::uint64_t goal() const { return goal_; }
  [[nodiscard]] const std::string& source() const { return source_; }
  /// The DDS participant, for other readers of this process (a process joins a domain once).
  [[nodiscard]] std::int32_t participant() const;
  /// Waits until what was asked has arrived, at most for a second.
  void flush() const;

 private:
  struct Endpoints;
  void take_authority();
  std::string source_;
  bool detached_;
  std::unique_ptr<Endpoints> endpoints_;
  std::uint64_t sequence_ = 0;
  AuthorityWatch authority_;
  UnansweredRequests unanswered_;
  std::map<std::uint64_t, msg::RequestAnswer> answers_;  ///< to our requests, the newest of them, by number
  std::string refusal_;
  std::uint64_t goal_ = 0;
};

/// The name under which one process may ask without being taken for another: "teleop.HOST.PID".
std::string unique_source(const std::string& what);

/// Default parameters of a task: none given (timeout: NaN).
msg::TaskParameters no_parameters();

}  // namespace constrictor::cli
