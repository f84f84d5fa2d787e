#include "cli/evaluate/mission_result.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <iterator>
#include <nlohmann/json.hpp>

#include "cli/child_process.hpp"
#include "runtime/host.hpp"

namespace constrictor::cli {

namespace {

/// The launcher has written its part of the report, but the member `report` could not write its own (mission.json).
bool lacks_verdict(const nlohmann::json& report) {
  const nlohmann::json& members = field(report, "members");
  const bool member = std::any_of(members.begin(), members.end(),
                                  [](const nlohmann::json& entry) { return text_field(entry, "name") == "report"; });
  constexpr const char* kItsKeys[] = {"judged_by", "state_hash", "objects", "states", "recoveries"};
  return member && !flag_field(report, "success") &&
         std::all_of(std::begin(kItsKeys), std::end(kItsKeys),
                     [&](const char* key) { return field(report, key).is_null(); });
}

}  // namespace

bool reached(const MissionResult& result, std::size_t phase) {
  const auto& demanded = result.demanded;
  const auto all = [&](auto&& holds) {
    return !demanded.empty() && std::all_of(demanded.begin(), demanded.end(), [&](const std::string& colour) {
      const auto counts = [&](const ObjectResult& object) { return object.colour == colour && holds(object); };
      return std::count_if(result.objects.begin(), result.objects.end(), counts) >=
             std::count(demanded.begin(), demanded.end(), colour);
    });
  };
  switch (phase) {
    case 0:
      return all([](const ObjectResult& object) { return object.grasped; });
    case 1:
      return all([](const ObjectResult& object) { return object.dropped; });
    case 2:
      return all([](const ObjectResult& object) { return object.dropped && object.in_zone; });
    default:
      return result.success;
  }
}

MissionResult read_result(const std::filesystem::path& folder, int status, const SearchLimits& limits) {
  MissionResult result;
  result.exit_status = status;
  std::ifstream stream(folder / "report.json");
  const nlohmann::json report = stream ? nlohmann::json::parse(stream, nullptr, false) : nlohmann::json();
  if (!report.is_object()) {
    // `run` makes a report of every run that has begun.
    result.refused = !stream.is_open() && status == exit_status::kConfiguration;
    result.incomplete = !result.refused;
    if (result.incomplete) result.reason = fmt::format("no report; `constrictor run` ended with status {}", status);
    // The launcher's last line says why there is none.
    for (const auto& line : last_lines(folder / "run.log", 0, 1))
      result.reason += (result.reason.empty() ? "" : ": ") + line;
    return result;
  }
  if (lacks_verdict(report)) {
    result.incomplete = true;
    result.reason = "the results of the member report are missing in report.json";
    return result;
  }
  result.success = flag_field(report, "success");
  result.believed = text_field(report, "believed") == "succeeded";
  result.all_in_zones = flag_field(report, "all_in_zones");
  result.reason = text_field(report, "reason");
  const double run_s = number_field(report, "sim_time_s"), mission_s = number_field(report, "mission_time_s");
  result.mission_time_s = std::isfinite(mission_s) ? mission_s : run_s;
  result.wall_time_s = number_field(report, "wall_time_s");
  result.rms_cross_track_m = number_field(field(report, "line"), "rms_cross_track_m");
  result.rms_pose_error_m = number_field(field(report, "pose_error"), "rms_m");
  result.cost_of_transport = number_field(field(report, "effort"), "cost_of_transport");
  result.state_hash = text_field(report, "state_hash");
  result.recoveries = count_field(report, "recoveries");
  for (const auto& object : field(report, "objects")) {
    result.objects.push_back({text_field(object, "colour"), flag_field(object, "grasped"),
                              flag_field(object, "dropped"), flag_field(object, "in_zone"),
                              number_field(object, "zone_distance_m")});
  }
  for (const auto& colour : field(report, "demanded")) {
    if (colour.is_string()) result.demanded.push_back(colour);
  }
  for (const StateStay& stay : stays_of(report, result.mission_time_s)) {
    if (stay.end_s > stay.begin_s) result.time_in_state_s[stay.state] += stay.end_s - stay.begin_s;
  }
  Recoveries recoveries = recoveries_of(report, result.mission_time_s, limits);
  result.recoveries_by_cause = std::move(recoveries.by_cause);
  result.longest_recovery = std::move(recoveries.longest);
  return result;
}

}  // namespace constrictor::cli
