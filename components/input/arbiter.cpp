#include "input/arbiter.hpp"

#include <algorithm>

#include "component/task_parameters.hpp"
#include "constrictor/text.hpp"
#include "constrictor/topics.hpp"

namespace constrictor {
namespace {
constexpr std::uint64_t kMaxOwnGoal = 0xffffffffu;
constexpr std::size_t kMaxSources = 64;        // at a time; sources whose process has ended are removed
constexpr std::size_t kKeptForOperators = 16;  // of kMaxSources
constexpr std::uint64_t kRemembered = 64;      // sequence numbers of a source with a known decision

bool is_readable(const std::string& name) {
  return !name.empty() && std::all_of(name.begin(), name.end(), [](char c) { return c > ' ' && c <= '~'; });
}

}  // namespace

Decision Arbiter::refuse(const std::string& reason) {
  ++state_.refused;
  state_.refusal = reason;
  state_.refused_source = state_.answered_source;
  state_.refused_sequence = state_.answered_sequence;
  if (const auto known = state_.sources.find(state_.answered_source); known != state_.sources.end()) {
    if (known->second.sequence == state_.answered_sequence) known->second.granted &= ~std::uint64_t{1};
  }
  return {Decision::kRefused};
}

Decision Arbiter::refuse(const msg::Request& request, const std::string& reason) {
  note(request);
  return refuse(reason);
}

void Arbiter::note(const msg::Request& request) {
  const std::string name = text_of(request.source);
  state_.answered_source = is_readable(name) ? name : "?";  // people read it on terminals
  state_.answered_sequence = request.header.sequence_number;
}

/// A holder whose process has ended is removed when it loses authority.
void Arbiter::forget_gone_holder() {
  const auto holder = state_.sources.find(state_.holder);
  if (holder != state_.sources.end() && holder->second.gone) state_.sources.erase(holder);
}

void Arbiter::leave_to_nobody() {
  forget_gone_holder();
  state_.level = msg::kAuthorityNone;
  state_.holder.clear();
}

void Arbiter::hold(const msg::Request& request, Source& source) {
  if (state_.holder != state_.answered_source) forget_gone_holder();
  state_.level = request.level;
  state_.holder = state_.answered_source;
  source.detached = request.detached;
}

bool Arbiter::holder_is_detached() const {
  const auto holder = state_.sources.find(state_.holder);
  return holder != state_.sources.end() && holder->second.detached;
}

Decision Arbiter::decide(const msg::Request& request, bool built_in) {
  const std::string name = text_of(request.source);
  note(request);
  if (request.kind == msg::kRequestEmergencyStop) return stop(state_.answered_source);
  if (!is_readable(name))
    return refuse("source: found nothing or unprintable characters, accepted a name without blanks");
  // The request need not have passed the validation of the runtime.
  if (built_in ? request.level != msg::kAuthorityPlanner
               : request.level != msg::kAuthorityExternal && request.level != msg::kAuthorityOperator) {
    return refuse("level of " + name + ": found " + std::to_string(request.level) +
                  (built_in ? ", accepted 1" : ", accepted 2 (external planner) or 3 (operator)"));
  }
  // The name is reserved for the built-in planner before its first request, too.
  if (!built_in && name == topics::kPlannerRequest.writer)
    return refuse("source " + name + ": the name is reserved for the built-in planner");
  const auto known = state_.sources.find(name);
  if (known != state_.sources.end() && (known->second.index == 0) != built_in) {
    return refuse("source " + name + ": the name is " +
                  (built_in ? "used by a client" : "reserved for the built-in planner"));
  }
  const std::size_t room = kMaxSources - (request.level == msg::kAuthorityExternal ? kKeptForOperators : 0);
  if (known == state_.sources.end() && state_.sources.size() >= room) {
    return refuse("source " + name + ": there are " + std::to_string(room) + " sources already");
  }
  const auto [entry, first] = state_.sources.try_emplace(name);
  Source& source = entry->second;
  if (first && !built_in) source.index = state_.next_index++;
  const std::uint64_t number = request.header.sequence_number;
  if (number <= source.sequence) {
    const std::uint64_t age = source.sequence - number;
    if (age < kRemembered && (source.decided >> age & 1) != 0)
      return {Decision::kRepeated, 0, (source.granted >> age & 1) != 0};
    return refuse("sequence_number of " + name + ": found " + std::to_string(number) + ", accepted more than " +
                  std::to_string(source.sequence));
  }
  const std::uint64_t shift = number - source.sequence;
  source.decided = (shift < kRemembered ? source.decided << shift : 0) | 1;
  source.granted = (shift < kRemembered ? source.granted << shift : 0) | 1;  // unless it is refused below
  source.sequence = number;

  switch (request.kind) {
    case msg::kRequestClearStop:
      return clear_stop(request);
    case msg::kRequestTask:
    case msg::kRequestTake:
    case msg::kRequestRelease:
    case msg::kRequestMotion:
      break;
    case msg::kRequestParameter:
      if (request.level < state_.level)
        return refuse(name + ": authority is with " + state_.holder + ", of a higher level");
      return {Decision::kSet};
    default:
      return refuse("kind of " + name + ": found " + std::to_string(request.kind) + ", accepted 0 to 6");
  }
  if (state_.stopped) return refuse(name + ": the emergency stop of " + state_.stopper + " is latched");
  if (request.kind == msg::kRequestRelease) return release(request);
  const bool holds = state_.holder == name;
  const bool outranks = request.level > state_.level || (request.level == state_.level && holder_is_detached());
  if (!holds && !outranks) return refuse(name + ": authority is with " + state_.holder);
  if (request.kind == msg::kRequestTask) return decide_task(request, source);
  if (request.kind == msg::kRequestMotion) {
    if (request.motion >= msg::kMotionCount) {
      return refuse("motion of " + name + ": found " + std::to_string(request.motion) + ", accepted 0 to " +
                    std::to_string(msg::kMotionCount - 1));
    }
    hold(request, source);
    return {Decision::kMove};
  }
  const bool takes_over = !holds && state_.level != msg::kAuthorityNone;
  hold(request, source);
  return {takes_over ? Decision::kCancelAll : Decision::kNothing};
}

Decision Arbiter::decide_task(const msg::Request& request, Source& source) {
  const std::string name = request.source;
  std::uint64_t goal = request.goal_id;
  if (request.command == msg::kCommandStart) {
    if (goal == 0) goal = source.last_goal + 1;
    // Before the request takes authority: a task that cannot start must not end the running one.
    const std::string problem = task_parameter_refusal(request.task, request.parameters, request.path);
    if (!problem.empty()) return refuse(name + ": " + problem);
    if (goal <= source.last_goal || goal > kMaxOwnGoal) {
      return refuse("goal_id of " + name + ": found " + std::to_string(goal) + ", accepted " +
                    std::to_string(source.last_goal + 1) + " to " + std::to_string(kMaxOwnGoal));
    }
    source.last_goal = goal;
  } else if (request.command != msg::kCommandCancel) {
    return refuse("command of " + name + ": found " + std::to_string(request.command) + ", accepted 0 or 1");
  } else if (goal == 0 || goal > source.last_goal) {
    return refuse("cancel of " + name + ": goal " + std::to_string(goal) + " was never started");
  }
  const bool takes_over = state_.holder != name && state_.level != msg::kAuthorityNone;
  hold(request, source);
  if (takes_over && request.command == msg::kCommandCancel)
    return {Decision::kCancelAll};  // the running task belongs to another source
  return {Decision::kForward, mapped_goal_id(request.level, source.index, goal)};
}

Decision Arbiter::stop(const std::string& source) {
  state_.stopped = true;
  state_.stopper = source.empty() ? "?" : source;
  return {Decision::kCancelAll};
}

Decision Arbiter::clear_stop(const msg::Request& request) {
  const std::string name = request.source;
  if (!state_.stopped) return refuse("clear stop of " + name + ": no emergency stop is latched");
  if (request.level < msg::kAuthorityOperator && name != state_.stopper) {
    return refuse("clear stop of " + name + ": accepted from an operator or from " + state_.stopper);
  }
  state_.stopped = false;
  leave_to_nobody();  // no motion begins by itself: a source must take authority again
  return {Decision::kNothing};
}

Decision Arbiter::release(const msg::Request& request) {
  const std::string name = request.source;
  const bool for_another = holder_is_detached() && request.level >= state_.level;
  if (state_.holder != name && !for_another) {
    return refuse("release of " + name +
                  (state_.holder.empty() ? ": no source has authority" : ": authority is with " + state_.holder));
  }
  leave_to_nobody();
  return {Decision::kCancelAll};
}

Decision Arbiter::decide_client(const msg::Request& request, const WriterId& writer) {
  const std::string name = text_of(request.source);
  const auto store_writer = [&] {
    const auto known = state_.sources.find(name);
    if (known == state_.sources.end() || known->second.index == 0) return;
    known->second.writer = writer;
    known->second.gone = false;
  };
  store_writer();
  const Decision decision = decide(request, false);
  store_writer();  // of a source whose first request this is
  return decision;
}

bool Arbiter::has_another_writer(const std::string& source, const WriterId& writer) const {
  const auto known = state_.sources.find(source);
  return known != state_.sources.end() && known->second.writer != WriterId{} && known->second.writer != writer;
}

std::vector<LivingSource> Arbiter::living() const {
  std::vector<LivingSource> living;
  for (const auto& [name, source] : state_.sources) {
    if (source.writer != WriterId{} && !source.gone) living.push_back({name, source.writer});
  }
  return living;
}

Decision Arbiter::on_death(const std::string& source) {
  const auto known = state_.sources.find(source);
  if (known == state_.sources.end() || known->second.index == 0) return {Decision::kNothing};
  if (known->second.detached && state_.holder == source) {
    known->second.gone = true;
    known->second.sequence = known->second.decided = known->second.granted =
        0;  // the next source of this name counts from 1
    return {Decision::kNothing};
  }
  state_.sources.erase(known);
  if (state_.holder != source) return {Decision::kNothing};
  leave_to_nobody();
  return {Decision::kCancelAll};
}

}  // namespace constrictor
