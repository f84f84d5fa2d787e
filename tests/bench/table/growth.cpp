// How the cost grows with the size of the task: exponents fitted to times, and to the wake-ups of processes.
#include <fmt/format.h>

#include <cmath>
#include <utility>

#include "bench/table/results.hpp"

namespace constrictor::bench {
namespace {

using Points = std::vector<std::pair<double, double>>;

/// What grows with which size, and the greatest exponent. An iteration of the physics is linear in the modules; their
/// iterations are not constant. The messages of processes are linear in the members; the CPU time of a message is not
/// constant, because caches forget a process while the others run.
struct Growth {
  const char* group;  ///< of the benchmarks' names
  const char* what;
  double limit;
};
constexpr Growth kGrowths[] = {{"modules", "a tick of the physics, with modules", 1.45},
                               {"objects", "a tick of the physics, with objects", 1.1},
                               {"members", "a tick of the barrier, with members in one process", 1.1},
                               {"processes", "the same, each member in a process of its own", 1.6},
                               {"columns", "an image, with columns", 2.1}};
constexpr double kWakeUpsLimit = 1.2;

/// Slope of the least-squares line through (log x, log y).
double exponent_of(const Points& points) {
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

void add_row(const std::string& name, const std::string& what, const std::string& unit, const Points& points,
             double limit, Table& table) {
  if (points.size() < 2) return;
  const double exponent = exponent_of(points);
  std::string measured;
  for (const auto& [size, value] : points)
    measured += fmt::format("{}{:.0f}: {:.3g}", measured.empty() ? "" : ", ", size, value);
  table.all["growth"][name] = {{"exponent", exponent}, {"limit", limit}, {"points", points}};
  table.text += fmt::format("| {} | {} {} | {:.2f} | {} | {} |\n", what, measured, unit, exponent, limit,
                            table.verdict(exponent > limit));
}

}  // namespace

void add_growth(const Results& results, Table& table) {
  table.text +=
      "\n## Growth of the cost: time ~ size ^ exponent\n\n| what | size: cost | exponent | at most | "
      "|\n|---|---|---|---|---|\n";
  for (const Growth& growth : kGrowths) {
    std::map<double, double> by_size;
    for (const auto& [size, ms] : results.group_ms(growth.group)) by_size[std::stod(size)] = ms;
    add_row(growth.group, growth.what, "ms", {by_size.begin(), by_size.end()}, growth.limit, table);
  }
  Points wake_ups;
  for (const nlohmann::json& result : results.benchmarks("members.json"))
    wake_ups.emplace_back(result["members"], result["wake_ups_per_tick"]);
  add_row("wake_ups", "switches of threads in a tick, with members in processes of their own", "", wake_ups,
          kWakeUpsLimit, table);
}

}  // namespace constrictor::bench
