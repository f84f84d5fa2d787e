// How late ticks arrive at real-time pace. Components do not see it.
#pragma once

#include <array>
#include <chrono>
#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "constrictor/messages.hpp"

namespace constrictor {

/// The jitter of a tick is how much later it arrives than one period after the tick before; it is negative for a tick
/// that makes up for a late one.
class JitterMeter {
 public:
  using Clock = std::chrono::steady_clock;

  /// A tick of the run's time `time_ns` has arrived at `now`. The first one after begin() or interrupt() only starts
  /// the measurement.
  void arrived(Clock::time_point now, std::int64_t time_ns);
  /// A new epoch begins.
  void begin();
  /// Ticks stop on purpose: the run is paused.
  void interrupt() { last_.reset(); }
  /// Fills the fields of jitter and begins a new interval.
  void fill(msg::ComponentStatus& status);
  /// All ticks of this epoch by how late they were, for people: "1,500 ticks: 96.2 % at most 0.1 ms late, ... the
  /// latest 3.1 ms"; empty: none was measured.
  [[nodiscard]] std::string histogram() const;

 private:
  struct Arrival {
    Clock::time_point at;
    std::int64_t time_ns;
  };
  /// Upper ends [us] of the classes of the histogram; the last class has no end.
  static constexpr std::array kClasses_us{100.0, 500.0, 1000.0, 2000.0, 5000.0, 10000.0, 20000.0, 50000.0};

  std::optional<Arrival> last_;
  std::vector<double> interval_us_;  ///< since the last status
  std::array<std::uint64_t, kClasses_us.size() + 1> counts_{};
  double max_us_ = -std::numeric_limits<double>::infinity();
};

}  // namespace constrictor
