#include "client/goal_tracker.hpp"

#include <algorithm>

namespace constrictor {
namespace {

template <class Condition>
const msg::TaskEvent* first(const std::vector<msg::TaskEvent>& events, Condition&& condition) {
  const auto found = std::find_if(events.begin(), events.end(), condition);
  return found == events.end() ? nullptr : &*found;
}

bool is_end(std::uint8_t state) { return state >= msg::kGoalSucceeded; }

}  // namespace

bool GoalTracker::counts(const msg::Header& header) {
  const auto is = present_.take(header.run_id, header.epoch);
  if (is == NewestEpoch::Is::kOther) return false;
  if (is == NewestEpoch::Is::kNew) {
    // After a reset goals are numbered from 1 again.
    tick_ = -1;
    authority_.reset();
    status_.reset();
    events_.clear();
  }
  tick_ = std::max(tick_, header.tick);
  return true;
}

void GoalTracker::take(const msg::Authority& authority) {
  if (counts(authority.header) && (!authority_ || authority_->header.tick <= authority.header.tick))
    authority_ = authority;
}

void GoalTracker::take(const msg::TaskStatus& status) {
  if (counts(status.header) && (!status_ || status_->header.tick <= status.header.tick)) status_ = status;
}

void GoalTracker::take(const msg::TaskEvent& event) {
  if (!counts(event.header)) return;
  const auto later = [](const msg::TaskEvent& a, const msg::TaskEvent& b) {
    return a.header.sequence_number < b.header.sequence_number;
  };
  events_.insert(std::upper_bound(events_.begin(), events_.end(), event, later), event);
}

std::uint64_t GoalTracker::newest() const {
  // `input` numbers goals. Without its message, navigation's current goal is the best estimate.
  if (authority_ && authority_->goal_id != 0) return authority_->goal_id;
  return status_ ? status_->goal_id : 0;
}

std::uint64_t GoalTracker::find(std::uint64_t number) const {
  if (number != goal_number(number)) return number;
  std::vector<std::uint64_t> goals = {newest()};
  if (status_) goals.push_back(status_->goal_id);
  for (auto event = events_.rbegin(); event != events_.rend(); ++event) goals.push_back(event->goal_id);
  const auto matches = [&](std::uint64_t goal) { return goal != 0 && goal_number(goal) == number; };
  const auto of_operator = std::find_if(goals.begin(), goals.end(), [&](std::uint64_t goal) {
    return matches(goal) && goal_level(goal) == msg::kAuthorityOperator;
  });
  const auto found = of_operator != goals.end() ? of_operator : std::find_if(goals.begin(), goals.end(), matches);
  return found == goals.end() ? 0 : *found;
}

const msg::TaskEvent* GoalTracker::answer(std::uint64_t goal) const {
  return first(events_, [&](const msg::TaskEvent& e) { return e.goal_id == goal; });
}

const msg::TaskEvent* GoalTracker::event(std::uint64_t goal, std::uint8_t kind) const {
  return first(events_, [&](const msg::TaskEvent& e) { return e.goal_id == goal && e.event == kind; });
}

const msg::TaskEvent* GoalTracker::event_after(std::int64_t tick, std::uint8_t kind) const {
  return first(events_, [&](const msg::TaskEvent& e) { return e.header.tick > tick && e.event == kind; });
}

std::optional<GoalTracker::End> GoalTracker::end(std::uint64_t goal, bool by_status) const {
  const auto* event = first(events_, [&](const msg::TaskEvent& e) {
    return e.goal_id == goal && e.event == msg::kEventNone && is_end(e.goal_state);
  });
  if (event) return End{event->goal_state, event->detail};
  if (by_status && status_ && status_->goal_id == goal && is_end(status_->goal_state))
    return End{status_->goal_state, status_->reason};
  return std::nullopt;
}

}  // namespace constrictor
