#include "cli/evaluate/summary.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>

namespace constrictor::cli {
namespace {

using nlohmann::ordered_json;

void add_known(Distribution& distribution, double value) {
  if (std::isfinite(value)) distribution.values.push_back(value);
}

ordered_json to_json(const Distribution& distribution) {
  return {{"count", distribution.values.size()}, {"median", distribution.at(0.5)}, {"p05", distribution.at(0.05)},
          {"p25", distribution.at(0.25)},        {"p75", distribution.at(0.75)},   {"p95", distribution.at(0.95)}};
}

/// One field of a CSV file.
std::string csv(const std::string& text) {
  if (text.find_first_of(",\"\r\n") == std::string::npos) return text;
  std::string quoted = "\"";
  for (const char c : text) quoted += c == '"' ? "\"\"" : std::string(1, c);
  return quoted + "\"";
}

std::string csv(double value) { return std::isfinite(value) ? fmt::format("{:.6g}", value) : ""; }

/// 0: the run had no recovery; NaN: the report does not tell it.
double longest_recovery_s(const MissionResult& result) {
  return !result.error() && !result.refused && result.recoveries == 0 ? 0.0 : result.longest_recovery.duration_s;
}

/// "2 follow line: line lost; 1 other"
std::string causes_text(const std::map<std::string, int>& causes) {
  std::string text;
  for (const auto& [cause, count] : causes) text += fmt::format("{}{} {}", text.empty() ? "" : "; ", count, cause);
  return text;
}

ordered_json worst_recovery_json(const VariantSummary& summary) {
  const RecoveryTime& worst = summary.worst_recovery;
  if (!std::isfinite(worst.duration_s)) return nullptr;
  return {{"duration_s", worst.duration_s},
          {"cause", worst.cause},
          {"begin_s", worst.begin_s},
          {"seed", summary.worst_seed},
          {"folder", summary.worst_folder.string()}};
}

void add(VariantSummary& summary, const MissionResult& result) {
  ++summary.runs;
  summary.errors += result.error() ? 1 : 0;
  summary.refused += result.refused ? 1 : 0;
  summary.false_successes += result.believed && !result.success ? 1 : 0;
  summary.unnoticed_successes += result.unnoticed() ? 1 : 0;
  for (std::size_t phase = 0; phase < std::size(kPhases); ++phase)
    summary.reached[phase] += reached(result, phase) ? 1 : 0;
  if (result.error() || result.refused) return;
  for (const auto& object : result.objects) {
    if (object.dropped) add_known(summary.placement_m, object.zone_distance_m);
  }
  if (result.success) add_known(summary.mission_time_s, result.mission_time_s);
  add_known(summary.cross_track_m, result.rms_cross_track_m);
  add_known(summary.pose_error_m, result.rms_pose_error_m);
  add_known(summary.cost_of_transport, result.cost_of_transport);
  add_known(summary.recoveries, result.recoveries);
  for (const auto& [state, time_s] : result.time_in_state_s) summary.mean_time_in_state_s[state] += time_s;
  for (const auto& [cause, count] : result.recoveries_by_cause) summary.recoveries_by_cause[cause] += count;
  add_known(summary.longest_recovery_s, longest_recovery_s(result));
  if (!(result.longest_recovery.duration_s <= summary.worst_recovery.duration_s) &&
      std::isfinite(result.longest_recovery.duration_s)) {
    summary.worst_recovery = result.longest_recovery;
    summary.worst_seed = result.seed;
    summary.worst_folder = result.folder;
  }
}

}  // namespace

std::vector<VariantSummary> summarise(const std::vector<Variant>& variants, const std::vector<MissionResult>& results) {
  std::vector<VariantSummary> summaries(variants.size());
  for (std::size_t i = 0; i < variants.size(); ++i) {
    summaries[i].name = variants[i].name;
    summaries[i].reached.assign(std::size(kPhases), 0);
  }
  for (const auto& result : results) add(summaries.at(result.variant), result);
  for (auto& summary : summaries) {
    const auto missions = static_cast<double>(std::max<std::size_t>(summary.begun() - summary.errors, 1));
    for (auto& [state, time_s] : summary.mean_time_in_state_s) time_s /= missions;
  }
  return summaries;
}

ordered_json to_json(const std::vector<VariantSummary>& summaries) {
  ordered_json list = ordered_json::array();
  for (const auto& summary : summaries) {
    ordered_json phases = ordered_json::object();
    for (std::size_t i = 0; i < std::size(kPhases); ++i) {
      const Interval interval = wilson_interval(summary.reached[i], summary.begun());
      phases[kPhases[i]] = {{"runs", summary.reached[i]}, {"wilson_95", {interval.low, interval.high}}};
    }
    list.push_back({{"variant", summary.name},
                    {"runs", summary.runs},
                    {"errors", summary.errors},
                    {"refused", summary.refused},
                    {"false_successes", summary.false_successes},
                    {"unnoticed_successes", summary.unnoticed_successes},
                    {"phases", phases},
                    {"placement_m", to_json(summary.placement_m)},
                    {"mission_time_s", to_json(summary.mission_time_s)},
                    {"rms_cross_track_m", to_json(summary.cross_track_m)},
                    {"rms_pose_error_m", to_json(summary.pose_error_m)},
                    {"cost_of_transport", to_json(summary.cost_of_transport)},
                    {"recoveries", to_json(summary.recoveries)},
                    {"mean_time_in_state_s", summary.mean_time_in_state_s},
                    {"longest_recovery_s", to_json(summary.longest_recovery_s)},
                    {"longest_recovery", worst_recovery_json(summary)},
                    {"recoveries_by_cause", summary.recoveries_by_cause}});
  }
  return list;
}

std::string to_csv(const std::vector<Variant>& variants, const std::vector<MissionResult>& results) {
  std::set<std::string> states;
  std::size_t objects = 0;
  for (const auto& result : results) {
    objects = std::max(objects, result.objects.size());
    for (const auto& [state, time_s] : result.time_in_state_s) states.insert(state);
  }
  std::string text =
      "variant,seed,exit_status,success,believed,reason,mission_time_s,wall_time_s,recoveries,rms_cross_track_m,"
      "rms_pose_error_m,cost_of_transport,longest_recovery_s,longest_recovery,recoveries_by_cause";
  for (std::size_t i = 1; i <= objects; ++i)
    text += fmt::format(",object_{0},grasped_{0},dropped_{0},in_zone_{0},zone_distance_{0}_m", i);
  for (const auto& state : states) text += "," + csv("time in '" + state + "' [s]");
  text += ",state_hash,folder\r\n";
  for (const auto& result : results) {
    text += fmt::format("{},{},{},{:d},{:d},{},{},{},{},{},{},{},{},{},{}", csv(variants.at(result.variant).name),
                        result.seed, result.exit_status, result.success, result.believed, csv(result.reason),
                        csv(result.mission_time_s), csv(result.wall_time_s), result.recoveries,
                        csv(result.rms_cross_track_m), csv(result.rms_pose_error_m), csv(result.cost_of_transport),
                        csv(longest_recovery_s(result)), csv(result.longest_recovery.cause),
                        csv(causes_text(result.recoveries_by_cause)));
    for (std::size_t i = 0; i < objects; ++i) {
      if (i >= result.objects.size()) {
        text += ",,,,,";
        continue;
      }
      const ObjectResult& object = result.objects[i];
      text += fmt::format(",{},{:d},{:d},{:d},{}", csv(object.colour), object.grasped, object.dropped, object.in_zone,
                          csv(object.zone_distance_m));
    }
    for (const auto& state : states) {
      const auto found = result.time_in_state_s.find(state);
      text += "," + (found == result.time_in_state_s.end() ? std::string() : csv(found->second));
    }
    text += fmt::format(",{},{}\r\n", csv(result.state_hash), csv(result.folder.string()));
  }
  return text;
}

}  // namespace constrictor::cli
