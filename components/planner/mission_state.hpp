// The states of Fig. 3 and their transitions, as a table.
#pragma once

#include <array>
#include <cstdint>

#include "constrictor/messages.hpp"

namespace constrictor {

/// States of the mission. Their numbers are serialised and index the table.
enum class MissionState : std::uint8_t {
  kSearchLineOrObject,  ///< without an object: explore and turn until the line or the object is seen
  kFollowLine,          ///< follow the line towards the objects
  kSearchObject,        ///< look for the object of the wanted colour
  kTrackObject,         ///< approach the object
  kPregrasp,
  kGrasp,
  kSearchLine,  ///< with the object: explore and turn until the line or the drop zone is seen
  kTransport,   ///< with the object: follow the line until the drop zone is found
  kDrop,
  kInspect,       ///< after the drop: look whether the object stands on its zone
  kApproachAnew,  ///< after several failures with an object: leave its neighbourhood before the next approach
  kTurnRound,     ///< without an object, facing away from the objects: turn
  kTurnBack,      ///< with the object, facing away from the drop zones: turn
  kDone,
  kFailed,
};
constexpr std::size_t kMissionStates = 15;

/// The state that follows an event of navigation.
struct EventTransition {
  std::uint8_t event = msg::kEventNone;
  MissionState to = MissionState::kFailed;
};

/// One state: its task and the states that follow it. Every transition except `succeeded` counts as a recovery; the two
/// turns end normally in both ways.
struct StateRow {
  MissionState state;
  const char* name;        ///< for messages and reports
  std::uint8_t task;       ///< kTask…; kTaskNone: a search, which chooses between explore and rotate
  bool holding;            ///< the body holds an object, as far as the planner knows
  MissionState succeeded;  ///< next state if the goal of the task succeeded
  MissionState failed;     ///< next state if the goal was refused, aborted or cancelled, or the state timed out
  std::array<EventTransition, 2> losses;  ///< events that end the state before its goal ends
};

/// The row of a state.
const StateRow& row_of(MissionState state);
inline const char* name_of(MissionState state) { return row_of(state).name; }

}  // namespace constrictor
