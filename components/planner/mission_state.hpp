// The states of Fig. 3 and how they follow one another, as a table.
#pragma once

#include <array>
#include <cstdint>

#include "constrictor/messages.hpp"

namespace constrictor {

/// States of the mission. The numbers are serialised and index the table.
enum class MissionState : std::uint8_t {
  kSearchLineOrObject,  ///< start and after a loss, empty: explore and turn until line or object is seen
  kFollowLine,          ///< towards the objects
  kSearchObject,        ///< look around for the object of the wanted colour
  kTrackObject,         ///< approach it
  kPregrasp,
  kGrasp,
  kSearchLine,          ///< holding the object: explore and turn until line or drop zone is seen
  kTransport,           ///< holding the object: follow the line until the drop zone is found
  kDrop,
  kTurnRound,           ///< empty, facing away from the objects: turn
  kTurnBack,            ///< holding the object, facing away from the drop zones: turn
  kDone,
  kFailed,
};
constexpr std::size_t kMissionStates = 13;

/// Where an event of navigation leads.
struct EventTransition {
  std::uint8_t event = msg::kEventNone;
  MissionState to = MissionState::kFailed;
};

/// One state: what it asks navigation for, and where it goes. Every way but `succeeded` counts as a recovery, except from the two
/// turns, whose end is normal.
struct StateRow {
  MissionState state;
  const char* name;        ///< for messages and reports
  std::uint8_t task;       ///< kTask…; kTaskNone: the searches for the line, which choose between explore and rotate
  bool holding;            ///< the body is believed to hold an object
  MissionState succeeded;  ///< the task's goal ended well
  MissionState failed;     ///< its goal was refused, aborted or cancelled, or the state's time is over
  std::array<EventTransition, 2> losses;  ///< events that end the state before its goal does
};

/// The row of a state.
const StateRow& row_of(MissionState state);
inline const char* name_of(MissionState state) { return row_of(state).name; }

}  // namespace constrictor
