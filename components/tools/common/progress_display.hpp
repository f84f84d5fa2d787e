// The output of `constrictor run` while the run goes on.
#pragma once

#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <string>

#include "common/screen_size.hpp"

namespace constrictor {

/// A status line that is rewritten on a terminal; elsewhere it is printed every few seconds if it has changed. On a
/// terminal it is cut to the width, because a terminal does not rewrite a line that it has wrapped.
class ProgressDisplay {
 public:
  void show_status(const std::string& line) {
    const auto now = std::chrono::steady_clock::now();
    if (!terminal_ && (now - shown_ < kEvery || line == last_)) return;
    shown_ = now;
    last_ = line;
    // The last column stays free: some terminals wrap a line that fills it.
    if (terminal_) std::printf("\r\033[K%s", screen_line(line, screen_size().columns - 1).c_str());
    else std::printf("%s\n", line.c_str());
    std::fflush(stdout);
  }
  /// Prints a line that stays.
  void print(const std::string& line) {
    std::printf("%s%s\n", terminal_ ? "\r\033[K" : "", line.c_str());
    std::fflush(stdout);
  }

 private:
  static constexpr std::chrono::seconds kEvery{5};
  bool terminal_ = ::isatty(STDOUT_FILENO) == 1;
  std::chrono::steady_clock::time_point shown_ = std::chrono::steady_clock::now();
  std::string last_;
};

/// Simulated time over wall time in about the last second.
class SpeedMeter {
 public:
  double factor(double sim_time_s) {
    const auto now = std::chrono::steady_clock::now();
    const double wall_s = std::chrono::duration<double>(now - since_).count();
    if (wall_s < 1.0) return factor_;
    factor_ = std::max(0.0, sim_time_s - sim_time_s_) / wall_s;
    since_ = now;
    sim_time_s_ = sim_time_s;
    return factor_;
  }

 private:
  std::chrono::steady_clock::time_point since_ = std::chrono::steady_clock::now();
  double sim_time_s_ = 0;
  double factor_ = 0;
};

}  // namespace constrictor
