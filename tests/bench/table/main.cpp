// bench_table FOLDER: combines the results of the benchmarks in a folder: bench.json and the table bench.md, with what
// exceeds its limit.
#include <fmt/format.h>

#include <filesystem>
#include <fstream>
#include <iostream>

#include "bench/table/results.hpp"

int main(int argc, char** argv) {
  using namespace constrictor::bench;
  if (argc != 2 || !std::filesystem::is_directory(argv[1])) {
    std::cerr << "usage: bench_table FOLDER\nFOLDER: the results that scripts/bench.sh wrote\n";
    return 64;
  }
  const std::filesystem::path folder = argv[1];
  const Results results(folder);
  Table table;
  table.text = "# Benchmarks\n\n## CPU time of one execution\n\n| benchmark | ms |\n|---|---|\n";
  for (const auto& [name, ms] : results.times_ms()) {
    table.all["cpu_ms"][name] = ms;
    table.text += fmt::format("| {} | {:.4g} |\n", name, ms);
  }
  add_tick_parts(results, table);
  add_camera_passes(results, table);
  add_growth(results, table);
  add_case_study(results, table);
  add_function_groups(results, table);
  add_launch(results, table);
  add_ddsperf(results, table);
  add_engines(results, table);
  add_renderers(results, table);
  for (const auto& [name, message] : results.errors()) table.fail(name, message);
  table.all["within_budgets"] = table.within;
  std::ofstream(folder / "bench.json") << table.all.dump(2) << "\n";
  std::ofstream(folder / "bench.md") << table.text;
  std::cout << table.text
            << (table.within ? "\nAll within their limits.\n" : "\nLines with EXCEEDED are above their limits.\n");
  return table.within ? 0 : 1;
}
