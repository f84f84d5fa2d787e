// Whether the run that an operator began with is still there. Pure.
#pragma once

#include <chrono>
#include <cstdint>
#include <optional>
#include <string>

namespace constrictor::cli {

/// What an operator's program can see of its run.
struct RunSigns {
  bool launcher = true;                  ///< holds the claim of the domain
  bool plant_ended = false;              ///< it said so
  bool input = false;                    ///< has its topics in the domain
  std::optional<std::uint64_t> run_id;   ///< of the newest RunState
  std::uint64_t states_heard = 0;        ///< how many RunStates came; one a second at least
};

/// Nobody shall drive one run while looking at another, nor a dead one. The first run that is heard of is ours; another one in the
/// same domain is not.
class RunAttachment {
 public:
  using Clock = std::chrono::steady_clock;
  /// `input` may be away for so long: the launcher starts it again when it dies.
  static constexpr std::chrono::seconds kInputGrace{5};

  void look(const RunSigns& signs, Clock::time_point now);

  /// Why there is nothing to operate any more, for people; empty: it goes on.
  [[nodiscard]] const std::string& over() const { return over_; }
  /// False while nobody would listen: then nothing is sent that would move the robot later.
  [[nodiscard]] bool may_send() const { return over_.empty() && !input_gone_; }
  /// An emergency stop may be asked for also while `input` is away: it is said again until it is heard, and moves nothing.
  [[nodiscard]] bool may_stop() const { return over_.empty(); }
  /// [s] since the run last said how it is; 0 before its first word.
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

}  // namespace constrictor::cli
