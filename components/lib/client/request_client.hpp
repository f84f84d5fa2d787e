// Sends requests to `input`: authority, tasks, motions, stops and parameters.
#pragma once

#include <chrono>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>

#include "client/authority_tracker.hpp"
#include "client/command_error.hpp"
#include "client/goal_tracker.hpp"
#include "client/run_registry.hpp"
#include "client/source.hpp"
#include "client/stop_tracker.hpp"
#include "client/unanswered_requests.hpp"
#include "constrictor/messages.hpp"

namespace constrictor {

struct RequestClientOptions {
  /// Name of the client, at most 31 bytes. Two processes must not share it; unique_source() makes such a name.
  std::string source;
  std::uint8_t level = msg::kAuthorityExternal;  ///< kAuthorityExternal or kAuthorityOperator
  std::uint16_t robot_id = 1;
  /// If this client has been dead for this time, `input` takes authority from it and the robot holds its posture. 0:
  /// `input` notices the end of the process only when the lease of its DDS participant lapses.
  std::chrono::milliseconds lease{500};
  /// True: the program must call poll(), wait_for_answer() or assert_alive() within each lease; if it hangs, `input`
  /// takes authority from it. False: DDS asserts that the process is alive, even if the program hangs.
  bool lease_by_hand = false;
  /// Authority and goals outlive the process until a source releases authority: for scripts of several short commands.
  bool detached = false;
  /// Run id and token that each request carries. Empty: those that run_key() finds.
  std::optional<RunKey> key;
  /// Called while a function waits; if it returns true the wait ends with Answer::kInterrupted. Empty: never.
  std::function<bool()> interrupted;
};

/// A client of one run. It repeats each request, under the same number, until `input` answers it, because a request
/// that arrives while `input` restarts is lost. Not thread-safe. DDS failures throw dds::Error.
class RequestClient {
 public:
  /// Joins the DDS domain of a run (find_domain()). A process joins each domain once.
  RequestClient(std::uint32_t domain, const RequestClientOptions& options);
  /// The same on a participant that this process already has in `domain`. It must outlive this object.
  RequestClient(std::int32_t participant, std::uint32_t domain, const RequestClientOptions& options);
  ~RequestClient();

  /// Waits until `input` reads requests and its Authority messages have arrived, also those that it keeps for programs
  /// that join late. Returns false if none arrives within `bound`, or if `interrupted` returned true.
  bool connect(std::chrono::milliseconds bound);
  /// The same, but throws CommandError (kNoAnswer, kInterrupted) instead of returning false.
  void connect_or_throw(std::chrono::milliseconds bound = std::chrono::seconds(10));
  /// Waits until an emergency stop can be sent: until the plant or `input` reads stops. Neither needs to answer.
  bool connect_to_stop(std::chrono::milliseconds bound);
  /// True while `input` reads requests.
  [[nodiscard]] bool connected() const;

  /// Sends a request; fills in source, level, robot id, number and `detached`. Returns the request's number.
  std::uint64_t ask(msg::Request request);
  /// Sends a request of a kind that needs no other field: take, release, emergency stop, clear stop. An emergency stop
  /// is also sent to the plant itself, which obeys it when `input` hangs.
  std::uint64_t ask(std::uint8_t kind);
  /// Sends a motion (kMotion...): frequency of the undulation [Hz], its curvature [1/m], angle [rad].
  std::uint64_t move(std::uint8_t motion, double speed_m_s = 0.0, double curvature_1_m = 0.0, double angle_rad = 0.0);

  /// Starts a task and waits until `input` and `navigation` have accepted it. `request` comes from task_request().
  /// Returns the goal's id as on task/event and task/status. Throws CommandError: kRefused, kNoAnswer, kInterrupted.
  std::uint64_t start_goal(const msg::Request& request);
  /// Waits until a goal ends; calls `each_poll` about every 10 ms, for reading other topics. Throws CommandError if the
  /// run is reset, or `input` is gone for 5 s.
  GoalTracker::End wait_for_end(std::uint64_t goal, const std::function<void()>& each_poll = {});
  /// The known states of all goals of the run. The first call creates the readers; poll() keeps it up to date.
  const GoalTracker& goals();
  /// Gives authority back and waits for the answer. Returns true if this client has no authority afterwards.
  bool release(std::chrono::milliseconds bound = std::chrono::seconds(5));

  /// Takes everything that has arrived, repeats unanswered requests and asserts that this client is alive.
  void poll();
  /// Asserts that this client is alive, where `lease_by_hand` is set.
  void assert_alive() const;

  /// The newest Authority message; empty before the first.
  [[nodiscard]] const std::optional<msg::Authority>& authority() const { return authority_.newest(); }
  /// True if the newest Authority message names this client.
  [[nodiscard]] bool holds_authority() const;
  /// The answer to one of the newest 256 requests; null if no answer has arrived.
  [[nodiscard]] const msg::RequestAnswer* answer(std::uint64_t number) const;

  enum class Answer { kGranted, kRefused, kNone, kInterrupted };
  /// Waits for the answer to a request; kNone if there is none within `bound`. An emergency stop also counts as granted
  /// when the plant has latched it, or when an Authority message of a later tick than the request reports a latched
  /// stop, even if another source requested it.
  Answer wait_for_answer(std::uint64_t number, std::chrono::milliseconds bound);
  /// The reason of the last refusal: that of the last wait_for_answer() that returned kRefused.
  [[nodiscard]] const std::string& refusal() const { return refusal_; }
  /// Goal id, as on task/event, of the last request for which wait_for_answer() returned kGranted; 0 if that request
  /// started no task.
  [[nodiscard]] std::uint64_t goal() const { return goal_; }

  [[nodiscard]] const std::string& source() const { return options_.source; }
  [[nodiscard]] std::uint32_t domain() const;
  /// The DDS participant, for more readers in this process.
  [[nodiscard]] std::int32_t participant() const;
  /// Waits until the requests have arrived at `input`, at most for 1 s.
  void flush() const;
  /// Waits, at most for 1 s, until the plant's process has received the emergency stop. False if it has not, or if no
  /// plant reads stops.
  [[nodiscard]] bool plant_has_received_stop() const;

 private:
  struct Endpoints;
  RequestClient(std::unique_ptr<Endpoints> endpoints, RequestClientOptions options);
  void take_authority();
  void take_stop_states();
  void send_to_plant(const msg::Request& stop) const;
  [[nodiscard]] bool interrupted() const { return options_.interrupted && options_.interrupted(); }

  RequestClientOptions options_;
  std::unique_ptr<Endpoints> endpoints_;
  std::uint64_t sequence_;
  AuthorityTracker authority_;
  StopTracker plant_stop_;
  UnansweredRequests unanswered_;
  std::map<std::uint64_t, msg::RequestAnswer> answers_;  ///< the newest, by number of the request
  std::string refusal_;
  std::uint64_t goal_ = 0;
};

/// Parameters of a task in which no parameter is given (the timeout is NaN).
msg::TaskParameters no_parameters();

/// A request that starts a task. No parameter is given, and `input` chooses the number of the goal.
msg::Request task_request(std::uint8_t task);

}  // namespace constrictor
