// The autonomous planner: the state machine of the paper's Section IV and Fig. 3 with its recoveries, for any sequence of
// colours. Pure: percepts, events, pose and map estimates in, task requests out. It knows no coordinate of any scenario.
#pragma once

#include <cereal/types/string.hpp>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "constrictor/messages.hpp"
#include "planner/line_trail.hpp"
#include "planner/mission_state.hpp"
#include "planner/planner_config.hpp"

namespace constrictor {

/// What the planner sees in one step. Pointers are null where nothing has arrived yet.
struct PlannerInputs {
  double time_s = 0.0;                         ///< simulated or robot time
  const msg::LinePercept* line = nullptr;      ///< newest
  const msg::ObjectPercepts* objects = nullptr;
  bool fresh_percepts = false;                 ///< `line` and `objects` are of a new image
  const msg::RobotPose* pose = nullptr;
  const msg::FieldMap* map = nullptr;
  const msg::TaskStatus* status = nullptr;
  const msg::Authority* authority = nullptr;
  std::vector<const msg::TaskEvent*> events;   ///< since the last step, in order
};

/// A task the planner wants started or, if the mission failed, cancelled.
struct WantedTask {
  std::uint64_t goal_id = 0;                   ///< the planner's own; `input` maps it
  std::uint8_t command = msg::kCommandStart;
  std::uint8_t task = msg::kTaskNone;
  msg::TaskParameters parameters{};
};

/// A search's move.
struct Move {
  std::uint8_t task = msg::kTaskNone;            ///< kTaskRotate or kTaskExplore
  std::uint8_t direction = msg::kDirectionNone;
};

/// Everything the planner remembers.
struct MissionMemory {
  MissionState state = MissionState::kSearchLineOrObject;
  bool asked = false;               ///< the state's task was requested
  bool way_known = false;           ///< along the line objects were found, so its trail leads the right way
  bool suspended = false;           ///< somebody else has authority
  bool stopped = false;             ///< after an emergency stop, until an operator or external planner hands over
  double last_s = 0.0;              ///< time of the previous step
  double active_s = 0.0;            ///< mission time, without suspensions
  double entered_s = 0.0;           ///< active time at which the state began
  double asked_s = 0.0;             ///< active time of the request
  double unlike_s = 0.0;            ///< for which navigation's word on what is held contradicts the state
  double line_ended_s = -1e9;       ///< active time of the last end of the line
  double zone_seen_s = -1e9;        ///< active time at which a zone of any colour was seen last
  std::uint64_t goals = 0;          ///< requests made
  std::uint16_t object_index = 0;   ///< of the sequence: the first that is not delivered
  std::uint32_t delivered = 0;      ///< bit i: object i of the sequence is on its zone, whoever brought it there
  std::uint16_t recoveries = 0;
  std::uint16_t object_handle = 0;  ///< of the object in front of the robot or beside it, as navigation named it; 0: none is known
  std::uint16_t object_images = 0;  ///< consecutive images that show the wanted object
  std::uint16_t zone_images = 0;
  std::uint16_t line_images = 0;
  std::uint16_t searches = 0;       ///< requests of the two searches so far: alternates what is tried
  std::uint8_t searching = msg::kTaskNone;  ///< what the present search does: explore or rotate
  bool guided = false;              ///< it does so by memory
  std::uint8_t direction = msg::kDirectionNone;  ///< of the last rotate or explore asked for
  LineTrail trail;
  std::string reason;               ///< why the mission failed

  template <class Archive>
  void serialize(Archive& archive) {
    archive(state, asked, way_known, suspended, stopped, last_s, active_s, entered_s, asked_s, unlike_s, line_ended_s, zone_seen_s,
            goals, object_index, delivered, recoveries, object_handle, object_images, zone_images, line_images, searches, searching, guided, direction,
            trail, reason);
  }
};

class MissionPlanner {
 public:
  MissionPlanner(const PlannerConfig& config, MissionMemory& memory) : config_(config), memory_(memory) {}

