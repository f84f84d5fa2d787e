// The comparisons with other programs: ddsperf, MuJoCo and its renderer.
#include <fmt/format.h>

#include "bench/table/results.hpp"

namespace constrictor::bench {

using nlohmann::json;

/// A round of pings of ddsperf beside a tick of the case study, which exchanges more messages and also computes.
void add_ddsperf(const Results& results, Table& table) {
  const json ddsperf = results.file("ddsperf.json");
  if (!ddsperf.is_object()) return;
  table.all["ddsperf"] = ddsperf;
  table.text += fmt::format(
      "\n## Messages beside ddsperf\n\nA round of ddsperf: one process pings all others, and all answer.\n\n| what | "
      "processes | CPU ms | median of the round trip, ms | PSS of a process, MiB |\n|---|---|---|---|---|\n"
      "| a round of ddsperf | {} | {:.3f} | {:.3f} | {:.1f} |\n",
      ddsperf.value("members", 0), ddsperf.value("cpu_ms_per_round", 0.0),
      1e-3 * ddsperf.value("round_trip_median_us", 0.0), ddsperf.value("pss_mib", 0.0));
  if (table.all.contains("case_study"))
    table.text += fmt::format("| a tick of the case study, with all computations | {} | {:.3f} | | |\n",
                              table.all["processes"].size(), table.all["case_study"]["cpu_ms_per_tick"].get<double>());
}

/// This project's physics and MuJoCo: errors from the converged motion of the same engine, and ticks in a second.
void add_engines(const Results& results, Table& table) {
  const json engines = results.file("engines.json");
  if (!engines.is_object()) return;
  table.all["engines"] = engines;
  table.text += fmt::format(
      "\n## The physics and MuJoCo {}\n\n`constrictor` is `sim/world` with its default engine. Errors are those of "
      "speed and torque, from the converged motion of the same engine.\n\n| motion | engine | error of the speed | "
      "error of the torque | ticks per second | `constrictor` is faster by |\n|---|---|---|---|---|---|\n",
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
      table.text += fmt::format("| {} | {} | {:+.1f} % | {:+.1f} % | {}\n", motion, name,
                                error["speed_percent"].get<double>(), error["torque_percent"].get<double>(), speed);
    }
  }
}

/// An image of a like scene by both renderers, on OSMesa.
void add_renderers(const Results& results, Table& table) {
  if (results.group_ms("renderer").empty()) return;
  table.text +=
      "\n## The renderer and MuJoCo's on OSMesa\n\nAn image of 320 x 240 pixels of a like scene: ground with a "
      "line and a zone, the robot, two objects.\n\n| shadows | `sim/render`, ms | MuJoCo, ms | `sim/render` is faster "
      "by "
      "|\n|---|---|---|---|\n";
  const auto& times = results.times_ms();
  for (const auto& [shadows, what] : {std::pair{1, "yes"}, std::pair{0, "no"}}) {
    const auto own = times.find(fmt::format("renderer/constrictor/shadows:{}", shadows));
    const auto mujoco = times.find(fmt::format("renderer/mujoco/shadows:{}", shadows));
    if (own == times.end() || mujoco == times.end()) continue;
    table.all["renderers"][shadows == 1 ? "with_shadows" : "without_shadows"] = {
        {"constrictor_ms", own->second}, {"mujoco_ms", mujoco->second}, {"ratio", mujoco->second / own->second}};
    table.text += fmt::format("| {} | {:.3f} | {:.3f} | {:.2f} times |\n", what, own->second, mujoco->second,
                              mujoco->second / own->second);
  }
}

}  // namespace constrictor::bench
