// The requests of one source that `input` has not answered yet.
#pragma once

#include <algorithm>
#include <chrono>
#include <cstdint>
#include <deque>

#include "constrictor/messages.hpp"

namespace constrictor {

/// Keeps requests so that their source can repeat them until they are answered: a request that arrives while the
/// process of `input` restarts is lost. `input` decides once on each request, however often the request arrives under
/// the same number.
class UnansweredRequests {
 public:
  using Time = std::chrono::steady_clock::time_point;

  /// Keeps a request that was written. A motion replaces an earlier motion; an emergency stop replaces every earlier
  /// request, because none of them may move the robot after the stop is cleared. Keeps the newest 32 requests.
  void asked(const msg::Request& request, Time now) {
    std::erase_if(pending_, [&](const Pending& earlier) {
      return request.kind == msg::kRequestEmergencyStop ||
             (request.kind == msg::kRequestMotion && earlier.request.kind == msg::kRequestMotion);
    });
    if (pending_.size() >= 32) pending_.pop_front();
    pending_.push_back({request, now});
  }
  /// Discards the request with this number.
  void answered(std::uint64_t number) {
    std::erase_if(pending_, [&](const Pending& pending) { return pending.request.header.sequence_number == number; });
  }
  /// Calls `write(request)`, in the order of the requests, for each one that was last written at least `after` ago.
  template <class Write>
  void repeat(Time now, std::chrono::milliseconds after, Write&& write) {
    for (Pending& pending : pending_) {
      if (now - pending.written < after) continue;
      write(pending.request);
      pending.written = now;
    }
  }
  /// Number of the unanswered emergency stop; 0: none.
  [[nodiscard]] std::uint64_t stop() const {
    const auto at = std::find_if(pending_.begin(), pending_.end(), [](const Pending& pending) {
      return pending.request.kind == msg::kRequestEmergencyStop;
    });
    return at == pending_.end() ? 0 : at->request.header.sequence_number;
  }

 private:
  struct Pending {
    msg::Request request;
    Time written;  ///< last time
  };
  std::deque<Pending> pending_;
};

}  // namespace constrictor
