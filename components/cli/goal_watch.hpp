// What becomes of goals, by what `input` and navigation say of them. Pure.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "cli/newest_epoch.hpp"
#include "constrictor/messages.hpp"

namespace constrictor::cli {

/// Takes messages in any order, those that writers kept for late readers included. What is of an epoch before the newest, or of
/// another run than the first, does not count.
class GoalWatch {
 public:
  void take(const msg::Authority& authority);
  void take(const msg::TaskStatus& status);
  void take(const msg::TaskEvent& event);

  /// The goal that was passed on last, by whomever; 0: none in this epoch, or nothing was heard.
  [[nodiscard]] std::uint64_t newest() const;
  /// Navigation's answer to a goal, its first word on it: refused if `goal_state` says so, accepted otherwise. Null: none yet.
  [[nodiscard]] const msg::TaskEvent* answer(std::uint64_t goal) const;
  /// The first event of this kind in a goal; null: none yet.
  [[nodiscard]] const msg::TaskEvent* event(std::uint64_t goal, std::uint8_t kind) const;
  /// The same in any goal, after a tick.
  [[nodiscard]] const msg::TaskEvent* event_after(std::int64_t tick, std::uint8_t kind) const;

  struct End {
    std::uint8_t state = msg::kGoalIdle;
    std::string reason;
  };
  /// How a goal ended; empty: it did not yet. With `by_status` also if only the state of navigation tells, whose events are lost.
  [[nodiscard]] std::optional<End> end(std::uint64_t goal, bool by_status) const;

  [[nodiscard]] std::uint32_t epoch() const { return present_.epoch(); }  ///< 0: nothing was heard
  [[nodiscard]] std::int64_t tick() const { return tick_; }          ///< newest that was heard of; -1: none

 private:
  /// False: the message does not count.
  bool counts(const msg::Header& header);

  NewestEpoch present_;
  std::int64_t tick_ = -1;
  std::optional<msg::Authority> authority_;
  std::optional<msg::TaskStatus> status_;
  std::vector<msg::TaskEvent> events_;  ///< in order of their ticks
};

}  // namespace constrictor::cli
