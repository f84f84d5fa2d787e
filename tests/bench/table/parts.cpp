// A tick by part, and the sum of the parts beside the whole; the camera by pass.
#include <fmt/format.h>

#include <algorithm>

#include "bench/table/results.hpp"

namespace constrictor::bench {
namespace {

using nlohmann::json;
using Parts = std::vector<std::pair<std::string, double>>;

/// The parts with their shares of the whole, the largest first, their sum and the whole.
void add_parts(const std::string& name, const std::string& title, Parts parts, double whole_ms, Table& table) {
  std::ranges::sort(parts, [](const auto& a, const auto& b) { return a.second > b.second; });
  table.text += fmt::format("\n{}\n\n| part | ms | share of the whole |\n|---|---|---|\n", title);
  const auto row = [&](const std::string& part, double ms) {
    table.text += fmt::format("| {} | {:.4f} | {:.1f} % |\n", part, ms, 100.0 * ms / whole_ms);
  };
  json& all = table.all["tick"][name];
  double sum_ms = 0.0;
  for (const auto& [part, ms] : parts) {
    row(part, ms);
    all["parts_ms"][part] = ms;
    sum_ms += ms;
  }
  row("sum of the parts", sum_ms);
  row("**whole tick, measured by itself**", whole_ms);
  all["sum_ms"] = sum_ms;
  all["whole_ms"] = whole_ms;
  all["sum_per_whole"] = sum_ms / whole_ms;
}

std::string words(std::string name) {
  std::ranges::replace(name, '_', ' ');
  return name;
}

}  // namespace

void add_tick_parts(const Results& results, Table& table) {
  auto physics = results.group_ms("physics_part");
  const auto plant = results.group_ms("plant_part");
  auto whole = results.group_ms("whole_tick");
  if (!physics.contains("solution") || !physics.contains("factorisation") || !whole.contains("physics") ||
      !whole.contains("plant"))
    return;
  table.text += "\n## A tick by part\n";
  // The factorisation is a part of the solution.
  const double factorisation_ms = physics["factorisation"];
  const double rest_ms = physics["solution"] - factorisation_ms;
  Parts parts = {{"solution: factorisation of the chain's matrix", factorisation_ms},
                 {"solution: forces of contacts and servos, matrix, line search", rest_ms}};
  for (const auto& [name, ms] : physics)
    if (name != "factorisation" && name != "solution") parts.emplace_back(words(name), ms);
  add_parts("physics", "The physics: `World::advance`, 20 ms with 24 modules in the scene of the case study.", parts,
            whole["physics"], table);
  parts = {{"physics (the table above)", whole["physics"]}};
  for (const auto& [name, ms] : plant) parts.emplace_back(words(name), ms);
  add_parts("plant", "The plant in one process: the component `physics`, a gait in place of `control`, the barrier.",
            parts, whole["plant"], table);
  for (const auto& [name, ms] : results.group_ms("process_part")) {
    table.all["tick"]["process_ms"][name] = ms;
    table.text += fmt::format("\nA process of the plant also needs {:.4f} ms for: {}.\n", ms, words(name));
  }
}

void add_camera_passes(const Results& results, Table& table) {
  const auto& times = results.times_ms();
  const auto ms = [&](const char* name) { return times.contains(name) ? times.at(name) : 0.0; };
  if (ms("image") == 0.0 || ms("component_period") == 0.0) return;
  const Parts passes = {{"shadow map", ms("image") - ms("image_without_shadow_map")},
                        {"ground and bodies", ms("image_without_shadow_map") - ms("image_of_the_sky")},
                        {"clearing, set-up and read-back", ms("image_of_the_sky")},
                        {"noise", ms("noise")},
                        {"message, hash, barrier (difference)", ms("component_period") - ms("frame")}};
  table.text += "\n## The camera by pass\n";
  add_parts("camera",
            "One period of the component `camera`, an image of 320 x 240 pixels. Passes are differences of two "
            "benchmarks.",
            passes, ms("component_period"), table);
}

}  // namespace constrictor::bench
