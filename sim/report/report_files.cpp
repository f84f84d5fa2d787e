// Report's files at the end of a run: mission.json and figure.png.
#include <fmt/format.h>

#include <cmath>
#include <cstdio>
#include <nlohmann/json.hpp>
#include <string_view>

#include "constrictor/constants.hpp"
#include "constrictor/hex.hpp"
#include "constrictor/image.hpp"
#include "constrictor/json.hpp"
#include "sim/figure/captions.hpp"
#include "sim/figure/lazy_figure.hpp"
#include "sim/report/report.hpp"
#include "sim/report/scene_pictures.hpp"

namespace constrictor {

using nlohmann::ordered_json;

namespace {

/// The lines of a journal. Each line is a JSON value.
ordered_json lines_of(const std::string& journal) {
  ordered_json lines = ordered_json::array();
  for (std::size_t at = 0; at < journal.size();) {
    const std::size_t end = journal.find('\n', at);
    lines.push_back(ordered_json::parse(journal.substr(at, end - at)));
    at = end + 1;
  }
  return lines;
}

/// `mission_ended`: whether a moment without an event is the end of the mission or only the end of the run.
std::string caption_of(const report::Moment& moment, bool mission_ended) {
  std::string end = mission_ended ? "end of the mission" : "end of the run";
  if (moment.event == msg::kEventNone) return end;
  const std::string words = figure::event_caption(moment.event, moment.colour);
  return moment.ends ? words + ", " + end : words;
}

}  // namespace

std::string Report::scenario() const { return scene_ ? std::string(scene_->scenario) : scenario_; }

ordered_json Report::objects_json() const {
  ordered_json objects = ordered_json::array();
  if (!truth()) {
    for (const report::BelievedObject& object : state_.believed.objects) {
      objects.push_back({{"colour", name_of(constants::kColour, object.colour)},
                         {"grasped", object.grasped},
                         {"dropped", object.dropped},
                         {"in_zone", nullptr},
                         {"zone_distance_m", nullptr}});
    }
    return objects;
  }
  for (std::size_t i = 0; i < state_.ledger.objects.size(); ++i) {
    const report::ObjectRecord& record = state_.ledger.objects[i];
    const report::ZoneVerdict verdict = report::judge_zone(*scene_, *world_, i);
    objects.push_back({{"colour", name_of(constants::kColour, scene_->objects[i].colour)},
                       {"grasped", record.grasped},
                       {"dropped", record.dropped},
                       {"in_zone", verdict.in_zone},
                       {"zone_distance_m", verdict.distance_m}});
  }
  return objects;
}

std::string Report::mission_json(const Tick& tick, const std::string& figure_error) const {
  ordered_json json;
  json["success"] = success();
  json["judged_by"] = truth() ? "ground truth" : "the robot";
  json["seed"] = scene_ ? scene_->seed : seed_;
  json["scenario"] = scenario();
  json["sim_time_s"] = tick.time_s();
  const bool ended = state_.mission_end_tick >= 0;
  json["mission_time_s"] = ended ? static_cast<double>(state_.mission_end_tick) * tick.period_s() : std::nan("");
  json["ticks"] = tick.index;
  json["state_hash"] = world_ ? ordered_json(hex(world_->state_hash)) : ordered_json();
  json["reason"] = failure();
  json["mission"] = success() ? "succeeded" : state_.mission == msg::kMissionRunning ? "unfinished" : "failed";
  json["believed"] = state_.mission == msg::kMissionSucceeded ? "succeeded"
                     : state_.mission == msg::kMissionRunning ? "unfinished"
                                                              : "failed";
  json["all_in_zones"] = truth() && !demanded_.empty()
                             ? ordered_json(state_.ledger.all_in_zones(demanded_, *scene_, *world_))
                             : ordered_json();
  json["demanded"] = ordered_json::array();
  for (const std::uint8_t colour : demanded_) json["demanded"].push_back(name_of(constants::kColour, colour));
  json["recoveries"] = state_.recoveries;
  json["objects"] = objects_json();
  const double visible = state_.percepts_following > 0 ? static_cast<double>(state_.percepts_visible) /
                                                             static_cast<double>(state_.percepts_following)
                                                       : std::nan("");
  json["line"] = {{"rms_cross_track_m", state_.cross_track.rms()},
                  {"max_cross_track_m", state_.cross_track.max()},
                  {"visible_fraction", visible}};
  json["pose_error"] = {{"rms_m", state_.pose_error_m.rms()},
                        {"rms_rad", state_.pose_error_rad.rms()},
                        {"max_m", state_.pose_error_m.max()}};
  json["effort"] = {{"work_j", state_.effort.work_j},
                    {"distance_m", truth() ? state_.effort.distance_m : std::nan("")},
                    {"cost_of_transport", state_.effort.cost_of_transport(mass_kg_)}};
  json["events"] = lines_of(events_.read(state_.events_length));
  json["states"] = lines_of(states_.read(state_.states_length));
  json["parameters"] = lines_of(parameters_.read(state_.parameters_length));
  if (!figure_error.empty()) json["figure_error"] = figure_error;
  for (const auto& [file, reason] : lost_.reasons()) json["files_not_written"].push_back(reason);
  return json.dump(2, ' ', false, ordered_json::error_handler_t::replace) + "\n";
}

std::string Report::draw_scenes(const std::vector<report::Moment>& moments) {
  if (!scene_) return {};
  try {
    report::draw_scene_pictures(folder_, moments, *scene_, head_camera_m_, lost_);
  } catch (const std::runtime_error& error) {
    return error.what();
  }
  return {};
}

std::string Report::draw_figure(const Tick& tick, const std::vector<report::Moment>& moments) {
  std::vector<figure::FileRow> rows;
  for (const report::Moment& moment : report::merge_end(moments)) {
    const report::MomentFiles files(folder_, moment);
    figure::FileRow row{moment.time_s,
                        caption_of(moment, state_.mission_end_tick >= 0),
                        moment.state,
                        moment.colour,
                        files.scene,
                        {},
                        {}};
    if (moment.camera_exposure >= 0) row.camera = files.camera;
    if (moment.has_processed) row.processed = files.processed;
    rows.push_back(std::move(row));
  }
  const figure::Heading heading{figure::kTitle,
                                fmt::format("scenario {}, seed {}: {} after {:.1f} s", scenario(),
                                            scene_ ? scene_->seed : seed_, outcome(), tick.time_s()),
                                failure()};
  const std::string torques = torques_.read(state_.torques_length);
  try {
    const std::string png = figure::draw_png_lazily(heading, rows, torques, config_.torque_window_s);
    report::replace_file(folder_ / "figure.png", png);
  } catch (const std::runtime_error& error) {
    return error.what();
  }
  return {};
}

std::string Report::outcome() const { return success() ? "succeeded" : "did not succeed"; }

void Report::write_files(const Tick& tick) {
  if (folder_.empty()) return;
  if (processed_ && image_violation(*processed_).empty()) state_.album.finish(folder_, *processed_, lost_);
  const std::vector<report::Moment> moments = report::figure_rows(state_.album.moments);
  // The verdict is needed without pictures, too.
  std::string figure_error = draw_scenes(moments);
  if (const std::string error = draw_figure(tick, moments); figure_error.empty()) figure_error = error;
  if (!figure_error.empty()) log_.warning("the figure is missing or incomplete: {}", figure_error);
  // mission.json is written last: its presence shows that the other files are complete.
  const auto write_mission = [&] { report::replace_file(folder_ / "mission.json", mission_json(tick, figure_error)); };
  if (!lost_.attempt(write_mission)) {
    report::remove_work_files(folder_);  // so that there may be space
    if (!lost_.attempt(write_mission)) log_.error("the mission {} {}", outcome(), failure());
  }
  // If this process is killed before this line, the restarted process draws all pictures again. If it is killed while
  // it removes world states, their moments keep the pictures that it has drawn.
  report::remove_work_files(folder_);
}

}  // namespace constrictor
