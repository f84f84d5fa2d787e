#include "input/arbiter.hpp"

namespace constrictor {

Ruling Arbiter::refuse(const std::string& reason) {
  ++state_.refused;
  state_.refusal = reason;
  return {Ruling::kRefused};
}

void Arbiter::take(const msg::Request& request) {
  state_.level = request.level;
  state_.holder = request.source;
}

std::uint64_t Arbiter::goal_id(const msg::Request& request) const {
  const auto source = state_.sources.find(request.source);
  const std::uint64_t index = source == state_.sources.end() ? 0 : source->second.index;
  return (static_cast<std::uint64_t>(request.level) << 48) + (index << 32) + (request.goal_id & 0xffffffffu);
}

Ruling Arbiter::decide(const msg::Request& request) {
  const std::string source = request.source;
  if (source.empty()) return refuse("source: found nothing, accepted a name");
  const auto [entry, first] = state_.sources.try_emplace(source);
  // The built-in planner is always number 0, so that it knows its goals' ids whoever else spoke before.
  if (first) entry->second.index = request.level == msg::kAuthorityPlanner ? 0 : static_cast<std::uint32_t>(state_.sources.size());
  if (request.header.sequence_number <= entry->second.sequence) {
    return refuse("sequence_number of " + source + ": found " + std::to_string(request.header.sequence_number) +
                  ", accepted more than " + std::to_string(entry->second.sequence));
  }
  entry->second.sequence = request.header.sequence_number;
  const bool holds = state_.holder == source;

  if (request.kind == msg::kRequestEmergencyStop) {
    state_.stopped = true;
    state_.stopper = source;
    return {Ruling::kCancelAll};
  }
  if (request.kind == msg::kRequestClearStop) {
    if (!state_.stopped) return refuse("clear stop: found no emergency stop");
    if (request.level < msg::kAuthorityOperator && source != state_.stopper) {
      return refuse("clear stop of " + source + ": accepted from an operator or from " + state_.stopper);
    }
    state_.stopped = false;
    state_.level = msg::kAuthorityNone;  // no motion begins by itself: somebody must ask anew
    state_.holder.clear();
    return {Ruling::kNothing};
  }
  if (state_.stopped) return refuse(source + ": emergency stop of " + state_.stopper + " is latched");
  if (request.kind == msg::kRequestRelease) {
    if (!holds) return refuse("release of " + source + ": authority is with " + (state_.holder.empty() ? "nobody" : state_.holder));
    state_.level = msg::kAuthorityNone;
    state_.holder.clear();
    return {Ruling::kCancelAll};
  }
  if (!holds && request.level <= state_.level) {
    return refuse(source + ": authority is with " + state_.holder);
  }
  const bool over = !holds && state_.level != msg::kAuthorityNone;
  take(request);
  if (request.kind == msg::kRequestTask) return {Ruling::kForward};
  return {over ? Ruling::kCancelAll : Ruling::kNothing};
}

Ruling Arbiter::on_death(const std::string& source) {
  if (state_.holder != source) return {Ruling::kNothing};
  state_.level = msg::kAuthorityNone;
  state_.holder.clear();
  return {Ruling::kCancelAll};
}

}  // namespace constrictor