  /// Advances the state machine; returns the request to make, if any.
  std::optional<WantedTask> step(const PlannerInputs& inputs);
  /// Colour of the object being retrieved (of the last one when all are done).
  [[nodiscard]] std::uint8_t colour() const;

 private:
  // supervision
  [[nodiscard]] bool may_command(const PlannerInputs& inputs);
  void resume(const PlannerInputs& inputs);
  // what follows, by cause; empty: nothing does
  [[nodiscard]] std::optional<MissionState> next(const PlannerInputs& inputs);
  [[nodiscard]] std::optional<MissionState> next_by_event(const msg::TaskEvent& event, const PlannerInputs& inputs);
  [[nodiscard]] std::optional<MissionState> next_by_goal_state(std::uint8_t goal_state);
  [[nodiscard]] std::optional<MissionState> next_by_status(const PlannerInputs& inputs);
  [[nodiscard]] std::optional<MissionState> next_by_percepts(const PlannerInputs& inputs);
  [[nodiscard]] std::optional<MissionState> next_by_time(const PlannerInputs& inputs);
  [[nodiscard]] std::optional<MissionState> end_of_line(const PlannerInputs& inputs);
  [[nodiscard]] MissionState delivered();
  /// What was dropped need not be fetched any more: by an operator, by an external planner, or by its own last task while somebody
  /// took over.
  void note_deliveries(const PlannerInputs& inputs);
  void skip_delivered();
  /// Counts a recovery: `to`, or failure if there were too many.
  [[nodiscard]] MissionState recover(MissionState to);
  [[nodiscard]] MissionState fail(const std::string& reason);
  void enter(MissionState state);
  // percepts
  void count_percepts(const PlannerInputs& inputs);
  [[nodiscard]] bool is_delivered(const msg::Blob& blob, const PlannerInputs& inputs) const;
  /// Whether the line leads the way the state wants: by the trail, if there is one.
  [[nodiscard]] bool leads_right(const PlannerInputs& inputs) const;
  /// Whether the line in view leads the empty robot on to where it has not been.
  [[nodiscard]] bool leads_on(const PlannerInputs& inputs) const;
  /// [rad] heading in M in which the robot moves: of the straightened body, with an object in the U of the head.
  [[nodiscard]] double course_rad(const msg::RobotPose& pose) const { return holding() ? pose.yaw_rad : pose.body_yaw_rad; }
  /// [rad] by which the course would have to turn left to lead to what is searched for, or back to the line and along it the
  /// wanted way, by memory; empty: nothing is remembered.
  [[nodiscard]] std::optional<double> to_turn_rad(const PlannerInputs& inputs) const;
  /// Whether a turn may end: the course leads where it shall, or has gone past that.
  [[nodiscard]] bool has_turned(const PlannerInputs& inputs) const;
  /// Whether the line in view may be followed from here: the robot's course leads the right way along it, and an empty body is not
  /// curled up.
  [[nodiscard]] bool may_follow(const PlannerInputs& inputs) const;
  // requests
  [[nodiscard]] WantedTask task_of_state(const PlannerInputs& inputs);
  /// What the search does next by memory: the task and its direction.
  [[nodiscard]] Move move_for(double turn_rad, const PlannerInputs& inputs) const;
  /// The side to which to turn by so much: the shorter way, or if there is little between them the one away from a drop zone, so that
  /// the turning body leaves alone what stands there.
  [[nodiscard]] std::uint8_t side_for(double turn_rad, const PlannerInputs& inputs) const;
  void choose_search(const PlannerInputs& inputs, WantedTask& wanted);
  [[nodiscard]] bool searches() const { return row_of(memory_.state).task == msg::kTaskNone; }
  [[nodiscard]] bool holding() const { return row_of(memory_.state).holding; }
  /// A duration given for the empty robot; with an object in the U everything takes longer.
  [[nodiscard]] double scaled_s(double empty_s) const { return holding() ? empty_s * config_.holding_factor : empty_s; }

  const PlannerConfig& config_;
  MissionMemory& memory_;
};

}  // namespace constrictor
