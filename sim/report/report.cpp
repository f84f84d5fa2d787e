#include "sim/report/report.hpp"

#include <fmt/format.h>

#include <cmath>
#include <cstdio>
#include <memory>
#include <nlohmann/json.hpp>
#include <opencv2/imgcodecs.hpp>
#include <string_view>

#include "configuration/configuration.hpp"
#include "constrictor/json.hpp"
#include "robot/robot_model.hpp"
#include "sim/report/figure.hpp"
#include "sim/report/names.hpp"

namespace constrictor {

using nlohmann::ordered_json;

namespace {

double seconds(const msg::Header& header) { return static_cast<double>(header.time_ns) * 1e-9; }

report::PlanarPose planar(const msg::Pose3& pose, std::int64_t tick) {
  const auto& q = pose.orientation;
  return {tick, pose.position_m.x, pose.position_m.y, std::atan2(2 * (q.w * q.z + q.x * q.y), 1 - 2 * (q.y * q.y + q.z * q.z))};
}

std::filesystem::path in_folder(const std::filesystem::path& folder, const char* name) {
  return folder.empty() ? folder : folder / name;
}

std::string hex(const std::uint8_t (&bytes)[32]) {
  std::string text;
  for (const std::uint8_t byte : bytes) {
    char digits[3];
    std::snprintf(digits, sizeof digits, "%02x", byte);
    text += digits;
  }
  return text;
}

/// The lines of a journal of JSON values.
ordered_json lines_of(const std::string& journal) {
  ordered_json lines = ordered_json::array();
  for (std::size_t at = 0; at < journal.size();) {
    const std::size_t end = journal.find('\n', at);
    lines.push_back(ordered_json::parse(journal.substr(at, end - at)));
    at = end + 1;
  }
  return lines;
}

std::string caption_of(const report::Moment& moment) {
  const std::string colour = moment.colour == msg::kColourUnknown ? "" : report::colour_name(moment.colour) + " ";
  switch (moment.event) {
    case msg::kEventLineFound: return "line found";
    case msg::kEventObjectFound: return colour + "object found";
    case msg::kEventObjectPregrasped: return colour + "object pregrasped";
    case msg::kEventObjectGrasped: return colour + "object grasped";
    case msg::kEventDroppingDone: return colour + "object dropped";
    default: return "end of the mission";
  }
}

}  // namespace

ReportConfiguration load_report(const std::filesystem::path& path) {
  auto file = Configuration::load(path);
  ReportConfiguration configuration;
  configuration.max_sim_time_s = file.number("max_sim_time_s", {0.1, 36000.0});
  configuration.settle_s = file.number("settle_s", {0.0, 60.0});
  configuration.torque_decimation_ticks = static_cast<int>(file.integer("torque_decimation_ticks", 1, 1000));
  configuration.torque_window_s = file.number("torque_window_s", {1.0, 600.0});
  file.finish();
  return configuration;
}

Report::Report(Wiring& wiring, const Setup& setup)
    : wiring_(wiring),
      configuration_(load_report(setup.config_file)),
      folder_(setup.output_dir),
      yaw_joints_(load_robot(setup.robot_file).yaw_joints()),
      torques_(in_folder(folder_, "joint_torques.csv")),
      events_(in_folder(folder_, "events.jsonl")),
      states_(in_folder(folder_, "states.jsonl")),
      parameters_(in_folder(folder_, "parameters.jsonl")),
      world_(wiring.latest(topics::kWorldState)),
      scene_(wiring.latest(topics::kSceneDescription)),
      pose_(wiring.latest(topics::kRobotPose)),
      task_(wiring.latest(topics::kTaskStatus)),
      task_events_(wiring.events(topics::kTaskEvent)),
      parameter_changes_(wiring.events(topics::kParameterChange)),
      mission_(wiring.latest(topics::kMissionStatus)),
      joints_(wiring.latest(topics::kJointState)),
      line_(wiring.latest(topics::kLinePercept)),
      camera_(wiring.latest(topics::kCameraImage)),
      processed_(wiring.latest(topics::kProcessedImage)),
      overview_(wiring.latest(topics::kOverviewImage)) {}

void Report::step(const Tick& tick) {
  if (state_.finished || !world_ || !scene_) return;
  if (line_m_.empty()) {
    for (std::size_t i = 0; i < scene_->line_point_count; ++i) line_m_.emplace_back(scene_->line_x_m[i], scene_->line_y_m[i]);
  }
  follow_truth();
  follow_mission(tick);
  follow_events();
  follow_parameters(tick);
  follow_images();
  journal_torques(tick);
  const auto settle_ticks = static_cast<std::int64_t>(std::llround(configuration_.settle_s / tick.period_s()));
  const bool settled = state_.mission_end_tick >= 0 && tick.index >= state_.mission_end_tick + settle_ticks;
  if (settled || tick.time_s() >= configuration_.max_sim_time_s) {
    write_files(tick);
    state_.finished = true;
    wiring_.request_end_of_run();
  }
}

void Report::conclude(const Tick& last) {
  if (!state_.finished && world_ && scene_) write_files(last);
}

void Report::follow_truth() {
  constexpr std::size_t kHeadsKept = 16;  // estimates are at most some ticks old
  const report::PlanarPose head = planar(world_->module_poses[0], world_->header.tick);
  if (state_.start.tick < 0) {
    state_.start = head;
    state_.ledger.start(*scene_);
  }
  state_.heads.push_back(head);
  if (state_.heads.size() > kHeadsKept) state_.heads.pop_front();

  const bool following = task_ && task_->task == msg::kTaskFollowLine && task_->state == msg::kGoalRunning;
  if (following) {
    if (const auto distance = report::cross_track_m({head.x_m, head.y_m}, line_m_)) state_.cross_track.add(*distance);
    if (line_ && line_.fresh()) {
      ++state_.percepts_following;
      state_.percepts_visible += line_->visible ? 1 : 0;
    }
  }
  if (pose_ && pose_.fresh()) {
    for (const report::PlanarPose& then : state_.heads) {
      if (then.tick != pose_->header.tick) continue;
      const report::PlanarPose truth = report::relative_pose(state_.start, then);
      state_.pose_error_m.add(std::hypot(pose_->x_m - truth.x_m, pose_->y_m - truth.y_m));
      state_.pose_error_rad.add(report::wrapped(pose_->yaw_rad - truth.yaw_rad));
    }
  }
}

void Report::follow_mission(const Tick& tick) {
  if (!mission_ || !mission_.fresh() || state_.mission != msg::kMissionRunning) return;
  state_.ledger.on_mission(*mission_);
  state_.recoveries = mission_->recoveries;
  if (state_.mission_state != mission_->state) {
    state_.mission_state = mission_->state;
    const ordered_json line{{"sim_time_s", seconds(mission_->header)}, {"state", state_.mission_state}};
    states_.append(json_text(line) + "\n", state_.states_length);
  }
  if (mission_->mission == msg::kMissionRunning) return;
  state_.mission = mission_->mission;
  state_.mission_reason = mission_->reason;
  state_.mission_end_tick = tick.index;
  add_moment(tick.index, tick.time_s(), msg::kEventNone, msg::kColourUnknown);
}

void Report::follow_events() {
  for (const msg::TaskEvent& event : task_events_) {
    state_.ledger.on_event(event, *scene_, *world_);
    const std::string name = event.event == msg::kEventNone ? "goal_" + report::goal_state_name(event.goal_state) : report::event_name(event.event);
    const ordered_json line{{"sim_time_s", seconds(event.header)},
                            {"task", report::task_name(event.task)},
                            {"event", name},
                            {"parameters",
                             {{"goal_id", event.goal_id},
                              {"goal_state", report::goal_state_name(event.goal_state)},
                              {"colour", report::colour_name(event.colour)},
                              {"object_handle", event.object_handle},
                              {"detail", event.detail}}}};
    events_.append(json_text(line) + "\n", state_.events_length);
    if (report::is_key_event(event.event)) add_moment(event.header.tick, seconds(event.header), event.event, event.colour);
  }
}

void Report::follow_parameters(const Tick& tick) {
  for (const msg::ParameterChange& change : parameter_changes_) {
    const ordered_json line{{"sim_time_s", static_cast<double>(change.effective_tick) * tick.period_s()},
                            {"tick", change.effective_tick},
                            {"name", change.name},
                            {"value", change.value},
                            {"source", change.source}};
    parameters_.append(json_text(line) + "\n", state_.parameters_length);
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
  state_.album.add(std::move(moment), folder_, camera_ && report::is_whole(*camera_) ? &*camera_ : nullptr);
}

void Report::follow_images() {
  if (folder_.empty()) return;
  // The camera may be anybody's.
  const auto whole = [&](const Latest<msg::CameraImage>& image, std::string_view topic) {
    if (!image || !image.fresh()) return false;
    if (report::is_whole(*image)) return true;
    wiring_.count_refusal(fmt::format("{}.data: found {} bytes, accepted {} x {} RGB pixels", topic, image->data._length, image->width, image->height));
    return false;
  };
  static_cast<void>(whole(camera_, topics::kCameraImage.name));  // read at the next moment
  if (whole(processed_, topics::kProcessedImage.name)) state_.album.on_processed(folder_, *processed_);
  if (whole(overview_, topics::kOverviewImage.name)) state_.album.on_scene(folder_, *overview_);
}

void Report::journal_torques(const Tick& tick) {
  if (folder_.empty() || !joints_ || tick.index % configuration_.torque_decimation_ticks != 0) return;
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
  torques_.append(line + "\n", state_.torques_length);
}

bool Report::success() const { return state_.mission == msg::kMissionSucceeded && state_.ledger.complete(*scene_, *world_); }

std::string Report::mission_json(const Tick& tick) const {
  ordered_json json;
  json["success"] = success();
  json["seed"] = scene_->seed;
  json["scenario"] = scene_->scenario;
  json["sim_time_s"] = tick.time_s();
  json["ticks"] = tick.index;
  json["state_hash"] = hex(world_->state_hash);
  json["mission"] = state_.mission == msg::kMissionRunning ? "running" : state_.mission == msg::kMissionSucceeded ? "succeeded" : "failed";
  json["reason"] = state_.mission_reason;
  json["recoveries"] = state_.recoveries;
  json["objects"] = ordered_json::array();
  for (std::size_t i = 0; i < state_.ledger.objects.size(); ++i) {
    const report::ObjectRecord& record = state_.ledger.objects[i];
    const report::ZoneVerdict verdict = report::judge_zone(*scene_, *world_, i);
    json["objects"].push_back({{"colour", report::colour_name(scene_->objects[i].colour)},
                               {"grasped", record.grasped},
                               {"dropped", record.dropped},
                               {"in_zone", verdict.in_zone},
                               {"zone_distance_m", verdict.distance_m}});
  }
  const double visible = state_.percepts_following > 0 ? static_cast<double>(state_.percepts_visible) / static_cast<double>(state_.percepts_following)
                                                       : std::nan("");
  json["line"] = {{"rms_cross_track_m", state_.cross_track.rms()}, {"max_cross_track_m", state_.cross_track.max()}, {"visible_fraction", visible}};
  json["pose_error"] = {{"rms_m", state_.pose_error_m.rms()}, {"rms_rad", state_.pose_error_rad.rms()}, {"max_m", state_.pose_error_m.max()}};
  json["events"] = lines_of(events_.read(state_.events_length));
  json["states"] = lines_of(states_.read(state_.states_length));
  json["parameters"] = lines_of(parameters_.read(state_.parameters_length));
  return json.dump(2, ' ', false, ordered_json::error_handler_t::replace) + "\n";
}

void Report::draw(const Tick& tick) const {
  std::vector<report::FigureRow> rows;
  for (const report::Moment& moment : report::figure_rows(state_.album.moments)) {
    const report::MomentFiles files(folder_, moment);
    report::FigureRow row{moment.time_s, caption_of(moment), moment.state, moment.colour, {}, {}, {}};
    if (moment.has_scene) row.scene = files.scene;
    if (moment.camera_exposure >= 0) row.camera = files.camera;
    if (moment.has_processed) row.processed = files.processed;
    rows.push_back(std::move(row));
  }
  char subtitle[160];
  std::snprintf(subtitle, sizeof subtitle, "scenario %s, seed %llu: %s after %.1f s", scene_->scenario,
                static_cast<unsigned long long>(scene_->seed), success() ? "succeeded" : "not succeeded", tick.time_s());
  const cv::Mat figure = report::draw_figure("Line following and whole-body grasping", subtitle, rows,
                                             report::parse_torques(torques_.read(state_.torques_length)), configuration_.torque_window_s);
  std::vector<unsigned char> png;
  cv::imencode(".png", figure, png);
  report::replace_file(folder_ / "figure.png", std::string_view(reinterpret_cast<const char*>(png.data()), png.size()));
}

void Report::write_files(const Tick& tick) const {
  if (folder_.empty()) return;
  draw(tick);
  report::replace_file(folder_ / "mission.json", mission_json(tick));  // last: whoever finds it finds everything
}

ComponentFactory make_report_factory() {
  return {"report", [](Wiring& wiring, const Setup& setup) { return std::make_unique<Report>(wiring, setup); },
          "sim/report/report.yaml"};
}

}  // namespace constrictor
