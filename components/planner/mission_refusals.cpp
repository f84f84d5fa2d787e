// The reaction of the mission planner to requests that are refused or not answered.
#include <fmt/format.h>

#include "component/task_refusal.hpp"
#include "constrictor/text.hpp"
#include "constrictor/topics.hpp"
#include "planner/mission_planner.hpp"

namespace constrictor {

using enum MissionState;

std::uint8_t MissionPlanner::requested_task() const {
  if (memory_.steps_back) return msg::kTaskExplore;
  return searches() ? memory_.search_task : row_of(memory_.state).task;
}

bool MissionPlanner::barred(MissionState state) const {
  // The cause of the other states occurs only once, so they must begin now and pause before their first request.
  const bool may_wait =
      state == memory_.state || state == kTrackObject || state == kFollowLine || state == kTransport || state == kDrop;
  return may_wait && refusals().barred(row_of(state).task, memory_.active_s);
}

MissionState MissionPlanner::refused(const std::string& reason, const PlannerInputs& inputs) {
  const std::uint8_t task = requested_task();
  if (passes_by_itself(reason)) {
    refusals().wait(task, reason, memory_.active_s);
    return memory_.state;
  }
  refusals().reject(task, memory_.direction, reason, memory_.active_s);
  if (memory_.state == kInspect) return after_inspection(false, inputs);
  const MissionState to = row_of(memory_.state).failed;
  const bool lost_object = to == kSearchObject && memory_.state != kApproachAnew;
  return lost_object ? try_differently(reason) : to;
}

std::optional<MissionState> MissionPlanner::next_without_answer(const PlannerInputs& inputs) {
  const auto* authority = inputs.authority;
  const bool by_input = authority && text_of(authority->refused_source) == topics::kPlannerRequest.writer &&
                        authority->refused_sequence > memory_.refused_sequence;
  std::string reason;
  if (by_input) {
    memory_.refused_sequence = authority->refused_sequence;
    reason = text_of(authority->refusal);
  } else if (memory_.active_s - memory_.requested_s > kMissionPatience_s) {
    reason = fmt::format("navigation has not answered for {:.0f} s", kMissionPatience_s);
  } else {
    return std::nullopt;
  }
  refusals().wait(requested_task(), reason, memory_.active_s);
  return memory_.state;
}

std::string MissionPlanner::hindrance(const PlannerInputs& inputs) const {
  if (!memory_.suspended && memory_.blind)
    return "waits because no percepts arrive: are the camera and perception running?";
  if (!memory_.suspended) return refusals().answer();
  if (memory_.stopped)
    return "waits because of an emergency stop: clear it, and let a source take and release authority";
  return fmt::format("waits because {} has authority", text_of(inputs.authority->source));
}

}  // namespace constrictor
