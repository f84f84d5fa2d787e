// The mission planner: the state machine of the paper's Section IV and Fig. 3, with recoveries, for any sequence of
// colours. It computes task requests from percepts, events, pose and map estimates, and knows no coordinate of any
// scenario. It contains no DDS code.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "constrictor/messages.hpp"
#include "planner/delivery.hpp"
#include "planner/mission_memory.hpp"
#include "planner/planner_config.hpp"
#include "planner/refusals.hpp"

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
  /// Selects for a look an object that another source has dropped, and that the planner has not looked at yet. False if
  /// there is none.
  [[nodiscard]] bool inspect_unseen();
  /// Makes a delivered object the present one, whose drop is not judged yet. Images from `since_tick` on count.
  void look_at(PlacedObjects::iterator object, std::int64_t since_tick);
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
  /// Notes the end of the planner's own drop, and the objects that an operator or external planner has dropped: each
  /// counts as delivered until the planner can look at it.
  void note_drops(const PlannerInputs& inputs);
  void note_drop_by_others(const msg::TaskEvent& event, const PlannerInputs& inputs);
  /// Selects the next object. False if none is left.
  bool choose_object();
  /// The state at the end of the sequence: failed if an object was put aside and not delivered later.
  [[nodiscard]] MissionState end_of_sequence();
  /// The objects that are not delivered, and why, for people; empty: all are.
  [[nodiscard]] std::string not_delivered() const;
  /// Counts a failure with the present object. Returns the state of the next attempt, which differs from all earlier
  /// ones, or puts the object aside and returns the state in which the next one is looked for. `why`: for people.
  [[nodiscard]] MissionState try_differently(const std::string& why);
  /// The same for an object that a search has not found. With others to retrieve it is put aside at once.
  [[nodiscard]] MissionState search_elsewhere(const std::string& why);
  /// Counts a failure in `state`. Whether the object is tried again before it is put aside.
  [[nodiscard]] bool may_try_again(Attempts& tried, const char* state, const std::string& why) const;
  /// Puts the present object aside. Returns the state in which the next one is looked for.
  [[nodiscard]] MissionState put_aside();
  /// Counts a recovery and returns the next state: kFailed after too many recoveries; instead of kSearchObject, what
  /// try_differently() chooses; from kSearchObject to a search for the line, what search_elsewhere() chooses; otherwise
  /// `to`. `why`: the reason, for people.
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
  /// [m] in M: the place of wanted_landmark(); while the map lacks the zone, where images have lately shown it. Empty:
  /// neither is known.
  [[nodiscard]] std::optional<Eigen::Vector2d> wanted_place(const PlannerInputs& inputs) const;
  /// Remembers where images show the zone that the map does not have yet.
  void note_zone(const msg::Blob& zone, const PlannerInputs& inputs);
  /// Whether the robot faces the direction along the line that the state wants. True if the direction is unknown.
  [[nodiscard]] bool leads_wanted_way(const PlannerInputs& inputs) const;
  /// Whether the visible line leads a robot without an object over new ground.
  [[nodiscard]] bool leads_to_new_ground(const PlannerInputs& inputs) const;
  /// [rad] heading in M in which the robot moves: of the body without an object, of the head with an object in the U.
  [[nodiscard]] double course_rad(const msg::RobotPose& pose) const {
    return holding() ? pose.yaw_rad : pose.body_yaw_rad;
  }
  /// [m] from the head to wanted_place(); infinite if there is none.
  [[nodiscard]] double remembered_m(const PlannerInputs& inputs) const;
  /// [rad] by how much the robot must turn, positive left, until its course leads to the remembered object or zone, or,
  /// if the state wants the line, along the line in the wanted direction. Empty if what is wanted is not remembered.
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
  /// Whether enough images have shown the zone of the wanted colour, and the map knows it. Navigation refuses to drop
  /// an object on a zone that the map does not know yet.
  [[nodiscard]] bool zone_found(const PlannerInputs& inputs) const;
  /// Whether no obstacle of the map stands in the straight way of the held object to its zone. True if the map does not
  /// have them.
  [[nodiscard]] bool zone_in_reach(const PlannerInputs& inputs) const;
  /// Whether a robot that should move has stayed at one place for a while.
  [[nodiscard]] bool stands_still(const PlannerInputs& inputs);
  /// Chooses the place to search at next, for a robot with an object that knows no line.
  void lead_sweep(const PlannerInputs& inputs);
  [[nodiscard]] bool sweeps() const { return holding() && searches() && (memory_.trail.empty() || leaves_line()); }
  /// Whether turning back to the line with the object was in vain so often that the robot searches without the line.
  [[nodiscard]] bool leaves_line() const { return memory_.vain_turns >= 2; }
  /// [s] limit of a turn.
  [[nodiscard]] double longest_turn_s() const { return holding() ? config_.turn_back_s : config_.turn_round_s; }
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
