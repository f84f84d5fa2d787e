#include "cli/evaluate/mission_result.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <fstream>
#include <regex>

namespace constrictor::cli {
namespace {

using nlohmann::json;

const json& field(const json& object, const char* key) {
  static const json kNothing;
  if (!object.is_object()) return kNothing;
  const auto found = object.find(key);
  return found == object.end() ? kNothing : *found;
}

double number_of(const json& object, const char* key) {
  const json& value = field(object, key);
  return value.is_number() ? value.get<double>() : kUnknown;
}

bool flag_of(const json& object, const char* key) {
  const json& value = field(object, key);
  return value.is_boolean() && value.get<bool>();
}

std::string text_of(const json& object, const char* key) {
  const json& value = field(object, key);
  return value.is_string() ? value.get<std::string>() : std::string();
}

std::map<std::string, double> times(const json& states, double end_s) {
  std::map<std::string, double> sums;
  if (!states.is_array()) return sums;
  for (std::size_t i = 0; i < states.size(); ++i) {
    const double begin_s = number_of(states[i], "sim_time_s");
    const double until_s = i + 1 < states.size() ? number_of(states[i + 1], "sim_time_s") : end_s;
    if (until_s > begin_s) sums[text_of(states[i], "state")] += until_s - begin_s;
  }
  return sums;
}

}  // namespace

bool reached(const MissionResult& result, std::size_t phase) {
  const auto all = [&](auto&& holds) {
    return !result.objects.empty() && std::all_of(result.objects.begin(), result.objects.end(), holds);
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

std::string trouble_of(const json& event) {
  const std::string name = text_of(event, "event");
  const bool lost = name.ends_with("_lost") || name == "timeout";
  if (!lost && name != "goal_aborted" && name != "goal_refused") return {};
  static const std::regex kNumber("-?[0-9]+(\\.[0-9]+)?");
  const std::string detail = text_of(field(event, "parameters"), "detail");
  const std::string cause = detail.empty() || lost ? name : std::regex_replace(detail, kNumber, "#");
  return text_of(event, "task") + ": " + cause;
}

MissionResult read_result(const std::filesystem::path& folder, int exit_status) {
  MissionResult result;
  result.exit_status = exit_status;
  std::ifstream stream(folder / "report.json");
  const json report = stream ? json::parse(stream, nullptr, false) : json();
  if (!report.is_object()) {
    result.reason = fmt::format("no report; `constrictor run` ended with status {}", exit_status);
    return result;
  }
  result.success = flag_of(report, "success");
  result.believed = text_of(report, "believed") == "succeeded";
  result.reason = text_of(report, "reason");
  const double run_s = number_of(report, "sim_time_s"), mission_s = number_of(report, "mission_time_s");
  result.mission_time_s = std::isfinite(mission_s) ? mission_s : run_s;
  result.wall_time_s = number_of(report, "wall_time_s");
  result.rms_cross_track_m = number_of(field(report, "line"), "rms_cross_track_m");
  result.rms_pose_error_m = number_of(field(report, "pose_error"), "rms_m");
  result.cost_of_transport = number_of(field(report, "effort"), "cost_of_transport");
  result.state_hash = text_of(report, "state_hash");
  const double recoveries = number_of(report, "recoveries");
  result.recoveries = recoveries >= 0 && recoveries < 1e6 ? static_cast<int>(recoveries) : 0;
  for (const auto& object : field(report, "objects")) {
    result.objects.push_back({text_of(object, "colour"), flag_of(object, "grasped"), flag_of(object, "dropped"),
                              flag_of(object, "in_zone"), number_of(object, "zone_distance_m")});
  }
  result.time_in_state_s = times(field(report, "states"), result.mission_time_s);
  for (const auto& event : field(report, "events")) {
    if (const std::string trouble = trouble_of(event); !trouble.empty()) ++result.troubles[trouble];
  }
  return result;
}

}  // namespace constrictor::cli
