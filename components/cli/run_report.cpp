#include "cli/run_report.hpp"

#include <fstream>
#include <nlohmann/json.hpp>
#include <stdexcept>

#include "constrictor/json.hpp"

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

}  // namespace

bool write_report(const std::filesystem::path& report_dir, const RunOutcome& outcome, const RunView& view,
                  const std::vector<ProcessRecord>& processes) {
  std::ifstream mission_file(report_dir / "mission.json");
  Json report = Json::parse(mission_file, nullptr, false);
  if (!report.is_object()) report = Json::object();
  const bool success = outcome.error.empty() && report.value("success", false);

  // The keys every report has, in this order; those of the mission are null if nobody reported on it.
  Json ordered = Json::object();
  ordered["success"] = success;
  ordered["seed"] = report.value("seed", outcome.seed);  // a reset may have changed it
  ordered["scenario"] = outcome.scenario;
  const double sim_time_s = report.value("sim_time_s", view.sim_time_s());
  ordered["sim_time_s"] = sim_time_s;
  ordered["wall_time_s"] = outcome.wall_time_s;
  ordered["real_time_factor"] = outcome.wall_time_s > 0 ? sim_time_s / outcome.wall_time_s : 0.0;
  ordered["ticks"] = report.value("ticks", view.tick + 1);
  for (const char* key : {"state_hash", "objects", "line", "pose_error", "events", "states", "parameters"}) {
    ordered[key] = report.contains(key) ? report[key] : Json(nullptr);
  }
  Json list = Json::array();
  for (const auto& process : processes) {
    list.push_back({{"name", process.name},
                    {"cpu_s", process.cpu_s},
                    {"max_pss_mib", process.max_pss_mib},
                    {"restarts", process.restarts},
                    {"overruns", sum_over(process.components, view.overruns)},
                    {"refused", sum_over(process.components, view.refused)}});
  }
  ordered["processes"] = std::move(list);
  if (!outcome.error.empty()) ordered["error"] = outcome.error;
  for (const auto& [key, value] : report.items()) {
    if (!ordered.contains(key)) ordered[key] = value;
  }
  std::ofstream file(report_dir / "report.json");
  file << json_text(ordered, 1) << "\n";
  if (!file.flush()) throw std::runtime_error("cannot write " + (report_dir / "report.json").string());
  return success;
}

}  // namespace constrictor::cli
