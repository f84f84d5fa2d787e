// What was asked of `input` and not answered yet, to be said again: it hears nothing while its process is being restarted.
#pragma once

#include <algorithm>
#include <chrono>
#include <cstdint>
#include <deque>

#include "constrictor/messages.hpp"

namespace constrictor {

/// Requests of one source. Each is ruled on once, however often it is said under its number.
class UnansweredRequests {
 public:
  using Time = std::chrono::steady_clock::time_point;

  /// A request was written. A motion takes the place of an earlier one, and an emergency stop that of everything: nothing of before
  /// may move the robot once the stop is cleared. At most 32 are kept.
  void asked(const msg::Request& request, Time now) {
    std::erase_if(said_, [&](const Said& earlier) {
      return request.kind == msg::kRequestEmergencyStop ||
             (request.kind == msg::kRequestMotion && earlier.request.kind == msg::kRequestMotion);
    });
    if (said_.size() >= 32) said_.pop_front();
    said_.push_back({request, now});
  }
  void answered(std::uint64_t number) {
    std::erase_if(said_, [&](const Said& said) { return said.request.header.sequence_number == number; });
  }
  /// Writes again, in their order, what has not been answered for so long.
  template <class Write>
  void repeat(Time now, std::chrono::milliseconds after, Write&& write) {
    for (Said& said : said_) {
      if (now - said.at < after) continue;
      write(said.request);
      said.at = now;
    }
  }
  /// Number of the emergency stop that is not answered yet; 0: none.
  [[nodiscard]] std::uint64_t stop() const {
    const auto at = std::find_if(said_.begin(), said_.end(), [](const Said& said) { return said.request.kind == msg::kRequestEmergencyStop; });
    return at == said_.end() ? 0 : at->request.header.sequence_number;
  }

 private:
  struct Said {
    msg::Request request;
    Time at;
  };
  std::deque<Said> said_;
};

}  // namespace constrictor
