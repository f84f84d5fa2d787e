// The mission planner: the state machine of the paper's Section IV and Fig. 3, with recoveries, for any sequence of
// colours. It computes task requests from percepts, events, pose and map estimates, and knows no coordinate of any
// scenario. It contains no DDS code.
#pragma once

#include <cereal/types/string.hpp>
#include <cereal/types/vector.hpp>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "constrictor/messages.hpp"
#include "planner/attempts.hpp"
#include "planner/delivery.hpp"
#include "planner/line_trail.hpp"
#include "planner/mission_state.hpp"
#include "planner/planner_config.hpp"
#include "planner/refusals.hpp"
#include "planner/standstill.hpp"
#include "planner/sweep.hpp"

namespace constrictor {

/// The inputs of one step. A pointer is null until its first message has arrived.
struct PlannerInputs {
  double time_s = 0.0;                     ///< simulated or robot time
  std::int64_t tick = 0;                   ///< of this step; images and landmarks name ticks, too
  const msg::LinePercept* line = nullptr;  ///< newest
  const msg::ObjectPercepts* objects = nullptr;
  bool new_percepts = false;  ///< `line` and `objects` come from a new image
  const msg::RobotPose* pose = nullptr;
  const msg::FieldMap* map = nullptr;
  const msg::TaskStatus* status = nullptr;
  const msg::Authority* authority = nullptr;
  std::vector<const msg::TaskEvent*> events;  ///< since the previous step, oldest first
};

/// The task that the planner requests, or cancels after the mission has failed.
struct WantedTask {
  std::uint64_t goal_id = 0;  ///< the planner's own number; `input` maps it
  std::uint8_t command = msg::kCommandStart;
  std::uint8_t task = msg::kTaskNone;
  msg::TaskParameters parameters{};
};

/// An object that was seen on its zone. The robot may push it off again.
struct PlacedObject {
  std::uint16_t index = 0;          ///< in the sequence
  std::uint16_t handle = 0;         ///< of its landmark; 0: unknown
  std::uint16_t newest_handle = 0;  ///< highest handle of the map when it was delivered
  std::int64_t tick = 0;            ///< at which it was delivered
  double outside_s = 0.0;           ///< time for which the map has shown it outside its zone
  bool touched = false;             ///< the body has touched it since then, and may have pushed it
  template <class Archive>
  void serialize(Archive& archive) {
    archive(index, handle, newest_handle, tick, outside_s, touched);
  }
};

using PlacedObjects = std::vector<PlacedObject>;

/// The whole state of the planner.
struct MissionMemory {
  MissionState state = MissionState::kSearchLineOrObject;
  bool requested = false;        ///< the task of the state was requested
  bool direction_known = false;  ///< an object was found, so the directions of the trail are right
  bool suspended = false;        ///< another source has authority, or an emergency stop is latched
  bool stopped = false;          ///< from an emergency stop until an operator or external planner releases authority
  double last_s = 0.0;           ///< time of the previous step
  double active_s = 0.0;         ///< mission time, without suspensions
  double entered_s = 0.0;        ///< active time at which the state began
  double requested_s = 0.0;      ///< active time of the request
  double contradiction_s = 0.0;  ///< time for which navigation's report about a held object has contradicted the state
  double line_ended_s = -1e9;    ///< active time of the last end of the line
  double turned_back_s = -1e9;   ///< active time at which turning back to the line last ended without success
  double zone_seen_s = -1e9;     ///< active time at which a zone of any colour was last seen
  std::uint64_t goals = 0;       ///< number of requests so far
  std::uint16_t object_index = 0;    ///< the first object of the sequence that is neither delivered nor put aside
  std::uint32_t delivered = 0;       ///< bit i: object i of the sequence was seen on its zone, or dropped by others
  std::uint32_t aside = 0;           ///< bit i: object i was put aside after too many failures
  bool second_pass = false;          ///< the objects that were put aside are tried once more
  std::vector<Attempts> attempts;    ///< by place in the sequence; later entries are missing until they are needed
  bool dropped = false;              ///< the planner's drop is done, and its result is not yet decided
  std::uint16_t dropped_handle = 0;  ///< of the dropped object; 0: unknown
  std::uint16_t newest_handle = 0;   ///< highest handle of the map at the release
  PlacedObjects placed;              ///< the delivered objects
  std::uint32_t rechecked = 0;       ///< bit i: the robot has looked at object i again since the newest drop
  std::uint32_t displaced = 0;       ///< bit i: object i was delivered, and was then pushed off its zone
  std::int64_t released_tick = -1;   ///< last tick in which the body held or left the object last dropped; -1: none
  std::uint16_t recoveries = 0;
  std::uint16_t object_handle = 0;  ///< handle of the object that was reached or pregrasped; 0: unknown
  std::uint16_t object_images = 0;  ///< consecutive images with the wanted object
  std::uint16_t zone_images = 0;
  std::uint16_t line_images = 0;
  std::uint16_t searches = 0;                    ///< requests of the present search so far; selects the next move
  double searched_s = 0.0;                       ///< time of the newest one
  std::uint8_t search_task = msg::kTaskNone;     ///< task of the present search: explore or rotate
  Standstill standstill;                         ///< of a search or transport with an object
  Sweep sweep;                                   ///< of a search with an object that nothing remembered leads
  std::uint8_t vain_looks = 0;                   ///< looks at the dropped object after which the map did not have it
  bool steps_back = false;                       ///< the robot moves away from the dropped object to see it
  std::uint8_t backed_off = 0;                   ///< moves of this search that backed off from obstacles
  bool wrong_way = false;                        ///< the robot follows the line the wrong way, and will turn round
  bool search_by_memory = false;                 ///< its direction comes from the memory of line, object or zone
  std::uint8_t direction = msg::kDirectionNone;  ///< of the last requested rotate or explore
  LineTrail trail;
  std::string reason;                  ///< why the mission failed
  std::string hindrance;               ///< the hindrance of the mission, as a predicate; empty: none
  double suspended_s = 0.0;            ///< duration of the present suspension
  double unseen_s = 0.0;               ///< time without percepts
  bool blind = false;                  ///< the mission waits for percepts
  std::uint64_t refused_sequence = 0;  ///< number of the planner's last request that `input` has refused
  RefusalMemory refusals;

