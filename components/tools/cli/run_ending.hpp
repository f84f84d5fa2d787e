// How the launcher ends a run when the user asks for it: it asks the conductor, and kills the processes if that fails.
// Pure: signals, answers and time are arguments.
#pragma once

#include <chrono>
#include <optional>
#include <string>

namespace constrictor::cli {

/// After the first signal the launcher asks the conductor to end the run, so that all components finish the last tick
/// and the report is complete. The processes are killed instead when a second signal arrives, the run has not begun,
/// the conductor refuses or does not answer, or the run does not end within kEndBound of the answer.
class RunEnding {
 public:
  using Time = std::chrono::steady_clock::time_point;
  static constexpr std::chrono::seconds kEndBound{60};  ///< the report component draws its figure in this time

  static constexpr std::chrono::milliseconds kSameWish{200};

  /// A signal arrived that asks to end the run. `begun`: the first tick was published. A signal within kSameWish of the
  /// first one counts as the same: `timeout`, for example, signals the process and then its process group.
  void signal_received(int number, bool begun, Time now);
  /// The conductor accepted the request, or the run is over already.
  void accepted(Time now);
  /// The conductor refused the request or did not answer it.
  void failed(const std::string& reason);

  [[nodiscard]] bool requested() const { return first_signal_ != 0; }
  /// True if the conductor must be asked.
  [[nodiscard]] bool wants_answer() const { return requested() && !accepted_at_ && kill_reason_.empty(); }
  /// The first signal; 0 before it.
  [[nodiscard]] int first_signal() const { return first_signal_; }
  /// Why the processes must be killed now, as text for users; empty if they need not be killed.
  [[nodiscard]] std::string kill_reason(Time now) const;
  /// True after a second signal: processes get no time to end by themselves.
  [[nodiscard]] bool at_once() const { return at_once_; }

 private:
  int first_signal_ = 0;
  Time first_signal_at_{};
  bool at_once_ = false;
  std::optional<Time> accepted_at_;
  std::string kill_reason_;
};

}  // namespace constrictor::cli
