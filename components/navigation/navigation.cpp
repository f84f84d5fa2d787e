#include "navigation/navigation.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <limits>
#include <optional>

#include "component/mission.hpp"
#include "component/task_parameters.hpp"
#include "component/task_refusal.hpp"
#include "configuration/counted.hpp"
#include "constrictor/text.hpp"
#include "navigation/motions.hpp"
#include "navigation/navigation_fit.hpp"

namespace constrictor {
namespace {

constexpr double kSwayPeriod_s = 1.5;  // until control has told its own

/// Throws ConfigurationError if the mission demands a grasp of which this body is not capable.
void check_mission(const std::optional<Mission>& mission, const std::filesystem::path& robot_file,
                   const RobotModel& robot, const GripSense& sense) {
  if (!mission || mission->sequence.empty()) return;
  if (!sense.refusal().empty()) {
    throw ConfigurationError(fmt::format("{}: {}; mission.sequence demands {}", robot_file.string(), sense.refusal(),
                                         counted(mission->sequence.size(), "object")));
  }
  const double radius_m = mission->known.object_radius_m.value_or(0.0);
  if (radius_m > sense.largest_radius_m()) {
    throw ConfigurationError(
        fmt::format("mission.known.object_radius_m: found {:.3f}, accepted at most {:.3f}: the U of {} holds no larger "
                    "object",
                    radius_m, sense.largest_radius_m(), robot.name));
  }
}

}  // namespace

Navigation::Navigation(Wiring& wiring, const Setup& setup)
    : TunableComponent(wiring,
                       navigation_fitted_to(load_robot(setup.robot_file), load_configuration<NavigationConfig>(setup)),
                       topics::kNavigationParameters),
      robot_(load_robot(setup.robot_file)),
      grip_sense_(robot_, config_.grip) {
  check_mission(parse_mission(setup.mission), setup.robot_file, robot_, grip_sense_);
}

bool Navigation::senses_ready() const {
  return body_.joints && field_.pose && body_.contacts && body_.joints.age_ticks() <= config_.stale_after_ticks &&
         field_.pose.age_ticks() <= config_.stale_after_ticks &&
         body_.contacts.age_ticks() <= config_.stale_after_ticks && body_.joints->joint_count == robot_.joints.size();
}

void Navigation::step(const Tick& tick) {
  parameters_.step(tick, state_.parameters);
  TaskOutput output;
  stand(state_.grip, output);
  if (body_.joints && body_.joints.fresh() && body_.joints->joint_count != robot_.joints.size()) {
    wiring_.count_refusal("joint_state.joint_count: found " + std::to_string(body_.joints->joint_count) +
                          ", accepted " + std::to_string(robot_.joints.size()));
  }
  if (!senses_ready()) {
    take_commands_without_senses();
    write_trajectory(output);
    write_status(output);
    return;
  }
  const PlanarPose X_MH{{field_.pose->x_m, field_.pose->y_m}, field_.pose->yaw_rad};
  if (field_.objects && field_.objects.fresh()) update_visibility(config_.object, *field_.objects, state_.sightings);
  if (field_.map && field_.map.fresh())
    take_places(config_.object, *field_.map, X_MH.p, state_.goal.parameters.object_handle, state_.sightings);

  // A robot whose sensors are silent for a while also reports 0 modules; it is still one that feels.
  state_.feels = state_.feels || body_.contacts->module_count > 0;
  const std::vector<PlanarPose> body = planar_body(robot_, *body_.joints);
  std::vector<Touch> touches = lateral_touches(robot_, body, *body_.contacts, config_.grip.touch_force_n);
  if (field_.map) assign_touches(*field_.map, X_MH, config_.object.object_radius_m, touches);
  const bool done = motion_in_ && motion_in_->motion_id == state_.motion_id && motion_in_->accepted && motion_in_->done;
  const double sway_period_s = motion_in_ && motion_in_->period_s > 0.0 ? motion_in_->period_s : kSwayPeriod_s;
  TaskInput input{tick,
                  robot_,
                  config_,
                  grip_sense_,
                  msg::TaskParameters{},
                  X_MH,
                  field_.line.fresh() ? field_.line.get() : nullptr,
                  field_.objects && field_.objects.fresh(),
                  state_.sightings,
                  field_.map.get(),
                  *body_.joints,
                  body,
                  touches,
                  state_.feels,
                  done,
                  sway_period_s};
  take_commands(input);
  take_direct_motions();
  input.parameters = state_.goal.parameters;
  if (state_.task) {
    run_task(input, output);
  } else if (state_.direct.active) {
    step_motion(config_, grip_sense_, state_.grip, state_.direct, output);
    state_.goal.phase = output.phase;
  }
  monitor_grip(input, output);
  write_trajectory(output);
  write_status(output);
}

void Navigation::take_commands_without_senses() {
  for (const auto& command : commands_in_) {
    if (command.command == msg::kCommandStart) {
      write_refusal(command, std::string(kNotReady) + "the joints, the contacts or the pose are missing or stale");
    } else {
      cancel(command);
    }
  }
  take_direct_motions();
}

void Navigation::take_commands(const TaskInput& input) {
  for (const auto& command : commands_in_) {
    if (command.command == msg::kCommandStart) {
      start_goal(command, input);
    } else {
      cancel(command);
    }
  }
}

void Navigation::cancel(const msg::TaskCommand& command) {
  if (state_.task && (command.goal_id == state_.goal.goal_id || command.goal_id == 0))
    end_goal(msg::kGoalCancelled, "cancelled");
}

void Navigation::take_direct_motions() {
  for (const auto& command : direct_in_) {
    if (state_.task) end_goal(msg::kGoalPreempted, "direct motion");
    begin_motion(command, state_.direct, state_.grip);
  }
}

void Navigation::start_goal(const msg::TaskCommand& command, TaskInput input) {
  input.parameters = command.parameters;
  input.path = &command.path;
  std::unique_ptr<Task> task = make_task(command.task);
  std::string refusal = task_parameter_refusal(command.task, command.parameters, command.path);
  if (refusal.empty()) refusal = task ? task->refusal(input, state_.grip) : "this robot's navigation lacks the task";
  const auto set_goal = [&](std::uint8_t goal_state) {
    state_.goal = {};
    state_.goal.goal_id = command.goal_id;
    state_.goal.task = command.task;
    state_.goal.state = goal_state;
    state_.goal.parameters = command.parameters;
    state_.goal.reason = refusal;
  };
  if (!refusal.empty()) {
    write_refusal(command, refusal);
    if (!state_.task) set_goal(msg::kGoalRefused);
    return;
  }
  if (state_.task) end_goal(msg::kGoalPreempted, "another task was started");
  state_.direct = {};
  set_goal(msg::kGoalRunning);
  state_.task = std::move(task);
  state_.task->start(input, state_.grip);
  write_event(msg::kEventNone, msg::kGoalRunning, 0, 0, "accepted");
}

std::int64_t Navigation::silent_images() const {
  if (!field_.line && !field_.objects) return 0;
  const auto age_ticks = [](const auto& percepts) {
    return percepts ? percepts.age_ticks() : std::numeric_limits<std::int64_t>::max();
  };
  return std::min(age_ticks(field_.line), age_ticks(field_.objects)) / robot_.camera.period_ticks;
}

void Navigation::run_task(TaskInput input, TaskOutput& output) {
  const bool seen_before = !state_.blind;
  state_.blind = state_.task->steers_by_sight() && silent_images() > config_.blind_after_images;
  if (state_.blind) {
    if (seen_before)
      wiring_.count_refusal("perception/line and perception/objects: silent; the robot stands until they come again");
    state_.goal.phase = "blind";
    return;
  }
  input.run_s = state_.goal.run_s += input.tick.dt_s();
  state_.task->step(input, state_.grip, output);
  state_.goal.phase = output.phase;
  if (output.direction != msg::kDirectionNone) state_.goal.parameters.direction = output.direction;
  state_.goal.progress = std::max(state_.goal.progress, std::clamp(output.progress, 0.0, 1.0));
  for (const EventRecord& record : output.events) {
    write_event(record.event, msg::kGoalRunning, record.colour, record.handle, "");
  }
  const double limit_s = time_limit_s(state_.goal.parameters);
  if (output.state == msg::kGoalRunning && input.run_s > limit_s && !state_.task->keeps_time())
    output.abort(fmt::format("the time limit of {:g} s passed", limit_s));
  if (output.state != msg::kGoalRunning) end_goal(output.state, output.reason);
}

void Navigation::monitor_grip(const TaskInput& input, TaskOutput& output) {
  Grip& grip = state_.grip;
  // In an emergency stop the joints hold the measured posture, so that the body no longer presses the object: that it
  // feels none then proves nothing.
  const bool moves = state_.task || state_.direct.active;
  if (!grip.carrying || !grip_sense_.watch(input.joints, input.touches, input.feels, input.tick.dt_s(), grip, moves))
    return;
  grip.carrying = false;
  write_event(msg::kEventObjectGraspLost, state_.goal.state, grip.colour, grip.handle,
              input.feels ? "the base touches no object, by its touches and its torque"
                          : "the base holds no object, by its torque");
  if (state_.task) end_goal(msg::kGoalAborted, "object grasp lost");
  stand(grip, output);
}

void Navigation::end_goal(std::uint8_t state, const std::string& reason) {
  state_.goal.state = state;
  state_.goal.reason = reason;
  if (state == msg::kGoalSucceeded) state_.goal.progress = 1.0;
  state_.task.reset();
  write_event(msg::kEventNone, state, 0, 0, reason);
}

void Navigation::write_event(std::uint8_t event, std::uint8_t goal_state, std::uint8_t colour, std::uint16_t handle,
                             const std::string& detail) {
  msg::TaskEvent message{};
  message.goal_id = state_.goal.goal_id;
  message.task = state_.goal.task;
  message.event = event;
  message.goal_state = goal_state;
  message.colour = colour;
  message.object_handle = handle;
  set_text(message.detail, detail);
  event_out_.write(message);
}

void Navigation::write_refusal(const msg::TaskCommand& command, const std::string& reason) {
  msg::TaskEvent event{};
  event.goal_id = command.goal_id;
  event.task = command.task;
  event.goal_state = msg::kGoalRefused;
  set_text(event.detail, reason);
  event_out_.write(event);
}

void Navigation::write_trajectory(const TaskOutput& output) {
  if (output.new_motion || state_.motion != output.desired.motion) ++state_.motion_id;
  state_.motion = output.desired.motion;
  msg::DesiredTrajectory desired = output.desired;
  desired.motion_id = state_.motion_id;
  trajectory_out_.write(desired);
}

void Navigation::write_status(const TaskOutput& output) {
  msg::TaskStatus status{};
  status.goal_id = state_.goal.goal_id;
  status.task = state_.goal.task;
  status.goal_state = state_.goal.state;
  status.progress = state_.goal.progress;
  status.parameters = state_.goal.parameters;
  status.carrying = state_.grip.carrying;
  status.cross_track_m = output.cross_track_m;
  set_text(status.phase, state_.goal.phase);
  set_text(status.reason, state_.goal.reason);
  status_out_.write(status);
}

ComponentFactory make_navigation_factory() {
  return make_factory<Navigation, NavigationConfig>("navigation", "components/navigation/navigation.yaml");
}

}  // namespace constrictor
