#include "cli/goal_watch.hpp"

#include <algorithm>

namespace constrictor::cli {
namespace {

template <class Condition>
const msg::TaskEvent* first(const std::vector<msg::TaskEvent>& events, Condition&& condition) {
  const auto found = std::find_if(events.begin(), events.end(), condition);
  return found == events.end() ? nullptr : &*found;
}

bool is_end(std::uint8_t state) { return state >= msg::kGoalSucceeded; }

}  // namespace

bool GoalWatch::counts(const msg::Header& header) {
  const auto is = present_.take(header.run_id, header.epoch);
  if (is == NewestEpoch::Is::kOther) return false;
  if (is == NewestEpoch::Is::kNew) {
    // A reset: goals are numbered anew.
    tick_ = -1;
    authority_.reset();
    status_.reset();
    events_.clear();
  }
  tick_ = std::max(tick_, header.tick);
  return true;
}

void GoalWatch::take(const msg::Authority& authority) {
  if (counts(authority.header) && (!authority_ || authority_->header.tick <= authority.header.tick)) authority_ = authority;
}

void GoalWatch::take(const msg::TaskStatus& status) {
  if (counts(status.header) && (!status_ || status_->header.tick <= status.header.tick)) status_ = status;
}

void GoalWatch::take(const msg::TaskEvent& event) {
  if (!counts(event.header)) return;
  const auto later = [](const msg::TaskEvent& a, const msg::TaskEvent& b) { return a.header.sequence_number < b.header.sequence_number; };
  events_.insert(std::upper_bound(events_.begin(), events_.end(), event, later), event);
}

std::uint64_t GoalWatch::newest() const {
  // `input` numbers goals; without its word navigation's newest one is the best that is known.
  if (authority_ && authority_->goal_id != 0) return authority_->goal_id;
  return status_ ? status_->goal_id : 0;
}

const msg::TaskEvent* GoalWatch::answer(std::uint64_t goal) const {
  return first(events_, [&](const msg::TaskEvent& e) { return e.goal_id == goal; });
}

const msg::TaskEvent* GoalWatch::event(std::uint64_t goal, std::uint8_t kind) const {
  return first(events_, [&](const msg::TaskEvent& e) { return e.goal_id == goal && e.event == kind; });
}

const msg::TaskEvent* GoalWatch::event_after(std::int64_t tick, std::uint8_t kind) const {
  return first(events_, [&](const msg::TaskEvent& e) { return e.header.tick > tick && e.event == kind; });
}

std::optional<GoalWatch::End> GoalWatch::end(std::uint64_t goal, bool by_status) const {
  const auto* event = first(events_, [&](const msg::TaskEvent& e) {
    return e.goal_id == goal && e.event == msg::kEventNone && is_end(e.goal_state);
  });
  if (event) return End{event->goal_state, event->detail};
  if (by_status && status_ && status_->goal_id == goal && is_end(status_->state)) return End{status_->state, status_->reason};
  return std::nullopt;
}

}  // namespace constrictor::cli