  template <class Archive>
  void serialize(Archive& archive) {
    archive(state, requested, direction_known, suspended, stopped, last_s, active_s, entered_s, requested_s,
            contradiction_s, line_ended_s, zone_seen_s, goals, object_index, delivered, recoveries, object_handle,
            object_images, zone_images, line_images, searches, searched_s, search_task, search_by_memory, direction,
            trail, reason, standstill, sweep, vain_looks, steps_back, backed_off, aside, second_pass, attempts, dropped,
            dropped_handle, newest_handle, released_tick, placed, displaced, hindrance, suspended_s, unseen_s, blind,
            refused_sequence, refusals, wrong_way, rechecked, turned_back_s);
  }
};

/// [s] for which navigation may still report an older goal, or contradict the state about a held object.
inline constexpr double kMissionPatience_s = 2.0;

class MissionPlanner {
 public:
  MissionPlanner(const PlannerConfig& config, MissionMemory& memory) : config_(config), memory_(memory) {}

  /// Advances the state machine. Returns the request of this step, if there is one.
  std::optional<WantedTask> step(const PlannerInputs& inputs);
  /// Colour of the object that is being retrieved; of the last object when all are delivered; unknown in a mission
  /// without objects.
  [[nodiscard]] std::uint8_t colour() const;

