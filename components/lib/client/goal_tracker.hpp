// The states and ends of goals, from the messages of `input` and `navigation`.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "client/newest_epoch.hpp"
#include "constrictor/messages.hpp"

namespace constrictor {

/// Parts of a goal's id: (level << 48) + (number of the source << 32) + the source's own number.
constexpr std::uint8_t goal_level(std::uint64_t goal) { return static_cast<std::uint8_t>(goal >> 48); }
constexpr std::uint32_t goal_number(std::uint64_t goal) { return static_cast<std::uint32_t>(goal); }

/// Takes messages in any order, also messages that writers keep for late readers. It ignores messages of any run but
/// the first, and of any epoch but the newest. Pure: no DDS, no clock.
class GoalTracker {
 public:
  void take(const msg::Authority& authority);
  void take(const msg::TaskStatus& status);
  void take(const msg::TaskEvent& event);

  /// Id of the goal that `input` forwarded last, from any source; 0: none in this epoch, or no message arrived.
  [[nodiscard]] std::uint64_t newest() const;
  /// Id of the newest goal whose source gave it this number (goal_number()); goals of operators take precedence. 0 if
  /// there is no such goal. If the argument is already a whole id, it is returned unchanged.
  [[nodiscard]] std::uint64_t find(std::uint64_t number) const;
  /// Navigation's first event of a goal: the goal was refused if `goal_state` is kGoalRefused, and accepted otherwise.
  /// Null if no event of the goal has arrived.
  [[nodiscard]] const msg::TaskEvent* answer(std::uint64_t goal) const;
  /// The first event of this kind in a goal; null if none has arrived.
  [[nodiscard]] const msg::TaskEvent* event(std::uint64_t goal, std::uint8_t kind) const;
  /// The first event of this kind in any goal after a tick; null if none has arrived.
  [[nodiscard]] const msg::TaskEvent* event_after(std::int64_t tick, std::uint8_t kind) const;
  /// All events of the newest epoch that arrived, in the order of their sequence numbers.
  [[nodiscard]] const std::vector<msg::TaskEvent>& events() const { return events_; }

  struct End {
    std::uint8_t state = msg::kGoalIdle;  ///< kGoalSucceeded or above
    std::string reason;
  };
  /// How a goal ended; empty while the goal has not ended. If `by_status` is true, navigation's TaskStatus is accepted
  /// as proof of the end, because the event may be lost.
  [[nodiscard]] std::optional<End> end(std::uint64_t goal, bool by_status) const;

  [[nodiscard]] std::uint32_t epoch() const { return present_.epoch(); }  ///< 0: no message arrived
  [[nodiscard]] std::int64_t tick() const { return tick_; }               ///< newest tick of any message; -1: none

 private:
  /// Returns false if the message must be ignored.
  bool counts(const msg::Header& header);

  NewestEpoch present_;
  std::int64_t tick_ = -1;
  std::optional<msg::Authority> authority_;
  std::optional<msg::TaskStatus> status_;
  std::vector<msg::TaskEvent> events_;
};

}  // namespace constrictor
