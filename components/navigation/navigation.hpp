// Navigation: the paper's task layer. It decides where, when and how the robot moves. One goal runs at a time.
#pragma once

#include <cereal/types/string.hpp>
#include <memory>
#include <string>

#include "component/object_bounds.hpp"
#include "component/parameters.hpp"
#include "component/robot_views.hpp"
#include "navigation/direct_motion.hpp"
#include "navigation/object_limits.hpp"
#include "navigation/task.hpp"

namespace constrictor {

/// The running goal, or the last one.
struct GoalState {
  std::uint64_t goal_id = 0;
  std::uint8_t task = msg::kTaskNone;
  std::uint8_t state = msg::kGoalIdle;
  msg::TaskParameters parameters{};
  double run_s = 0.0;  ///< TaskInput::run_s
  double progress = 0.0;
  std::string phase;
  std::string reason;

  template <class Archive>
  void serialize(Archive& archive) {
    auto& p = parameters;
    archive(goal_id, task, state, p.line_colour, p.object_colour, p.object_handle, p.drop_zone_colour, p.direction,
            p.timeout_s, p.clearance_m, p.wrap_scale, run_s, progress, phase, reason);
  }
};

struct NavigationState {
  GoalState goal;
  std::unique_ptr<Task> task;  ///< of the running goal; null without one
  Grip grip;
  ObjectTrackerState sightings;
  std::uint64_t motion_id = 0;
  std::string motion;  ///< kind of the newest motion
  DirectMotionState direct;
  bool blind = false;  ///< the task waits for percepts
  bool feels = false;  ///< the robot has contact sensors
  ParameterState parameters;

  template <class Archive>
  void save(Archive& archive) const {
    const std::string bytes = task ? task->save() : std::string();
    archive(goal, grip, sightings, motion_id, motion, direct, blind, feels, parameters, task != nullptr, bytes);
  }
  template <class Archive>
  void load(Archive& archive) {
    bool has_task = false;
    std::string bytes;
    archive(goal, grip, sightings, motion_id, motion, direct, blind, feels, parameters, has_task, bytes);
    task = has_task ? make_task(goal.task) : nullptr;
    if (task) task->load(bytes);
  }
};

/// Reads TaskCommand, MotionCommand, percepts, pose, map, joints, contacts and MotionStatus; writes DesiredTrajectory
/// and TaskStatus every tick and TaskEvent on occurrence. Each goal is answered once, accepted or refused with a
/// reason, and each accepted goal ends once. Without a goal, and while pose, joints or contacts are missing or stale,
/// the robot stands still in its posture and keeps hold of an object.
class Navigation : public TunableComponent<NavigationState, NavigationConfig>, public ObjectJudge {
 public:
  Navigation(Wiring& wiring, const Setup& setup);
  [[nodiscard]] bool has_short_steps() const override { return true; }
  void step(const Tick& tick) override;
  [[nodiscard]] CheckVerdict judge(const DemandedObject& object) const override {
    return judge_object(grip_sense_, robot_, object);
  }

 private:
  [[nodiscard]] bool senses_ready() const;
  /// Takes the commands while pose, joints or contacts are missing: refuses new tasks; obeys cancels and direct
  /// motions.
  void take_commands_without_senses();
  void take_commands(const TaskInput& input);
  void cancel(const msg::TaskCommand& command);
  void take_direct_motions();
  void start_goal(const msg::TaskCommand& command, TaskInput input);
  /// Number of images whose percepts should have come since the newest ones; 0: none has ever come, as without camera.
  [[nodiscard]] std::int64_t silent_images() const;
  /// The task's step; while the task is blind, the robot stands.
  void run_task(TaskInput input, TaskOutput& output);
  /// Reports the loss of a held object and aborts the running goal.
  void monitor_grip(const TaskInput& input, TaskOutput& output);
  void end_goal(std::uint8_t state, const std::string& reason);
  void write_event(std::uint8_t event, std::uint8_t goal_state, std::uint8_t colour, std::uint16_t handle,
                   const std::string& detail);
  void write_refusal(const msg::TaskCommand& command, const std::string& reason);
  void write_trajectory(const TaskOutput& output);
  void write_status(const TaskOutput& output);

  RobotModel robot_;
  GripSense grip_sense_;
  Events<msg::TaskCommand> commands_in_ = wiring_.events(topics::kTaskCommand);
  Events<msg::MotionCommand> direct_in_ = wiring_.events(topics::kMotionCommand);
  Latest<msg::MotionStatus> motion_in_ = wiring_.latest(topics::kMotionStatus);
  FieldView field_{wiring_};
  BodyView body_{wiring_};
  Output<msg::DesiredTrajectory> trajectory_out_ = wiring_.output(topics::kDesiredTrajectory);
  Output<msg::TaskStatus> status_out_ = wiring_.output(topics::kTaskStatus);
  Output<msg::TaskEvent> event_out_ = wiring_.output(topics::kTaskEvent);
};

ComponentFactory make_navigation_factory();

}  // namespace constrictor
