// Whether the run that a client has joined still exists.
#pragma once

#include <chrono>
#include <cstdint>
#include <optional>
#include <string>

namespace constrictor {

/// The observations of a client that show whether its run still exists.
struct RunSigns {
  bool launcher = true;                 ///< the launcher holds its claim of the DDS domain
  bool plant_ended = false;             ///< the plant reported that it has ended
  bool input = false;                   ///< `input` has a writer in the domain
  std::optional<std::uint64_t> run_id;  ///< of the newest RunState
  std::uint64_t states_heard = 0;       ///< number of RunStates that arrived; the conductor sends one a second at least
};

/// Keeps a client to the run of the first RunState: it must not command another run that starts later in the same
/// domain, nor a run that has ended. Pure: time is an argument.
class RunAttachment {
 public:
  using Clock = std::chrono::steady_clock;
  /// How long `input` may be missing before the client gives up. The launcher restarts `input` within this time.
  static constexpr std::chrono::seconds kInputGrace{5};

  void look(const RunSigns& signs, Clock::time_point now);

  /// Why the client must leave, as text for people; empty while the run goes on.
  [[nodiscard]] const std::string& over() const { return over_; }
  /// False while `input` is missing: a request that is repeated meanwhile could move the robot later, unexpectedly.
  [[nodiscard]] bool may_send() const { return over_.empty() && !input_gone_; }
  /// True even while `input` is missing: an emergency stop is repeated until it is answered, and it never moves the
  /// robot.
  [[nodiscard]] bool may_stop() const { return over_.empty(); }
  /// [s] since the last RunState; 0 before the first.
  [[nodiscard]] double silent_s() const { return silent_s_; }

 private:
  std::optional<std::uint64_t> run_id_;
  std::string over_;
  bool had_input_ = false;
  std::optional<Clock::time_point> input_gone_;
  std::uint64_t states_heard_ = 0;
  Clock::time_point heard_{};
  double silent_s_ = 0.0;
};

}  // namespace constrictor
