// The events at the buses, for people, and how they get into the log.
#pragma once

#include <cstdint>
#include <string>

#include "log/log.hpp"

namespace constrictor {

/// An event at a bus: a servo is lost, a port is back.
struct BusNews {
  std::string text;
  bool is_good = false;  ///< a trouble is over
};

/// Writes events with the log, but not as many as a loose contact may cause.
class NewsLog {
 public:
  static constexpr int kMost = 30;
  static constexpr std::int64_t kWindow_ticks = 500;

  explicit NewsLog(Log log) : log_(std::move(log)) {}
  /// Good news are information, others warnings. At most kMost of them in a window; their number is then logged at the
  /// begin of a later one.
  void write(const BusNews& news);
  /// To be called at every tick.
  void at(std::int64_t tick);

 private:
  Log log_;
  std::int64_t from_tick_ = 0;  ///< of the present window
  int written_ = 0;
  int left_out_ = 0;
};

}  // namespace constrictor
