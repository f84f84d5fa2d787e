// The interface of the paper's tasks (Section III-A, Tables I to XV).
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <memory>
#include <string>
#include <vector>

#include "component/component.hpp"
#include "component/stateful.hpp"
#include "navigation/grip.hpp"
#include "navigation/line_tracker.hpp"
#include "navigation/navigation_config.hpp"
#include "navigation/object_tracker.hpp"
#include "navigation/planar_body.hpp"

namespace constrictor {

/// The input of a task at each step.
struct TaskInput {
  const Tick& tick;
  const RobotModel& robot;
  const NavigationConfig& config;
  const GripSense& grip_sense;
  msg::TaskParameters parameters;       ///< of the goal
  PlanarPose X_MH;                      ///< the head in the map
  const msg::LinePercept* line;         ///< null if no line percept arrived since the previous step
  bool new_percepts;                    ///< object percepts arrived since the previous step
  const ObjectTrackerState& sightings;  ///< the objects and zones seen so far, by colour
  const msg::FieldMap* map;             ///< null until guidance has written the first map
  const msg::JointState& joints;
  const std::vector<PlanarPose>& body;  ///< modules in the head's frame, head first
  const std::vector<Touch>& touches;    ///< contacts from the side, without the ground's and the robot's own
  bool feels;                           ///< the robot has contact sensors; otherwise there are never any touches
  bool motion_done;                     ///< control has finished the newest motion
  double sway_period_s;                 ///< in which the gait lets the head sway once
  const msg::Path* path = nullptr;      ///< of the command; only in refusal() and start()
  double run_s = 0.0;                   ///< of the goal, with this step; waiting for percepts does not count
};

/// [s] time limit of a goal; infinite if it has none.
[[nodiscard]] inline double time_limit_s(const msg::TaskParameters& parameters) {
  return parameters.timeout_s > 0.0 ? parameters.timeout_s : std::numeric_limits<double>::infinity();
}

/// An event of the tables, with the object, zone or line that it is about.
struct EventRecord {
  std::uint8_t event = msg::kEventNone;
  std::uint8_t colour = msg::kColourUnknown;
  std::uint16_t handle = 0;  ///< in guidance's map; 0: the event is not about an object, or the map does not have it
};

/// The result of a step of a task.
struct TaskOutput {
  msg::DesiredTrajectory desired{};  ///< the caller fills in motion_id
  bool new_motion = false;           ///< the motion starts again, although it is of the same kind as before
  std::vector<EventRecord> events;
  std::uint8_t state = msg::kGoalRunning;        ///< kGoalSucceeded and kGoalAborted end the goal with this step
  std::string reason;                            ///< why the goal was aborted
  double progress = 0.0;                         ///< 0 to 1
  std::uint8_t direction = msg::kDirectionNone;  ///< the task has chosen this direction, which its goal left open
  const char* phase = "";                        ///< name of the present part of the task, for people
  double cross_track_m = std::numeric_limits<double>::quiet_NaN();  ///< [m] head from the path; NaN: no path

  void emit(std::uint8_t event, std::uint8_t colour = msg::kColourUnknown, std::uint16_t handle = 0) {
    events.push_back({event, colour, handle});
  }
  void succeed() {
    state = msg::kGoalSucceeded;
    progress = 1.0;
  }
  void abort(std::string why) {
    state = msg::kGoalAborted;
    reason = std::move(why);
  }
};

/// One of the tasks. It is made for a goal and stepped at every tick until the goal ends.
class Task {
 public:
  virtual ~Task() = default;
  /// Why the robot cannot do this goal now; empty: it can. The parameters are complete (task_parameter_refusal). Called
  /// before start(), and changes nothing.
  [[nodiscard]] virtual std::string refusal(const TaskInput& input, const Grip& grip) const {
    static_cast<void>(input);
    static_cast<void>(grip);
    return {};
  }
  /// Whether the task must not move while the camera, or perception, is silent.
  [[nodiscard]] virtual bool steers_by_sight() const { return true; }
  /// Whether the task itself reacts to the time limit of its goal. Every other task is aborted when it passes.
  [[nodiscard]] virtual bool keeps_time() const { return false; }
  virtual void start(const TaskInput& input, Grip& grip) = 0;
  virtual void step(const TaskInput& input, Grip& grip, TaskOutput& output) = 0;
  [[nodiscard]] virtual std::string save() const = 0;
  virtual void load(const std::string& bytes) = 0;
};

/// A task whose whole state is one serialisable struct.
template <class State>
using StatefulTask = Stateful<Task, State>;

/// Which part of its work a task with several phases does, and since when. The first phase is 0.
struct PhaseState {
  int phase = 0;
  double phase_s = 0.0;

  void enter(int next) {
    phase = next;
    phase_s = 0.0;
  }
};

/// Calls the member function of `task` that does the present phase of its work. `parts`: one function for each phase,
/// in the order of the phases. An unknown phase (a damaged checkpoint) counts as the last one.
template <class PhasedTask, std::size_t kCount>
void run_phase(PhasedTask& task,
               const std::array<void (PhasedTask::*)(const TaskInput&, Grip&, TaskOutput&), kCount>& parts, int phase,
               const TaskInput& input, Grip& grip, TaskOutput& output) {
  (task.*parts[std::min(static_cast<std::size_t>(phase), kCount - 1)])(input, grip, output);
}

/// A new task of the kind kTask…; null for kTaskNone and unknown numbers. The kinds are registered in
/// task_registry.cpp.
std::unique_ptr<Task> make_task(std::uint8_t task);

}  // namespace constrictor
