// Combines the results of the benchmarks in a folder: bench.json and the table bench.md, with CPU time and memory of
// each process against its budget, exponents of growth, and the comparisons with ddsperf and MuJoCo.
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

/// What a process may need at most. `share` limits its CPU time for a second of simulated time: it is divided by the
/// CPU time of the benchmark that runs the physics by itself, measured in the same run of the benchmarks, so that it
/// does not depend on the speed of the machine. Both limits are 1.3 times the measured values; README.md says how to
/// derive them again.
struct Budget {
  double share;
  double pss_mib;  ///< proportional set size: memory that processes share counts in parts
};
const std::map<std::string, Budget> kBudgets = {
    {"physics", {6.0, 30}},   {"camera", {4.0, 83}},   {"perception", {2.45, 23}},
    {"guidance", {1.5, 9.5}}, {"report", {2.8, 115}},  {"navigation", {1.35, 9.5}},
    {"control", {1.3, 9.5}},  {"planner", {0.9, 8.5}}, {"input", {0.6, 8.5}}};
/// Greatest exponent of growth. An iteration of the physics is linear in the modules; their iterations are not
/// constant.
const std::map<std::string, double> kExponents = {
    {"modules", 1.45}, {"members", 1.1}, {"objects", 1.1}, {"columns", 2.1}};
/// The benchmark of bench_world with which the budgets were measured: one period of control, 20 ms, in steps of 4 ms.
const std::string kReference = "undulate/engine:1/step_us:4000/iterations:50/contacts:2/iterations:430";

json parsed(const fs::path& file) {
  std::ifstream stream(file);
  return json::parse(stream, nullptr, false);
}

std::vector<json> results_of(const fs::path& file) {
  const json found = parsed(file);
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

/// The parts of the table append their text to it and their numbers to `all`. They return whether all is within limits.
bool add_growth(const std::map<std::string, double>& times, json& all, std::string& text) {
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
  return within;
}

bool add_case_study(const json& report, double reference_ms, json& all, std::string& text) {
  bool within = true;
  const double physics_ms = 50.0 * reference_ms;  // for one second of simulated time
  const double simulated_s = report.value("sim_time_s", 1.0);
  text += fmt::format(
      "\n## The case study: {:.1f} s simulated in {:.1f} s, {:.1f} times real time\n\nThe physics alone needs {:.1f} "
      "ms "
      "for one second of simulated time (`{}`).\n\n| process | CPU ms per simulated s | share of the physics alone | "
      "budget | greatest PSS, MiB | budget | |\n|---|---|---|---|---|---|---|\n",
      simulated_s, report.value("wall_time_s", 0.0), report.value("real_time_factor", 0.0), physics_ms, kReference);
  double sum_ms = 0.0, sum_mib = 0.0;
  for (const json& process : report["processes"]) {
    const std::string name = process["name"];
    const double ms = 1e3 * process.value("cpu_s", 0.0) / simulated_s;
    const double mib = process.value("max_pss_mib", 0.0);
    const auto budget = kBudgets.find(name);
    const bool known = budget != kBudgets.end();
    const bool excess = known && (ms > budget->second.share * physics_ms || mib > budget->second.pss_mib);
    within &= !excess;
    sum_ms += ms;
    sum_mib += mib;
    all["processes"][name] = {
        {"cpu_ms_per_s", ms}, {"share", ms / physics_ms}, {"max_pss_mib", mib}, {"excess", excess}};
    text += fmt::format("| {} | {:.2f} | {:.2f} | {} | {:.1f} | {} | {} |\n", name, ms, ms / physics_ms,
                        known ? fmt::format("{}", budget->second.share) : "", mib,
                        known ? fmt::format("{}", budget->second.pss_mib) : "", excess ? "EXCEEDED" : "");
  }
  text += fmt::format("| all | {:.2f} | {:.2f} | | {:.1f} | | |\n", sum_ms, sum_ms / physics_ms, sum_mib);
  all["case_study"] = {{"real_time_factor", report.value("real_time_factor", 0.0)},
                       {"cpu_ms_per_s", sum_ms},
                       {"cpu_ms_per_tick", sum_ms * simulated_s / report.value("ticks", 1.0)}};
  return within;
}

/// A round of pings of ddsperf beside a tick of the case study, which exchanges more messages and also computes.
void add_ddsperf(const json& ddsperf, json& all, std::string& text) {
  all["ddsperf"] = ddsperf;
  text += fmt::format(
      "\n## Messages beside ddsperf\n\nA round of ddsperf: one process pings all others, and all answer.\n\n| what | "
      "processes | CPU ms | median of the round trip, ms | PSS of a process, MiB |\n|---|---|---|---|---|\n| a round "
      "of "
      "ddsperf | {} | {:.3f} | {:.3f} | {:.1f} |\n",
      ddsperf.value("members", 0), ddsperf.value("cpu_ms_per_round", 0.0),
      1e-3 * ddsperf.value("round_trip_median_us", 0.0), ddsperf.value("pss_mib", 0.0));
  if (all.contains("case_study"))
    text += fmt::format("| a tick of the case study, with all computations | {} | {:.3f} | | |\n",
                        all["processes"].size(), all["case_study"]["cpu_ms_per_tick"].get<double>());
}

/// This project's physics and MuJoCo: errors from the converged motion of the same engine, and ticks in a second.
void add_engines(const json& engines, json& all, std::string& text) {
  all["engines"] = engines;
  text += fmt::format(
      "\n## The physics and MuJoCo {}\n\n`constrictor` is `sim/world` with its default engine. Errors are those of "
      "speed "
      "and torque, from the converged motion of the same engine.\n\n| motion | engine | error of the speed | error of "
      "the torque | ticks per second | `constrictor` is faster by |\n|---|---|---|---|---|---|\n",
      engines.value("mujoco_version", ""));
  for (const char* motion : {"empty", "loaded"}) {
    if (!engines.contains(motion)) continue;
    for (const auto& [name, engine] : engines[motion].items()) {
      const json& error = engine["production_from_converged"];
      std::string speed = "| |";
      if (engine.contains("race")) {
        const json& race = engine["race"];
        speed = fmt::format(
            "{:.0f} (`constrictor` in turn: {:.0f}) | {:.2f} times |", race["ticks_per_s"]["mujoco"].get<double>(),
            race["ticks_per_s"]["constrictor"].get<double>(), race["constrictor_per_mujoco"]["median"].get<double>());
      }
      text += fmt::format("| {} | {} | {:+.1f} % | {:+.1f} % | {}\n", motion, name,
                          error["speed_percent"].get<double>(), error["torque_percent"].get<double>(), speed);
    }
  }
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

  bool within = add_growth(times, all, text);
  const json report = parsed(folder / "case_study" / "report.json");
  const auto reference = times.find(kReference);
  if (report.is_object() && reference != times.end()) within &= add_case_study(report, reference->second, all, text);
  if (const json ddsperf = parsed(folder / "ddsperf.json"); ddsperf.is_object()) add_ddsperf(ddsperf, all, text);
  if (const json engines = parsed(folder / "engines.json"); engines.is_object()) add_engines(engines, all, text);
  all["within_budgets"] = within;
  std::ofstream(folder / "bench.json") << all.dump(2) << "\n";
  std::ofstream(folder / "bench.md") << text;
  std::cout << text << (within ? "\nAll within their budgets.\n" : "\nLines with EXCEEDED are above their budgets.\n");
  return within ? 0 : 1;
}
