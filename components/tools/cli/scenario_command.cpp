#include "cli/scenario_command.hpp"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <filesystem>
#include <memory>

#include "cli/launch_plan.hpp"
#include "cli/standard_output.hpp"
#include "cli/subcommands.hpp"
#include "cli/usage.hpp"
#include "configuration/configuration.hpp"
#include "configuration/whole_file.hpp"
#include "runtime/host.hpp"
#include "runtime/version.hpp"
#include "sim/scenario_loader/scenario_file.hpp"
#include "sim/scenario_loader/scenario_writer.hpp"

namespace constrictor::cli {
namespace {

namespace fs = std::filesystem;

struct ScenarioOptions {
  std::string scenario;    ///< show: name or file
  std::string difficulty;  ///< random: one of kDifficulties
  std::uint64_t seed = 1;
  fs::path output;  ///< empty: standard output
  bool force = false;
};

void check_output(const ScenarioOptions& options) {
  const fs::path& file = options.output;
  if (file.empty()) return;
  const auto refuse = [](const std::string& found, const char* accepted) {
    throw UsageError(fmt::format("--output: found {}, accepted {}", found, accepted));
  };
  const fs::path folder = file.has_parent_path() ? file.parent_path() : fs::path(".");
  if (!fs::is_directory(folder))
    refuse(file.string() + " in a folder that does not exist", "a file in an existing one");
  if (!fs::exists(file)) return;
  if (!fs::is_regular_file(file)) refuse(file.string() + ", which is no regular file", "a new file");
  if (!options.force) refuse(file.string() + ", which exists", "a new file (or --force)");
}

/// The name of the scene: that of the scenario with the seed, if this is short enough.
std::string name_of_draw(const std::string& scenario, std::uint64_t seed) {
  constexpr std::size_t kMostLetters = 63;
  const std::string name = fmt::format("{}_{}", scenario, seed);
  return name.size() <= kMostLetters ? name : scenario;
}

/// `command`: what draws this scene again.
int write_draw(const ScenarioOptions& options, const std::string& scenario, const std::string& command) {
  check_output(options);
  Configuration root = Configuration::load(find_file(scenario, kScenarios));
  Scenario scene = read_scenario(root, options.seed);
  const std::string comment = fmt::format(
      "The scene of {0} with seed {1}, drawn by Constrictor {2}. To draw it again:\n"
      "  {3} --seed {1}\n"
      "The file has no variation: the seed of a run changes only the noise of the sensors.",
      scene.name, options.seed, kVersion, command);
  scene.name = name_of_draw(scene.name, options.seed);
  const std::string text = scenario_text(scene, root.one_line("mission"), comment);
  if (!options.output.empty()) {
    write_whole(options.output, text);
    fmt::print("wrote {}\n", options.output.string());
    return exit_status::kOk;
  }
  write_standard_output(text);
  return exit_status::kOk;
}

int draw_random(const ScenarioOptions& options) {
  return write_draw(options, "random_" + options.difficulty,
                    "constrictor scenario random --difficulty " + options.difficulty);
}

int show(const ScenarioOptions& options) {
  return write_draw(options, options.scenario, "constrictor scenario show " + options.scenario);
}

void add_common_options(CLI::App& app, ScenarioOptions& options) {
  app.add_option("--seed", options.seed, "seed that draws the scene, like that of `constrictor run`")
      ->capture_default_str()
      ->check(whole_number());
  app.add_option("--output", options.output, "scenario file to write (YAML; default: standard output)");
  app.add_flag("--force", options.force, "replace the file if it exists");
}

std::string footer_of(const std::string& about, std::initializer_list<const char*> examples) {
  return help_footer(
      about, examples,
      "0 done; 64 wrong usage, or the file exists; 70 the file cannot be written, or a full disk; 78 no such\n"
      "  scenario, a wrong scenario file, or no possible scene",
      kDataEnvironment);
}

}  // namespace

void add_scenario(CLI::App& app, Action& action) {
  auto* scenario = add_group(app, "scenario", "write the scene that a seed draws as a scenario file");
  auto random = std::make_shared<ScenarioOptions>();
  auto* sub = add_subcommand(*scenario, "random", "draw a random scene in which the mission is possible", action,
                             random, draw_random);
  sub->add_option("--difficulty", random->difficulty, "easy, middle or hard")->required()->check(one_of(kDifficulties));
  add_common_options(*sub, *random);
  sub->footer(footer_of(
      "The scene is that of `constrictor run random_DIFFICULTY --seed N`: line, objects, zones, pegs and start. The\n"
      "file has all of them, so that it can be looked at, changed and kept; `constrictor check FILE` checks it after\n"
      "a change.\n"
      "easy: one object, gentle bends. middle: two objects, pegs beside the line. hard: two objects of very different\n"
      "sizes, small zones, sharp bends, pegs, and objects that do not belong to the mission. Other ranges: copy one "
      "of\n"
      "the files random_*.yaml (constrictor list scenarios), change it, and give it to `constrictor scenario show`.",
      {"constrictor scenario random --difficulty middle --seed 7",
       "constrictor scenario random --difficulty hard --seed 7 --output mine.yaml && constrictor check mine.yaml"}));

  auto shown = std::make_shared<ScenarioOptions>();
  sub = add_subcommand(*scenario, "show", "write the scene of a scenario after the seed has drawn its variation",
                       action, shown, show);
  sub->add_option("SCENARIO", shown->scenario, "a name (see `constrictor list scenarios`) or a file")->required();
  add_common_options(*sub, *shown);
  sub->footer(footer_of("The file has no variation any more. All places are in the frame `world`.",
                        {"constrictor scenario show wide --seed 7",
                         "constrictor scenario show case_study --output straight.yaml --force"}));
  scenario->footer(footer_of("", {"constrictor scenario random --difficulty easy --output easy.yaml --force",
                                  "constrictor scenario show wide --seed 7"}));
}

}  // namespace constrictor::cli
