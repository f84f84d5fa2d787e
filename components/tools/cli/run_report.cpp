#include "cli/run_report.hpp"

#include <fmt/format.h>

#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>
#include <system_error>

#include "configuration/whole_file.hpp"
#include "constrictor/json.hpp"
#include "constrictor/text.hpp"

namespace constrictor::cli {
namespace {

using Json = nlohmann::ordered_json;

std::uint64_t sum_over(const std::vector<std::string>& components, const std::map<std::string, std::uint64_t>& counts) {
  std::uint64_t sum = 0;
  for (const auto& component : components) {
    const auto found = counts.find(component);
    if (found != counts.end()) sum += found->second;
  }
  return sum;
}

/// [us] of these components; null: none of them has measured it.
Json largest_jitter(const std::vector<std::string>& components, const RunView& view) {
  Json largest = nullptr;
  for (const auto& component : components) {
    const auto found = view.components.find(component);
    if (found == view.components.end() || !std::isfinite(found->second.jitter_max_us)) continue;
    if (largest.is_null() || largest < found->second.jitter_max_us) largest = found->second.jitter_max_us;
  }
  return largest;
}

/// The scheduling of a process with these components; null: the process has sent no status.
Json scheduling_of(const std::vector<std::string>& components, const RunView& view) {
  for (const auto& component : components) {
    const auto found = view.components.find(component);
    if (found != view.components.end()) return std::string(text_of(found->second.scheduling));
  }
  return nullptr;
}

/// The files that the report component could not write, for people; empty: none.
std::string unwritten_files(const Json& mission) {
  const Json reasons = mission.value("files_not_written", Json::array());
  if (!reasons.is_array() || reasons.empty() || !reasons.front().is_string()) return {};
  const std::string more = reasons.size() > 1 ? fmt::format("; {} more", reasons.size() - 1) : "";
  return "files are missing in the report: " + reasons.front().get<std::string>() + more;
}

RunVerdict judge(const RunOutcome& outcome, const RunView& view, const Json& mission) {
  RunVerdict verdict;
  verdict.success = outcome.error.empty() && mission.value("success", false);
  verdict.sim_time_s = mission.value("sim_time_s", view.sim_time_s());
  if (verdict.success) return verdict;
  for (const std::string& reason : {outcome.error, mission.value("reason", std::string()), outcome.end_reason}) {
    if (verdict.reason.empty()) verdict.reason = reason;
  }
  if (verdict.reason.empty())
    verdict.reason = mission.empty() ? "no report component judged the mission" : "the report component gave no reason";
  return verdict;
}

}  // namespace

RunVerdict write_report(const std::filesystem::path& report_dir, const RunOutcome& outcome, const RunView& view,
                        const std::vector<ProcessRecord>& processes, const nlohmann::ordered_json& hosts) {
  std::ifstream mission_file(report_dir / "mission.json");
  Json mission = Json::parse(mission_file, nullptr, false);
  if (!mission.is_object()) mission = Json::object();
  RunVerdict verdict = judge(outcome, view, mission);
  std::ifstream truth_file(report_dir / "truth.json");
  const Json truth = Json::parse(truth_file, nullptr, false);

  // Every report has these keys, in this order; those of the mission are null if no report component took part.
  Json report = Json::object();
  report["success"] = verdict.success;
  report["reason"] = verdict.reason;
  report["seed"] = mission.value("seed", outcome.seed);  // a reset may have changed the seed
  report["scenario"] = outcome.scenario;
  report["sim_time_s"] = verdict.sim_time_s;
  report["wall_time_s"] = outcome.wall_time_s;
  report["real_time_factor"] = outcome.wall_time_s > 0 ? verdict.sim_time_s / outcome.wall_time_s : 0.0;
  report["ticks"] = mission.value("ticks", view.tick + 1);
  for (const char* key : {"state_hash", "objects", "line", "pose_error", "events", "states", "parameters"}) {
    report[key] = mission.contains(key) ? mission[key] : Json(nullptr);
  }
  Json list = Json::array();
  for (const auto& process : processes) {
    list.push_back({{"name", process.name},
                    {"host", process.host.empty() ? "here" : process.host},
                    {"cpu_s", process.cpu_s},
                    {"max_pss_mib", process.max_pss_mib},
                    {"restarts", process.restarts},
                    {"overruns", sum_over(process.components, view.overruns)},
                    {"jitter_max_us", largest_jitter(process.components, view)},
                    {"scheduling", scheduling_of(process.components, view)},
                    {"refused", sum_over(process.components, view.refused)}});
  }
  report["processes"] = std::move(list);
  // The description of each member: a result can be repeated with the same releases, files and numeric profile.
  report["members"] = Json::array();
  for (const auto& [name, hello] : view.hellos) {
    report["members"].push_back({{"name", name},
                                 {"host", hello.host},
                                 {"incarnation", hello.incarnation},
                                 {"release", hello.version},
                                 {"idl_hash", hello.idl_hash},
                                 {"config_hash", hello.config_hash},
                                 {"component_hash", hello.component_hash},
                                 {"numeric_profile", hello.numeric_profile}});
  }
  if (truth.is_object()) {
    report["truth"] = truth;
    const std::string reason = truth.value("reason", std::string());
    verdict.notices.push_back(truth.value("success", false)
                                  ? "in the emulated world, the mission has succeeded"
                                  : "in the emulated world, the mission has not succeeded: " + reason);
  }
  if (!hosts.is_null()) report["hosts"] = hosts;
  if (!outcome.recording.is_null()) report["recording"] = outcome.recording;
  if (!outcome.error.empty()) report["error"] = outcome.error;
  for (const auto& [key, value] : mission.items()) {
    if (!report.contains(key)) report[key] = value;
  }
  // The verdict must be heard also if the disk is full.
  if (const std::string files = unwritten_files(mission); !files.empty()) verdict.notices.push_back(files);
  if (const Json why = mission.value("figure_error", Json()); why.is_string())
    verdict.notices.push_back("the figure is missing or incomplete: " + why.get<std::string>());
  try {
    write_whole(report_dir / "report.json", json_text(report, 1) + "\n");
  } catch (const std::system_error& error) {
    verdict.notices.push_back(std::string("there is no report: ") + error.what());
  }
  return verdict;
}

}  // namespace constrictor::cli
