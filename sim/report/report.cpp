#include "sim/report/report.hpp"

#include <fmt/format.h>

#include <cmath>
#include <cstdio>
#include <memory>
#include <nlohmann/json.hpp>
#include <string_view>

#include "constrictor/constants.hpp"
#include "constrictor/image.hpp"
#include "constrictor/json.hpp"
#include "robot/planar_message.hpp"
#include "sim/scenario_loader/line_end.hpp"

namespace constrictor {

using nlohmann::ordered_json;

namespace {

double seconds(const msg::Header& header) { return static_cast<double>(header.time_ns) * 1e-9; }

/// The newest image, if it has all its bytes.
const msg::CameraImage* whole(const Latest<msg::CameraImage>& image) {
  return image && image_violation(*image).empty() ? image.get() : nullptr;
}

std::filesystem::path in_folder(const std::filesystem::path& folder, const char* name) {
  return folder.empty() ? folder : folder / name;
}

}  // namespace

Report::Report(Wiring& wiring, const Setup& setup) : Report(wiring, setup, load_robot(setup.robot_file)) {}

Report::Report(Wiring& wiring, const Setup& setup, const RobotModel& robot)
    : ConfiguredComponent(wiring, setup),
      limit_(config_.limit(parse_mission(setup.mission).value_or(Mission{}).limits)),
      demanded_(parse_mission(setup.mission).value_or(Mission{}).sequence),
      scenario_(setup.scenario_file.stem().string()),
      seed_(setup.seed),
      plant_limit_s_(setup.max_sim_time_s),
      folder_(setup.output_dir),
      yaw_joints_(robot.yaw_joints()),
      mass_kg_(robot.module_mass_kg * static_cast<double>(robot.module_count)),
      head_camera_m_(robot.camera.p_HC),
      torques_(in_folder(folder_, "joint_torques.csv")),
      events_(in_folder(folder_, "events.jsonl")),
      states_(in_folder(folder_, "states.jsonl")),
      parameters_(in_folder(folder_, "parameters.jsonl")),
      log_(setup.log),
      lost_(setup.log) {}

void Report::step(const Tick& tick) {
  if (state_.finished) return;
  if (truth()) {
    read_line();
    follow_truth();
  }
  follow_line();
  follow_effort(tick);
  follow_mission(tick);
  follow_events();
  follow_parameters(tick);
  follow_images();
  journal_torques(tick);
  const auto settle_ticks = static_cast<std::int64_t>(std::llround(config_.settle_s / tick.period_s()));
  const bool settled = state_.mission_end_tick >= 0 && tick.index >= state_.mission_end_tick + settle_ticks;
  const bool late = tick.time_s() >= limit_.at_s;
  if (!settled && !late) return;
  if (state_.mission_end_tick < 0)
    end_early(tick, fmt::format("time limit of {:g} s ({})", limit_.at_s, limit_.source));
  write_files(tick);
  state_.finished = true;
  wiring_.request_end_of_run();
}

void Report::conclude(const Tick& last) {
  if (state_.finished) return;
  if (truth()) read_line();  // a process that was restarted in the last tick has not read it in a step
  if (state_.mission_end_tick < 0) {
    // No component steps in the run's final tick: at the plant's time limit, the last step was one period earlier.
    const bool at_limit = plant_limit_s_ > 0 && last.time_s() + 1.5 * last.period_s() >= plant_limit_s_;
    end_early(last, at_limit ? fmt::format("time limit of {:g} s (--max-sim-time)", plant_limit_s_)
                             : fmt::format("ended by user at {:.1f} s", last.time_s()));
  }
  write_files(last);
}

void Report::read_line() {
  if (!line_m_.empty()) return;
  for (std::size_t i = 0; i < scene_->line_point_count; ++i)
    line_m_.emplace_back(scene_->line_x_m[i], scene_->line_y_m[i]);
}

void Report::follow_truth() {
  constexpr std::size_t kHeadsKept = 16;  // an estimate is at most a few ticks old
  const report::PoseAtTick head{world_->header.tick, planar(world_->module_poses[0])};
  if (state_.start.tick < 0) {
    state_.start = head;
    state_.ledger.start(*scene_);
  }
  state_.heads.push_back(head);
  if (state_.heads.size() > kHeadsKept) state_.heads.pop_front();

  if (following_line()) {
    if (const auto distance = report::cross_track_m(head.X.p, line_m_)) state_.cross_track.add(*distance);
  }
  if (pose_ && pose_.fresh()) {
    for (const report::PoseAtTick& then : state_.heads) {
      if (then.tick != pose_->header.tick) continue;
      const PlanarPose truth = report::relative_pose(state_.start.X, then.X);
      state_.pose_error_m.add(std::hypot(pose_->x_m - truth.p.x(), pose_->y_m - truth.p.y()));
      state_.pose_error_rad.add(wrap_angle(pose_->yaw_rad - truth.yaw_rad));
    }
  }
}

bool Report::following_line() const {
  return task_ && task_->task == msg::kTaskFollowLine && task_->goal_state == msg::kGoalRunning;
}

void Report::follow_line() {
  if (!following_line() || !line_ || !line_.fresh()) return;
  ++state_.percepts_following;
  state_.percepts_visible += line_->visible ? 1 : 0;
}

void Report::follow_effort(const Tick& tick) {
  if (joints_) {
    double power_w = 0.0;
    for (std::size_t i = 0; i < joints_->joint_count; ++i)
      power_w += std::abs(joints_->torque_nm[i] * joints_->velocity_rad_s[i]);
    state_.effort.add_work(power_w, tick.period_s());
  }
  if (!truth()) return;
  Eigen::Vector2d centre_m(0, 0);
  for (std::size_t i = 0; i < world_->module_count; ++i)
    centre_m += planar(world_->module_poses[i]).p / static_cast<double>(world_->module_count);
  state_.effort.add_centre(centre_m, tick.time_s());
}

void Report::follow_mission(const Tick& tick) {
  if (!mission_ || !mission_.fresh() || state_.mission != msg::kMissionRunning) return;
  state_.ledger.on_mission(*mission_, task_ && task_->carrying);
  state_.recoveries = mission_->recoveries;
  if (state_.mission_state != mission_->state) {
    state_.mission_state = mission_->state;
    const ordered_json line{{"sim_time_s", seconds(mission_->header)}, {"state", state_.mission_state}};
    append(states_, json_text(line) + "\n", state_.states_length);
  }
  if (mission_->outcome == msg::kMissionRunning) return;
  state_.mission = mission_->outcome;
  state_.mission_reason = mission_->reason;
  state_.mission_end_tick = tick.index;
  add_moment(tick.index, tick.time_s(), msg::kEventNone, msg::kColourUnknown);
}

void Report::follow_events() {
  for (const msg::TaskEvent& event : task_events_) {
    if (truth()) state_.ledger.on_event(event, *scene_, *world_);
    state_.believed.on_event(event);
    const std::string name = event.event == msg::kEventNone
                                 ? "goal_" + std::string(name_of(constants::kGoal, event.goal_state))
                                 : name_of(constants::kEvent, event.event);
    const ordered_json line{{"sim_time_s", seconds(event.header)},
                            {"task", name_of(constants::kTask, event.task)},
                            {"event", name},
                            {"parameters",
                             {{"goal_id", event.goal_id},
                              {"goal_state", name_of(constants::kGoal, event.goal_state)},
                              {"colour", name_of(constants::kColour, event.colour)},
                              {"object_handle", event.object_handle},
                              {"detail", event.detail}}}};
    append(events_, json_text(line) + "\n", state_.events_length);
    if (report::is_key_event(event.event))
      add_moment(event.header.tick, seconds(event.header), event.event, event.colour);
  }
}

void Report::follow_parameters(const Tick& tick) {
  for (const msg::ParameterChange& change : parameter_changes_) {
    const ordered_json line{{"sim_time_s", static_cast<double>(change.effective_tick) * tick.period_s()},
                            {"tick", change.effective_tick},
                            {"name", change.name},
                            {"value", change.value},
                            {"source", change.source}};
    append(parameters_, json_text(line) + "\n", state_.parameters_length);
  }
}

void Report::add_moment(std::int64_t tick, double time_s, std::uint8_t event, std::uint8_t colour) {
  if (folder_.empty()) return;
  report::Moment moment;
  moment.tick = tick;
  moment.time_s = time_s;
  moment.event = event;
  moment.colour = colour;
  moment.state = state_.mission_state;
  state_.album.add(std::move(moment), folder_, {whole(camera_), whole(processed_), world_.get()}, lost_);
}

void Report::follow_images() {
  if (folder_.empty()) return;
  // Another program's camera may send images of a wrong size.
  const auto accepted = [&](const Latest<msg::CameraImage>& image, std::string_view topic) {
    if (!image || !image.fresh()) return false;
    const std::string violation = image_violation(*image);
    if (violation.empty()) return true;
    wiring_.count_refusal(fmt::format("{}.{}", topic, violation));
    return false;
  };
  if (accepted(camera_, topics::kCameraImage.name)) state_.album.on_camera(folder_, *camera_, lost_);
  if (accepted(processed_, topics::kProcessedImage.name))
    state_.album.on_processed(folder_, *processed_, whole(camera_), lost_);
}

void Report::journal_torques(const Tick& tick) {
  if (folder_.empty() || !joints_ || tick.index % config_.torque_decimation_ticks != 0) return;
  std::string line;
  if (state_.torques_length == 0) {
    line = "sim_time_s";
    for (const std::size_t joint : yaw_joints_) line += ",joint_" + std::to_string(joint) + "_nm";
    line += "\n";
  }
  char number[32];
  std::snprintf(number, sizeof number, "%.3f", seconds(joints_->header));
  line += number;
  for (const std::size_t joint : yaw_joints_) {
    std::snprintf(number, sizeof number, ",%.4f", joint < joints_->joint_count ? joints_->torque_nm[joint] : 0.0);
    line += number;
  }
  append(torques_, line + "\n", state_.torques_length);
}

void Report::end_early(const Tick& tick, const std::string& reason) {
  state_.run_end_reason = reason;
  add_moment(tick.index, tick.time_s(), msg::kEventNone, msg::kColourUnknown);
}

std::string Report::failure() const {
  switch (state_.mission) {
    case msg::kMissionRunning:
      return state_.run_end_reason;
    case msg::kMissionSucceeded: {
      if (!truth()) return {};
      const msg::Vector3& head = world_->module_poses[0].position_m;
      return state_.ledger.sequence.empty() ? line_shortfall(Eigen::Vector2d(head.x, head.y), line_m_)
                                            : state_.ledger.shortfall(*scene_, *world_);
    }
    default:
      return "the planner gave up: " + (state_.mission_reason.empty() ? "it gave no reason" : state_.mission_reason);
  }
}

bool Report::success() const { return state_.mission == msg::kMissionSucceeded && failure().empty(); }

ComponentFactory make_report_factory() {
  return make_factory<Report, ReportConfig>("report", "sim/report/report.yaml");
}

}  // namespace constrictor
