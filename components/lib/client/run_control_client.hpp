// Commands the time of a run: pause, resume, step, pace, reset, end.
#pragma once

#include <chrono>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>

#include "client/command_error.hpp"
#include "client/run_registry.hpp"
#include "constrictor/messages.hpp"

namespace constrictor {

/// Sends commands on `run_control/v2` and waits for the answers of the conductor. A command is repeated until it is
/// answered, because an answer may be written before its reader has been discovered; the conductor obeys it once.
/// All functions throw CommandError: kRefused with the conductor's reason, kNoAnswer, kInterrupted. Not thread-safe.
class RunControlClient {
 public:
  /// Joins the DDS domain of a run (find_domain()), with the key that run_key() finds. A process joins each domain
  /// once. `bound` is how long a command waits for its answer, and a step for the next tick. `interrupted` is called
  /// while a function waits; the wait ends when it returns true.
  explicit RunControlClient(std::uint32_t domain, std::chrono::seconds bound = std::chrono::seconds(10),
                            std::function<bool()> interrupted = {});
  /// The same on a participant that this process already has. The participant must outlive this object. `key`: empty:
  /// the one that run_key() finds.
  RunControlClient(std::int32_t participant, std::uint32_t domain, std::chrono::seconds bound,
                   std::function<bool()> interrupted = {}, std::optional<RunKey> key = {});
  ~RunControlClient();

  /// Each returns the state of the run right after the command was obeyed.
  msg::RunState pause();
  msg::RunState resume();
  /// Pauses the run, lets it make `ticks` more ticks and waits until they are done. Throws kNoAnswer if the run stops
  /// making ticks, or has not begun. With `waiting` it waits until the run begins, without a bound, and makes the first
  /// ticks then; meanwhile it calls `waiting` about every half second.
  msg::RunState step(std::uint32_t ticks, const std::function<void()>& waiting = {});
  /// Limits the run to `pace` times real time, 0.001 to 1000; 0: lock-step, as fast as possible.
  msg::RunState set_pace(double pace);
  /// Ends the epoch and begins a new one with `seed`.
  msg::RunState reset(std::uint64_t seed);
  /// Ends the run: every member finishes its current tick, and the report is complete.
  msg::RunState end();
  /// Sends a command; fills in source, number, run id and token.
  msg::RunState send(msg::RunControl command);

 private:
  struct Endpoints;
  RunControlClient(std::unique_ptr<Endpoints> endpoints, std::uint32_t domain, std::chrono::seconds bound,
                   std::function<bool()> interrupted, std::optional<RunKey> key);
  msg::RunState send(std::uint8_t command);
  msg::RunState pause_before_steps(const std::function<void()>& waiting);
  std::optional<msg::RunState> first_state(std::chrono::milliseconds bound);
  void throw_if_interrupted(const char* what) const;
  msg::RunState wait_for_tick(std::uint64_t run_id, std::int64_t tick);

  std::unique_ptr<Endpoints> endpoints_;
  std::uint32_t domain_;
  std::chrono::seconds bound_;
  std::function<bool()> interrupted_;
  std::string source_;
  std::uint64_t sequence_;
  RunKey key_;
};

}  // namespace constrictor
