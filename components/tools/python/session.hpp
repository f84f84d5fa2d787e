// A Python program's connection to a run, or to a DDS domain without one. No type of Python is in it.
#pragma once

#include <atomic>
#include <chrono>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "client/goal_reader.hpp"
#include "client/request_client.hpp"
#include "client/run_control_client.hpp"
#include "client/run_monitor.hpp"
#include "cyclone/domain.hpp"
#include "python/turns.hpp"

namespace constrictor::python {

/// A wait reached the bound that the caller gave.
class WaitTimeout : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

struct SessionOptions {
  std::optional<std::uint32_t> domain;  ///< of the run; empty: the only run on this host
  std::string directory;                ///< the run that writes its report here; empty: by `domain`
  bool observe = false;                 ///< any domain, also without a run; nothing can be commanded
  std::string name = "python";          ///< begins the name of the source
  bool as_operator = false;             ///< level of the requests; else external planner
  bool detached = false;                ///< authority outlives the session
  std::string token;                    ///< empty: that of `token_file`, or the one that run_key() finds
  std::string token_file;
};

/// Parameters of a task; what is empty is not given.
struct TaskArguments {
  std::optional<std::string> line_colour, object_colour, drop_zone_colour, direction;
  std::optional<std::uint16_t> object_handle;
  std::map<std::string, double> numbers;  ///< by the names of task_numbers()
  std::vector<std::pair<double, double>> path;
};

/// All functions may be called from several threads. While one waits, the others get their turn every 10 ms. They throw
/// CommandError, WaitTimeout, dds::Error, and std::invalid_argument for a wrong argument.
class Session {
 public:
  /// `interrupted` is called while a function waits, without any lock of this object; if it returns true, the wait ends
  /// with CommandError (kInterrupted).
  Session(const SessionOptions& options, std::function<bool()> interrupted);
  ~Session();

  /// Makes the robot stand and releases authority if this session has it and is not detached, and leaves the run. Ends
  /// the waits of other threads. The second call does nothing.
  void close();
  [[nodiscard]] bool closed() const { return closing_; }

  [[nodiscard]] std::uint32_t domain() const { return domain_; }
  [[nodiscard]] const std::optional<RunNote>& note() const { return note_; }
  [[nodiscard]] std::string source() const { return source_; }
  /// Run id and token of the requests; empty in a domain without a run.
  [[nodiscard]] const std::optional<RunKey>& key() const { return request_options_.key; }
  /// The DDS participant; subscriptions keep it until they end.
  [[nodiscard]] std::shared_ptr<dds::Domain> participant();
  /// Why the run is over, for people, also after close(); empty while it goes on, and in a domain without a run.
  std::string over();
  /// The newest RunState; waits up to 3 s for the first. Throws WaitTimeout.
  msg::RunState state();
  /// The newest Authority message; waits for it as connecting does.
  msg::Authority authority();
  nlohmann::ordered_json components();

  void take();
  /// Returns whether this session has no authority afterwards.
  bool release();
  void move(const std::string& motion, double speed_m_s, double curvature_1_m, double angle_rad);
  void drive(double speed_m_s, double turn_rad_s);
  /// Returns the goal's id.
  std::uint64_t start(const std::string& task, const TaskArguments& arguments);
  /// Returns state and reason of the goal's end. `timeout_s`: empty: no bound.
  std::pair<std::string, std::string> wait_for_end(std::uint64_t goal, std::optional<double> timeout_s);
  /// The first event of this name in a goal. Throws CommandError if the goal ends without it.
  msg::TaskEvent wait_for_event(std::uint64_t goal, const std::string& event, std::optional<double> timeout_s);
  std::vector<msg::TaskEvent> events(std::uint64_t goal);
  void emergency_stop();
  void clear_stop();
  /// Waits until the robot's time has advanced by this much [s]. Throws CommandError if the run ends before.
  void wait(double duration_s);

  nlohmann::ordered_json parameters();
  /// Returns the value and the tick from which it is in force.
  std::pair<double, std::int64_t> set_parameter(const std::string& name, double value, std::int64_t tick);

  /// Calls `use` with the client for the time of the run.
  msg::RunState control(const std::function<msg::RunState(RunControlClient&)>& use);

 private:
  class Turn;
  void need_run() const;
  bool pass();
  void next_poll();
  RequestClient& client();
  void granted(std::uint64_t number) { granted(client_->wait_for_answer(number, std::chrono::seconds(5))); }
  void granted(RequestClient::Answer answer);
  void expect_going_on();
  bool over_now();
  void leave_run();

  std::function<bool()> interrupted_;
  std::uint32_t domain_ = 0;
  std::optional<RunNote> note_;
  std::string source_;
  bool detached_ = false;
  std::atomic<bool> closing_ = false;
  Turns turns_;
  std::atomic<int> users_ = 0;  ///< calls that have begun and not ended
  RequestClientOptions request_options_;
  std::shared_ptr<dds::Domain> participant_;
  std::unique_ptr<RequestClient> client_;
  std::unique_ptr<RunControlClient> control_;
  std::unique_ptr<RunMonitor> monitor_;
};

}  // namespace constrictor::python
