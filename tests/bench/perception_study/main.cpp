// Lists the factors of the perception study for the script, and draws the curves of its evaluations.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <filesystem>

#include "bench/perception_study/plot.hpp"
#include "configuration/whole_file.hpp"

namespace constrictor::perception_study {
namespace {

namespace fs = std::filesystem;

/// A line for each factor: its name, the number of its levels, and its settings, separated by tabs.
void list(const std::vector<Factor>& factors) {
  for (const auto& factor : factors)
    fmt::print("{}\t{}\t{}\n", factor.name, factor.levels.size(), fmt::join(factor.settings, "\t"));
}

void draw_all(const std::vector<Factor>& factors, const fs::path& folder, const std::string& title) {
  std::vector<std::vector<LevelResult>> results;
  for (const auto& factor : factors) results.push_back(read_results(folder, factor));
  write_whole(folder / "study.csv", to_csv(factors, results));
  write_whole(folder / "study.md", to_markdown(factors, results));
  write_whole(folder / "study.png", draw(figure::Format::kPng, title, factors, results));
  write_whole(folder / "study.svg", draw(figure::Format::kSvg, title, factors, results));
}

}  // namespace
}  // namespace constrictor::perception_study

int main(int argc, char** argv) {
  CLI::App app("list the factors of the perception study, or draw the curves of its evaluations");
  std::string factors, draw, title = "Missions with worse and worse perception";
  bool list = false;
  app.add_option("--factors", factors, "table of the factors")->required()->check(CLI::ExistingFile);
  app.add_flag("--list", list, "print name, number of levels and settings of each factor");
  app.add_option("--draw", draw, "folder of the evaluations; study.png, .svg, .csv and .md are written there")
      ->check(CLI::ExistingDirectory);
  app.add_option("--title", title, "heading of the picture");
  CLI11_PARSE(app, argc, argv);
  try {
    const auto all = constrictor::perception_study::read_factors(factors);
    if (list) constrictor::perception_study::list(all);
    if (!draw.empty()) constrictor::perception_study::draw_all(all, draw, title);
    return 0;
  } catch (const std::exception& error) {
    fmt::print(stderr, "perception_study: {}\n", error.what());
    return 1;
  }
}
