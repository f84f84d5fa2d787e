// An action that a QueueWorld can perform next.
#pragma once

#include <string>
#include <tuple>

namespace constrictor::testing::toys {

struct QueueAction {
  enum Kind { kDeliver, kStep, kTick, kCrash, kReset } kind;
  std::string what;  ///< channel (kDeliver) or member (kStep, kCrash)
  int lost = 0;      ///< kCrash: number of the newest messages of each of its channels that were never sent
  bool operator<(const QueueAction& other) const {
    return std::tie(kind, what, lost) < std::tie(other.kind, other.what, other.lost);
  }
};

}  // namespace constrictor::testing::toys
