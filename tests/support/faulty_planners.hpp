// The project's planner with the faults that planners have.
#pragma once

#include <algorithm>
#include <initializer_list>
#include <memory>
#include <string>
#include <vector>

#include "constrictor/text.hpp"
#include "planner/planner.hpp"
#include "support/faulty_part.hpp"
#include "support/named_fault.hpp"

namespace constrictor::testing {

/// The faults. Each has the check of `constrictor conform planner` that must fail, and a part of the text that it must
/// report.
inline std::vector<NamedFault> planner_faults() {
  return {{"silent", "arrives", "no mission_status"},
          {"asks_nothing", "search", "no request"},
          {"ignores_line", "line", "after 3 s"},
          {"follows_red", "line_colour", "red, in a mission with a blue line"},
          {"ignores_line_lost", "line_lost", "follow_line"},
          {"ignores_refusals", "refused", "no request after the refusal"},
          {"asks_once", "lost_request", "0 requests"},
          {"ignores_authority", "authority", "in 3 s"},
          {"never_returns", "returns", "0 requests"},
          {"ignores_stop", "stop", "in 3 s"},
          {"tracks_all", "other_object", "track_object"},
          {"blind", "object", "follow_line"},
          {"obeys_all_goals", "wrong_goal", "after an event of another goal"},
          {"leaves_pregrasp_out", "reached", "grasp"},
          {"ignores_pregrasp_lost", "pregrasp_lost", "pregrasp"},
          {"ignores_pregrasped", "pregrasped", "pregrasp"},
          {"wrong_handle", "handle", "handle 10"},
          {"ignores_grasped", "carries", "grasp"},
          {"wrong_zone", "drop", "yellow zone"},
          {"counts_nothing", "delivered", "delivered_count 0"},
          {"only_green", "rest", "when the red object is in view"},
          {"never_ends", "ends", "outcome 0"},
          {"commands_as_operator", "form", "level 3"},
          {"turns_nowhere", "carries", "rotate"},
          {"forgets_recoveries", "status", "recoveries, after"},
          {"remembers", "epoch", "goes on with outcome"},
          {"random", "repeatable", "differs"},
          {"forgets", "restart", "after a restart"}};
}

/// The fault of this name; empty: none. `memory` outlives the epochs.
inline PartFault planner_fault(const std::string& name, const std::shared_ptr<std::uint64_t>& memory) {
  PartFault fault;
  const auto request = [&](auto change) { fault.writes = changing(topics::kPlannerRequest, change); };
  const auto mission = [&](auto change) { fault.writes = changing(topics::kMissionStatus, change); };
  const auto authority = [&](auto change) { fault.reads = changing(topics::kAuthority, change); };
  /// These events never arrive, and the status does not show the end that they bring.
  const auto deaf_to = [&](std::uint8_t task, std::uint8_t event) {
    fault.reads = [task, event](const TopicInfo& topic, void* message, std::int64_t) {
      if (auto* status = as(topics::kTaskStatus, topic, message)) {
        if (status->task == task) status->goal_state = msg::kGoalRunning;
      }
      const auto* heard = as(topics::kTaskEvent, topic, message);
      return heard == nullptr || heard->event != event;
    };
  };
  const auto is = [&](const char* one) { return name == one; };
  if (is("silent")) fault.writes = [](const TopicInfo&, void*) { return false; };
  if (is("asks_nothing"))
    fault.writes = [](const TopicInfo& topic, void*) { return topic.id != topics::kPlannerRequest.id; };
  if (is("ignores_line"))
    fault.reads = [](const TopicInfo& topic, void*, std::int64_t) { return topic.id != topics::kLinePercept.id; };
  if (is("follows_red"))
    request([](msg::Request& r) {
      if (r.parameters.line_colour) r.parameters.line_colour = msg::kColourRed;
    });
  if (is("ignores_line_lost")) deaf_to(msg::kTaskFollowLine, msg::kEventLineLost);
  if (is("ignores_refusals"))
    fault.reads = [](const TopicInfo& topic, void* message, std::int64_t) {
      if (auto* status = as(topics::kTaskStatus, topic, message)) {
        if (status->goal_state == msg::kGoalRefused) status->goal_state = msg::kGoalRunning;
      }
      const auto* event = as(topics::kTaskEvent, topic, message);
      return event == nullptr || event->goal_state != msg::kGoalRefused;
    };
  if (is("asks_once") || is("obeys_all_goals")) {
    auto goal = std::make_shared<std::uint64_t>(0);
    request([goal](msg::Request& r) { *goal = (std::uint64_t{msg::kAuthorityPlanner} << 48) + r.goal_id; });
    fault.reads = [goal, once = is("asks_once")](const TopicInfo& topic, void* message, std::int64_t) {
      auto* status = as(topics::kTaskStatus, topic, message);
      if (once && status && status->goal_id != *goal) {
        status->goal_id = *goal;
        status->goal_state = msg::kGoalRunning;
      }
      auto* event = as(topics::kTaskEvent, topic, message);
      if (!once && event) event->goal_id = *goal;
      return true;
    };
  }
  if (is("ignores_authority")) authority([](msg::Authority& a) { return a.level != msg::kAuthorityOperator; });
  if (is("never_returns"))
    authority([taken = false](msg::Authority& a) mutable {
      taken = taken || a.level == msg::kAuthorityOperator;
      if (taken) a.level = msg::kAuthorityOperator;
      return true;
    });
  if (is("ignores_stop")) authority([](msg::Authority& a) { return !a.emergency_stop; });
  if (is("tracks_all"))
    fault.reads = changing(topics::kObjectPercepts, [](msg::ObjectPercepts& read) {
      for (int i = 0; i < read.blob_count; ++i) read.blobs[i].colour = msg::kColourGreen;
    });
  if (is("blind"))
    fault.reads = changing(topics::kObjectPercepts, [](msg::ObjectPercepts& read) { read.blob_count = 0; });
  if (is("leaves_pregrasp_out"))
    request([](msg::Request& r) {
      if (r.task == msg::kTaskPregrasp) r.task = msg::kTaskGrasp;
    });
  if (is("ignores_pregrasp_lost")) deaf_to(msg::kTaskPregrasp, msg::kEventObjectPregraspLost);
  if (is("ignores_pregrasped")) deaf_to(msg::kTaskPregrasp, msg::kEventObjectPregrasped);
  if (is("wrong_handle"))
    request([](msg::Request& r) {
      if (r.parameters.object_handle > 0) r.parameters.object_handle = 10;
    });
  if (is("ignores_grasped")) deaf_to(msg::kTaskGrasp, msg::kEventObjectGrasped);
  if (is("wrong_zone"))
    request([](msg::Request& r) {
      if (r.parameters.drop_zone_colour) r.parameters.drop_zone_colour = msg::kColourYellow;
    });
  if (is("counts_nothing")) mission([](msg::MissionStatus& m) { m.delivered_count = 0; });
  if (is("only_green"))
    request([](msg::Request& r) {
      if (r.parameters.object_colour) r.parameters.object_colour = msg::kColourGreen;
    });
  if (is("never_ends")) mission([](msg::MissionStatus& m) { m.outcome = msg::kMissionRunning; });
  if (is("commands_as_operator")) request([](msg::Request& r) { r.level = msg::kAuthorityOperator; });
  if (is("turns_nowhere"))
    request([](msg::Request& r) {
      if (r.task == msg::kTaskRotate) r.parameters.direction = msg::kDirectionNone;
    });
  if (is("forgets_recoveries"))
    mission([n = 0](msg::MissionStatus& m) mutable {
      if (++n % 100 == 0) m.recoveries = 0;
    });
  if (is("remembers"))
    mission([memory](msg::MissionStatus& m) {
      *memory = std::max<std::uint64_t>(*memory, m.delivered_count);
      m.delivered_count = static_cast<std::uint16_t>(*memory);
    });
  if (is("forgets")) fault.forgets = true;
  if (is("random"))
    request([other = ++*memory % 2 == 0](msg::Request& r) {
      if (!other || r.task != msg::kTaskExplore) return;
      r.task = msg::kTaskRotate;
      r.parameters.direction = msg::kDirectionLeft;
    });
  return fault;
}

inline ComponentFactory faulty_planner(const std::string& name) {
  auto memory = std::make_shared<std::uint64_t>(0);
  return faulty(make_planner_factory(), [name, memory] { return planner_fault(name, memory); });
}

}  // namespace constrictor::testing
