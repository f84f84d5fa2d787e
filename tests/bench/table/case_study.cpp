// The case study: CPU time and memory of each process against its budget, CPU time by groups of functions, the launch.
#include <fmt/format.h>

#include <algorithm>

#include "bench/table/results.hpp"

namespace constrictor::bench {
namespace {

using nlohmann::json;

/// What a process may need at most. `share` limits its CPU time for a second of simulated time: it is divided by the
/// CPU time of the benchmark that runs the physics by itself, measured in the same run of the benchmarks, so that it
/// does not depend on the speed of the machine. Both limits are 1.3 times values that were measured; README.md has
/// these values, and says how to derive the limits again.
struct Budget {
  double share;
  double pss_mib;  ///< proportional set size: memory that processes share counts in parts
};
const std::map<std::string, Budget> kBudgets = {
    {"physics", {6.4, 30}},    {"camera", {4.9, 71}},    {"perception", {2.35, 23}},
    {"guidance", {1.75, 9.5}}, {"report", {2.8, 115}},   {"navigation", {1.7, 9.5}},
    {"control", {1.65, 9.5}},  {"planner", {1.05, 8.5}}, {"input", {0.7, 8.5}}};
/// Of all processes together: 1.15 times the measured values, because the deviations of the processes partly cancel
/// each other.
constexpr Budget kSumBudget = {20.5, 245};
/// [MiB] the goal for the greatest memory (PSS) of all processes together. It is shown, and it is no limit.
constexpr double kGoal_mib = 150;
/// [s] wall time from the start of the launcher to the first motion.
constexpr double kLaunchLimit_s = 1.0;
/// The benchmark of bench_world with which the budgets were measured: one period of control, 20 ms, in the steps of
/// physics.yaml.
const std::string kReference = "undulate/engine:1/step_us:5000/iterations:50/contacts:2/iterations:430";

/// The column of a process in the table of groups: those of the roster, and the launcher with what it starts.
std::string column_of(const std::string& process) { return kBudgets.contains(process) ? process : "launcher"; }

}  // namespace

void add_case_study(const Results& results, Table& table) {
  const json report = results.file("case_study/report.json");
  if (!report.is_object()) return;
  const auto reference = results.times_ms().find(kReference);
  if (reference == results.times_ms().end()) {
    table.fail("case_study", fmt::format("there are no budgets without the benchmark {}", kReference));
    return;
  }
  const double physics_ms = 50.0 * reference->second;  // for one second of simulated time
  const double simulated_s = report.value("sim_time_s", 1.0);
  table.text += fmt::format(
      "\n## The case study: {:.1f} s simulated in {:.1f} s, {:.1f} times real time\n\nThe physics alone needs "
      "{:.1f} ms for one second of simulated time (`{}`).\n\n| process | CPU ms per simulated s | share of the physics "
      "alone | "
      "budget | greatest PSS, MiB | budget | |\n|---|---|---|---|---|---|---|\n",
      simulated_s, report.value("wall_time_s", 0.0), report.value("real_time_factor", 0.0), physics_ms, kReference);
  double sum_ms = 0.0;
  double sum_mib = 0.0;
  const auto add_row = [&](const std::string& name, double ms, double mib, const Budget* budget) {
    const bool excess = budget && (ms > budget->share * physics_ms || mib > budget->pss_mib);
    table.text += fmt::format("| {} | {:.2f} | {:.2f} | {} | {:.1f} | {} | {} |\n", name, ms, ms / physics_ms,
                              budget ? fmt::format("{}", budget->share) : "", mib,
                              budget ? fmt::format("{}", budget->pss_mib) : "", table.verdict(excess));
    return json{{"cpu_ms_per_s", ms}, {"share", ms / physics_ms}, {"max_pss_mib", mib}, {"excess", excess}};
  };
  for (const json& process : report["processes"]) {
    const std::string name = process["name"];
    const double ms = 1e3 * process.value("cpu_s", 0.0) / simulated_s;
    const double mib = process.value("max_pss_mib", 0.0);
    const auto budget = kBudgets.find(name);
    sum_ms += ms;
    sum_mib += mib;
    table.all["processes"][name] = add_row(name, ms, mib, budget == kBudgets.end() ? nullptr : &budget->second);
  }
  table.all["case_study"] = add_row("all", sum_ms, sum_mib, &kSumBudget);
  table.text += fmt::format("\nThe goal for the memory of all processes together is {} MiB.\n", kGoal_mib);
  table.all["case_study"]["real_time_factor"] = report.value("real_time_factor", 0.0);
  table.all["case_study"]["cpu_ms_per_tick"] = sum_ms * simulated_s / report.value("ticks", 1.0);
}

void add_launch(const Results& results, Table& table) {
  const json launch = results.file("launch.json");
  if (!launch.is_object()) return;
  const double median_s = launch.value("median_s", 0.0);
  const bool excess = median_s > kLaunchLimit_s;
  table.all["launch"] = launch;
  table.all["launch"]["limit_s"] = kLaunchLimit_s;
  table.all["launch"]["excess"] = excess;
  std::string each;
  for (const json& taken : launch["launches_s"])
    each += fmt::format("{}{:.2f}", each.empty() ? "" : ", ", taken.get<double>());
  table.text += fmt::format(
      "\n## Launch to first motion\n\n| wall time of each launch, s | median | at most | load of the machine | "
      "|\n|---|---|---|---|---|\n| {} | {:.2f} | {} | {:.1f} | {} |\n",
      each, median_s, kLaunchLimit_s, launch.value("load", 0.0), table.verdict(excess));
}

void add_function_groups(const Results& results, Table& table) {
  const json profile = results.file("profile.json");
  if (!profile.is_object()) return;
  table.text += "\n## The case study by groups of functions\n\n";
  if (profile.contains("missing")) {
    table.all["function_groups"] = profile;
    table.text += fmt::format("Not measured: {}.\n", profile["missing"].get<std::string>());
    return;
  }
  std::map<std::string, double> groups;
  std::map<std::string, double> columns;
  std::map<std::string, std::map<std::string, double>> cells;  // by group and column
  double all_ms = 0.0;
  for (const auto& [process, counted] : profile["cpu_ms_per_s"].items()) {
    for (const auto& [group, found] : counted.items()) {
      const double ms = found;
      groups[group] += ms;
      columns[column_of(process)] += ms;
      cells[group][column_of(process)] += ms;
      all_ms += ms;
    }
  }
  const auto by_falling_time = [](const std::map<std::string, double>& sums) {
    std::vector<std::pair<std::string, double>> sorted(sums.begin(), sums.end());
    std::ranges::stable_sort(sorted, [](const auto& a, const auto& b) { return a.second > b.second; });
    return sorted;
  };
  table.all["function_groups"] = cells;
  table.text += fmt::format(
      "CPU ms for a second of simulated time, from {} samples of {:.0f} s simulated. Folders are this project's own "
      "code.\n\n| group | all | share |",
      profile.value("samples", 0), profile.value("simulated_s", 0.0));
  std::string rule = "\n|---|---|---|";
  std::string last = fmt::format("| all | {:.1f} | 100 % |", all_ms);
  for (const auto& [column, ms] : by_falling_time(columns)) {
    table.text += fmt::format(" {} |", column);
    rule += "---|";
    last += fmt::format(" {:.1f} |", ms);
  }
  table.text += rule + "\n";
  for (const auto& [group, group_ms] : by_falling_time(groups)) {
    table.text += fmt::format("| {} | {:.1f} | {:.1f} % |", group, group_ms, 100.0 * group_ms / all_ms);
    for (const auto& [column, unused] : by_falling_time(columns))
      table.text +=
          fmt::format(" {} |", cells[group][column] < 0.05 ? "" : fmt::format("{:.1f}", cells[group][column]));
    table.text += "\n";
  }
  table.text += last + "\n";
}

}  // namespace constrictor::bench
