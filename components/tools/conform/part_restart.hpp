// The check "restart" of a part: its process is killed and started again while the same is played to it as before, and
// its answers must be those of a part that was not killed.
#pragma once

#include <cstdint>
#include <functional>
#include <string>

#include "conform/part_port.hpp"
#include "conform/report.hpp"

namespace constrictor::conform {

class PartRestart {
 public:
  explicit PartRestart(PartPort& port) : port_(port) {}

  /// To be called once, between two ticks.
  void kill();
  /// Makes the check. `play` plays the inputs, calls kill() in the middle, and returns how the answers differ from
  /// those without a restart; empty: they do not. `equal`: what is then said of them.
  void judge(Report& report, const std::function<std::string()>& play, const std::string& equal);

 private:
  PartPort& port_;
  std::uint32_t before_ = 0;  ///< incarnation
  std::string obstacle_;
};

/// The check in the list of a part's checks.
[[nodiscard]] Check restart_check();

}  // namespace constrictor::conform
