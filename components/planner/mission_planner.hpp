// The autonomous planner: the state machine of the paper's Section IV and Fig. 3 with its recoveries, for any sequence of
// colours. Pure: percepts, events and the pose estimate in, task requests out. It knows no coordinate of any scenario.
#pragma once

#include <cereal/types/string.hpp>
#include <cereal/types/vector.hpp>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "constrictor/messages.hpp"
#include "planner/planner_config.hpp"

namespace constrictor {

/// States of Fig. 3. The numbers are serialised.
enum class MissionState : std::uint8_t {
  kSearchLineOrObject,  ///< start and after a loss: explore until line or object is seen
  kFollowLine,          ///< towards the objects
  kSearchObject,        ///< sweep for the object of the wanted colour
  kTrackObject,         ///< approach it
  kPregrasp,
  kGrasp,
  kSearchLine,          ///< holding the object: find the line again
  kTransport,           ///< follow the line until the drop zone is found
  kDrop,
  kTurnRound,           ///< empty again: turn back towards the objects
  kDone,
  kFailed,
};

/// Name for messages and reports, e.g. "follow line".
const char* name_of(MissionState state);

/// What the planner sees in one step. Pointers are null where nothing has arrived yet.
struct PlannerInputs {
  double time_s = 0.0;                         ///< simulated or robot time
  const msg::LinePercept* line = nullptr;      ///< newest
  const msg::ObjectPercepts* objects = nullptr;
  bool fresh_percepts = false;                 ///< `line` and `objects` are of a new image
  const msg::RobotPose* pose = nullptr;
  const msg::TaskStatus* status = nullptr;
  std::vector<const msg::TaskEvent*> events;   ///< since the last step, in order
};

/// A task the planner wants started.
struct WantedTask {
  std::uint64_t goal_id = 0;
  std::uint8_t task = msg::kTaskNone;
  msg::TaskParameters parameters{};
};

/// Everything the planner remembers.
struct MissionMemory {
  MissionState state = MissionState::kSearchLineOrObject;
  bool entered = false;             ///< the state's task was requested
  double entered_s = 0.0;
  std::uint64_t goals = 0;          ///< requests made
  std::uint16_t object_index = 0;   ///< of the sequence
  std::uint16_t recoveries = 0;
  std::uint16_t object_seen = 0;    ///< consecutive images
  std::uint16_t zone_seen = 0;
  std::uint16_t line_seen = 0;
  std::uint16_t searches = 0;       ///< search attempts in a row: alternates what is tried
  bool has_outbound_yaw = false;
  double outbound_yaw_rad = 0.0;    ///< heading in which the line was followed towards the objects
  std::string reason;               ///< why the mission failed

  template <class Archive>
  void serialize(Archive& archive) {
    archive(state, entered, entered_s, goals, object_index, recoveries, object_seen, zone_seen, line_seen, searches,
            has_outbound_yaw, outbound_yaw_rad, reason);
  }
};

class MissionPlanner {
 public:
  MissionPlanner(const PlannerConfig& config, MissionMemory& memory) : config_(config), memory_(memory) {}

  /// Advances the state machine; returns the task to start, if any.
  std::optional<WantedTask> step(const PlannerInputs& inputs);
  /// Colour of the object being retrieved.
  [[nodiscard]] std::uint8_t colour() const;

 private:
  [[nodiscard]] MissionState next(const PlannerInputs& inputs);
  [[nodiscard]] std::optional<MissionState> next_by_event(const msg::TaskEvent& event);
  [[nodiscard]] std::optional<MissionState> next_by_goal_end(const msg::TaskEvent& event);
  [[nodiscard]] std::optional<MissionState> next_by_percepts(const PlannerInputs& inputs);
  [[nodiscard]] std::optional<MissionState> next_by_time(const PlannerInputs& inputs);
  void count_percepts(const PlannerInputs& inputs);
  [[nodiscard]] MissionState recover(MissionState to);
  [[nodiscard]] WantedTask task_of_state(const PlannerInputs& inputs);
  void enter(MissionState state, double time_s);

  const PlannerConfig& config_;
  MissionMemory& memory_;
};

}  // namespace constrictor
