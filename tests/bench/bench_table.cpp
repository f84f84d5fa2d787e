// Combines the results of the benchmarks in a folder: bench.json and the table bench.md, with the CPU time of each
// process against its budget, and exponents of growth.
#include <fmt/format.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <map>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace {

namespace fs = std::filesystem;
using nlohmann::json;

/// Greatest CPU time of each process for a second of simulated time, as a share of the CPU time that the physics alone
/// needs for it in the same run of the benchmarks. A share does not depend on the speed of the machine.
const std::map<std::string, double> kBudgets = {{"physics", 2.0},  {"camera", 0.8},  {"perception", 0.45},
                                                {"guidance", 0.3}, {"report", 0.5},  {"navigation", 0.3},
                                                {"control", 0.3},  {"planner", 0.2}, {"input", 0.12}};
/// Greatest exponent of growth.
const std::map<std::string, double> kExponents = {
    {"modules", 1.2}, {"members", 1.1}, {"objects", 1.1}, {"columns", 2.1}};
/// The benchmark of bench_world with the default settings: one period of control, 20 ms.
const std::string kReference = "undulate/engine:1/step_us:4000/iterations:50/contacts:2/iterations:430";

std::vector<json> results_of(const fs::path& file) {
  std::ifstream stream(file);
  const json found = json::parse(stream, nullptr, false);
  return found.is_object() ? found.value("benchmarks", std::vector<json>{}) : std::vector<json>{};
}

/// Slope of the least-squares line through (log x, log y).
double exponent_of(const std::vector<std::pair<double, double>>& points) {
  double sx = 0, sy = 0, sxx = 0, sxy = 0;
  for (const auto& [x, y] : points) {
    sx += std::log(x);
    sy += std::log(y);
    sxx += std::log(x) * std::log(x);
    sxy += std::log(x) * std::log(y);
  }
  const double n = static_cast<double>(points.size());
  return (n * sxy - sx * sy) / (n * sxx - sx * sx);
}

/// Every result in milliseconds of CPU time by name.
std::map<std::string, double> times_ms(const fs::path& folder) {
  std::map<std::string, double> times;
  for (const auto& entry : fs::directory_iterator(folder)) {
    if (entry.path().extension() != ".json" || entry.path().filename() == "bench.json") continue;
    for (const json& result : results_of(entry.path())) {
      if (result.value("run_type", "") != "iteration") continue;
      const std::string unit = result.value("time_unit", "ms");
      const double scale = unit == "ns" ? 1e-6 : unit == "us" ? 1e-3 : 1.0;
      times[result.value("name", "")] = scale * result.value("cpu_time", 0.0);
    }
  }
  return times;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 2 || !fs::is_directory(argv[1])) {
    std::cerr << "usage: bench_table FOLDER\nFOLDER: the results that scripts/bench.sh wrote\n";
    return 64;
  }
  const fs::path folder = argv[1];
  const auto times = times_ms(folder);
  json all;
  std::string text = "# Benchmarks\n\n## CPU time of one execution\n\n| benchmark | ms |\n|---|---|\n";
  for (const auto& [name, ms] : times) {
    all["cpu_ms"][name] = ms;
    text += fmt::format("| {} | {:.4g} |\n", name, ms);
  }

  std::map<std::string, std::vector<std::pair<double, double>>> growth;
  for (const auto& [name, ms] : times) {
    const auto slash = name.find('/');
    if (slash == std::string::npos || !kExponents.contains(name.substr(0, slash))) continue;
    growth[name.substr(0, slash)].emplace_back(std::stod(name.substr(slash + 1)), ms);
  }
  bool within = true;
  text += "\n## Growth of the cost: time ~ size ^ exponent\n\n| size | exponent | at most | |\n|---|---|---|---|\n";
  for (const auto& [name, points] : growth) {
    const double exponent = exponent_of(points), limit = kExponents.at(name);
    within &= exponent <= limit;
    all["growth"][name] = {{"exponent", exponent}, {"limit", limit}};
    text += fmt::format("| {} | {:.2f} | {} | {} |\n", name, exponent, limit, exponent <= limit ? "" : "EXCEEDED");
  }

  std::ifstream report_file(folder / "case_study" / "report.json");
  const json report = json::parse(report_file, nullptr, false);
  const auto reference = times.find(kReference);
  if (report.is_object() && reference != times.end()) {
    const double physics_ms = 50.0 * reference->second;  // for one second of simulated time
    const double simulated_s = report.value("sim_time_s", 1.0);
    text += fmt::format(
        "\n## The case study: {:.1f} s simulated in {:.1f} s, {:.1f} times real time\n\nThe physics alone needs {:.1f} "
        "ms for one second of simulated time (`{}`).\n\n| process | CPU ms per simulated s | share of the physics "
        "alone "
        "| budget | |\n|---|---|---|---|---|\n",
        simulated_s, report.value("wall_time_s", 0.0), report.value("real_time_factor", 0.0), physics_ms, kReference);
    double sum_ms = 0.0;
    for (const json& process : report["processes"]) {
      const std::string name = process["name"];
      const double ms = 1e3 * process.value("cpu_s", 0.0) / simulated_s;
      const auto budget = kBudgets.find(name);
      const bool excess = budget != kBudgets.end() && ms > budget->second * physics_ms;
      within &= !excess;
      sum_ms += ms;
      all["processes"][name] = {{"cpu_ms_per_s", ms}, {"share", ms / physics_ms}, {"excess", excess}};
      text += fmt::format("| {} | {:.2f} | {:.2f} | {} | {} |\n", name, ms, ms / physics_ms,
                          budget == kBudgets.end() ? "" : fmt::format("{}", budget->second), excess ? "EXCEEDED" : "");
    }
    text += fmt::format("| all | {:.2f} | {:.2f} | | |\n", sum_ms, sum_ms / physics_ms);
    all["case_study"] = {{"real_time_factor", report.value("real_time_factor", 0.0)}, {"cpu_ms_per_s", sum_ms}};
  }
  std::ifstream engines_file(folder / "engines.json");
  const json engines = json::parse(engines_file, nullptr, false);
  if (!engines.is_discarded()) all["engines"] = engines;
  all["within_budgets"] = within;
  std::ofstream(folder / "bench.json") << all.dump(2) << "\n";
  std::ofstream(folder / "bench.md") << text;
  std::cout << text << (within ? "\nAll within their budgets.\n" : "\nLines with EXCEEDED are above their budgets.\n");
  return within ? 0 : 1;
}