 private:
  // Supervision.
  [[nodiscard]] bool may_command(const PlannerInputs& inputs, double elapsed_s);
  void resume(const PlannerInputs& inputs);
  /// Whether the robot must stand still because no percepts have arrived for a while. Fails the mission if that lasts.
  [[nodiscard]] bool waits_for_percepts(const PlannerInputs& inputs);
  [[nodiscard]] WantedTask cancellation() const;
  // The next state, by cause; empty: the state stays.
  [[nodiscard]] std::optional<MissionState> next(const PlannerInputs& inputs);
  [[nodiscard]] std::optional<MissionState> next_by_event(const msg::TaskEvent& event, const PlannerInputs& inputs);
  /// `reason`: why the goal ended, in words; it may be empty.
  [[nodiscard]] std::optional<MissionState> next_by_goal_state(std::uint8_t goal_state, const std::string& reason,
                                                               const PlannerInputs& inputs);
  [[nodiscard]] std::optional<MissionState> next_by_status(const PlannerInputs& inputs);
  [[nodiscard]] std::optional<MissionState> next_by_percepts(const PlannerInputs& inputs);
  /// The state after a search without an object that sees the line; empty: it must go on.
  [[nodiscard]] std::optional<MissionState> follow_found_line(const PlannerInputs& inputs);
  [[nodiscard]] std::optional<MissionState> next_by_time(const PlannerInputs& inputs);
  [[nodiscard]] std::optional<MissionState> end_of_line(const PlannerInputs& inputs);
  /// The same where zones may be anywhere: the robot goes on with the other direction. Without an object it first looks
  /// for one here.
  [[nodiscard]] MissionState end_of_explored_line();
  /// The state after the drop: the next object if the map shows the dropped object on its zone, another attempt if the
  /// map shows it elsewhere, otherwise a look at it.
  [[nodiscard]] MissionState after_drop(const PlannerInputs& inputs);
  /// The state after this look: if the verdict is still uncertain, the likelier case counts; an object that was not
  /// seen is searched for. `in_view`: the look has ended because the object stayed in view. All places of the map are
  /// then as good as the robot's own, even if that is uncertain.
  [[nodiscard]] MissionState after_inspection(bool in_view, const PlannerInputs& inputs);
  [[nodiscard]] MissionState delivered(const PlannerInputs& inputs);
  /// Counts a delivered object as undelivered again when the map has shown it outside its zone for a while.
  void watch_placed_objects(const PlannerInputs& inputs, double elapsed_s);
  /// The verdict on a delivered object as the map shows it now; kUnseen if no image has shown it since.
  /// While the map has the object at its zone, an unknown one of its colour counts only if it is near that zone, or at
  /// `any_distance`.
  [[nodiscard]] DeliveryView placed_object(const PlacedObject& object, const PlannerInputs& inputs,
                                           bool any_distance = false) const;
  /// Before the mission ends: selects a delivered object for another look if the map is not certain that it is still on
  /// its zone, because the robot has touched it since it was seen. Each object is looked at once after a drop;
  /// `except`, which was delivered just now, is not. Nor is an object without a handle whose colour another object of
  /// the mission has. False if there is no such object.
  [[nodiscard]] bool inspect_doubtful(const PlannerInputs& inputs, std::uint16_t except);
  /// Whether the look must be at the landmark of the object in question: it was delivered before, and the map has it.
  [[nodiscard]] bool inspects_by_handle(const PlannerInputs& inputs) const;
  /// Counts a delivered object as undelivered again.
  void take_back(PlacedObjects::iterator gone);
  /// Whether all objects but the present one are delivered; false in a mission with one object.
  [[nodiscard]] bool at_last_object() const;
  /// Handles of the delivered objects of the same colour as object `index` of the sequence, except its own. The map
  /// tells objects of one colour apart by their places.
  [[nodiscard]] std::vector<std::uint16_t> twins(std::uint16_t index) const;
  /// Whether another object of the present object's colour is delivered.
  [[nodiscard]] bool has_delivered_twin() const;
  [[nodiscard]] DeliveryView dropped_object(const PlannerInputs& inputs) const;
  /// Notes the end of the planner's own drop, and counts the objects that an operator or external planner dropped as
  /// delivered unless the map shows them outside their zone.
  void note_drops(const PlannerInputs& inputs);
  /// Selects the next object. False if none is left.
  bool choose_object();
  /// The state at the end of the sequence: failed if an object was put aside and not delivered later.
  [[nodiscard]] MissionState end_of_sequence();
  /// Counts a failure with the present object. Returns the state of the next attempt, which differs from all earlier
  /// ones, or puts the object aside and returns the state in which the next one is looked for. `why`: for people.
  [[nodiscard]] MissionState try_differently(const std::string& why);
  /// The same for an object that a search has not found. With others to retrieve it is put aside at once.
  [[nodiscard]] MissionState search_elsewhere(const std::string& why);
  /// Counts a failure in `state`. Whether the object is tried again before it is put aside.
  [[nodiscard]] bool may_try_again(Attempts& tried, const char* state, const std::string& why) const;
  /// Puts the present object aside. Returns the state in which the next one is looked for.
  [[nodiscard]] MissionState put_aside();
  /// Counts a recovery and returns `to`, another attempt, or kFailed after too many. `why`: the reason, for people.
  [[nodiscard]] MissionState recover(MissionState to, const std::string& why = "the object was lost");
  /// The attempts with the present object.
  [[nodiscard]] Attempts& attempts() { return attempts(memory_.object_index); }
  [[nodiscard]] Attempts& attempts(std::size_t object);
  [[nodiscard]] MissionState fail(const std::string& reason);
  void enter(MissionState state);
  // Refused requests.
  [[nodiscard]] Refusals refusals() const { return {config_, memory_.refusals}; }
  /// Task of the last request.
  [[nodiscard]] std::uint8_t requested_task() const;
  /// Whether navigation has refused this task a short time ago, so that the state must not begin yet.
  [[nodiscard]] bool barred(MissionState state) const;
  /// The state after navigation's refusal: the same one if the refusal passes by itself, otherwise the state that
  /// follows a failure. It does not count as a recovery.
  [[nodiscard]] MissionState refused(const std::string& reason, const PlannerInputs& inputs);
  /// The same state if `input` has refused the request, or navigation has not answered it for a while.
  [[nodiscard]] std::optional<MissionState> next_without_answer(const PlannerInputs& inputs);
  /// The hindrance of the mission, as a predicate: a source that has authority, a latched stop, or a refusal.
  [[nodiscard]] std::string hindrance(const PlannerInputs& inputs) const;
  // Percepts.
  void count_percepts(const PlannerInputs& inputs);
  /// Whether entry `i` of the sequence is delivered.
  [[nodiscard]] bool done(std::size_t i) const { return (memory_.delivered >> i & 1u) != 0; }
  /// Whether a blob that looks like a zone may be the zone of its colour: it is near the one of the map, if there is
  /// one.
  [[nodiscard]] bool is_zone(const msg::Blob& blob, const PlannerInputs& inputs) const;
  [[nodiscard]] bool is_delivered(const msg::Blob& blob, const PlannerInputs& inputs) const;
  /// The same for an object of this colour at a place in M.
  [[nodiscard]] bool is_delivered(std::uint8_t colour, double x_m, double y_m, const PlannerInputs& inputs) const;
  /// Whether this landmark is a delivered object.
  [[nodiscard]] bool is_placed(const msg::MapObject& landmark, const PlannerInputs& inputs) const;
  /// The nearest landmark of the zone for a robot with an object, otherwise of the object, that is not delivered yet;
  /// null: the map has none.
  [[nodiscard]] const msg::MapObject* wanted_landmark(const PlannerInputs& inputs) const;
  /// Whether the robot faces the direction along the line that the state wants. True if the direction is unknown.
  [[nodiscard]] bool leads_wanted_way(const PlannerInputs& inputs) const;
  /// Whether the visible line leads a robot without an object over new ground.
  [[nodiscard]] bool leads_to_new_ground(const PlannerInputs& inputs) const;
  /// [rad] heading in M in which the robot moves: of the body without an object, of the head with an object in the U.
  [[nodiscard]] double course_rad(const msg::RobotPose& pose) const {
    return holding() ? pose.yaw_rad : pose.body_yaw_rad;
  }
  /// [m] from the head to wanted_landmark(); infinite if the map has none.
  [[nodiscard]] double remembered_m(const PlannerInputs& inputs) const;
  /// [rad] turn, positive left, after which the course leads to the remembered object or zone, or along the line in the
  /// wanted direction; empty: none of them is remembered.
  [[nodiscard]] std::optional<double> wanted_turn_rad(const PlannerInputs& inputs) const;
  /// Whether a turn may end: the course has the wanted direction, or has passed it.
  [[nodiscard]] bool has_turned(const PlannerInputs& inputs) const;
  /// Whether the robot may follow the visible line from here: its course leads along the line in the wanted direction.
  /// Where the line is known already, a body without an object must also be straight enough.
  [[nodiscard]] bool may_follow(const PlannerInputs& inputs) const;
  // Requests.
  [[nodiscard]] WantedTask task_of_state(const PlannerInputs& inputs);
  /// The move of a search that turns the course by `turn_rad`.
  [[nodiscard]] Move move_for(double turn_rad, const PlannerInputs& inputs) const;
  /// The side for a turn by `turn_rad`: the shorter way. For a turn of nearly half a circle beside a drop zone: away
  /// from the zone, so that the turning body does not hit an object there.
  [[nodiscard]] std::uint8_t side_for(double turn_rad, const PlannerInputs& inputs) const;
  void choose_search(const PlannerInputs& inputs, WantedTask& wanted);
  /// Whether nothing stands in the way of a robot that drives straight on with an object: neither an obstacle of the
  /// map nor an object that its U would take along.
  [[nodiscard]] bool ahead_free(const PlannerInputs& inputs) const;
  /// Whether an obstacle of the map is so near to the arms of the U that the robot must back off first, and no line is
  /// in view that would lead it on.
  [[nodiscard]] bool caught(const PlannerInputs& inputs) const;
  /// Whether no obstacle of the map stands in the straight way of the held object to its zone. True if the map does not
  /// have them.
  [[nodiscard]] bool zone_in_reach(const PlannerInputs& inputs) const;
  /// Whether a robot that should move has stayed at one place for a while.
  [[nodiscard]] bool stands_still(const PlannerInputs& inputs);
  /// Chooses the place to search at next, for a robot with an object that knows no line.
  void lead_sweep(const PlannerInputs& inputs);
  [[nodiscard]] bool sweeps() const { return holding() && searches() && memory_.trail.empty(); }
  [[nodiscard]] bool searches() const { return row_of(memory_.state).task == msg::kTaskNone; }
  [[nodiscard]] bool holding() const { return row_of(memory_.state).holding; }
  /// Whether the state wants to follow the line outbound. Where zones may be anywhere, this is the direction that is
  /// being explored, with an object or without one; the trail is reversed at each end of the line.
  [[nodiscard]] bool outbound() const { return !holding() || config_.zones_at == kZonesAnywhere; }
  /// Where zones may be anywhere: reverses the trail if what the robot wants next, according to the map, lies the other
  /// way along the line.
  void aim(const PlannerInputs& inputs);
  /// A duration given for the robot without an object; with an object in the U everything takes longer.
  [[nodiscard]] double scaled_s(double empty_s) const { return holding() ? empty_s * config_.holding_factor : empty_s; }

  const PlannerConfig& config_;
  MissionMemory& memory_;
};

}  // namespace constrictor
