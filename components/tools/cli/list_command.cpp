// `constrictor list`: the names that other subcommands accept.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <fstream>
#include <memory>

#include "cli/child_process.hpp"
#include "cli/launch_plan.hpp"
#include "cli/subcommands.hpp"
#include "cli/usage.hpp"
#include "component/data_path.hpp"
#include "runtime/host.hpp"

namespace constrictor::cli {
namespace {

struct ListOptions {
  std::string kind;
  bool names = false;
};

/// The first sentence of the comment at the start of a file; without a full stop, the first paragraph of the comment.
std::string first_sentence(const std::filesystem::path& file) {
  std::ifstream stream(file);
  std::string text;
  for (std::string line; std::getline(stream, line) && line.starts_with("#");) {
    const auto begin = line.find_first_not_of("# ");
    if (begin == std::string::npos) break;
    text += (text.empty() ? "" : " ") + line.substr(begin);
    if (const auto stop = text.find(". "); stop != std::string::npos) return text.substr(0, stop + 1);
  }
  return text;
}

int list_files(const NamedFiles& files, bool only_names) {
  const auto names = names_of(files);
  std::size_t width = 12;
  for (const auto& name : names) width = std::max(width, name.size());
  for (const auto& name : names) {
    if (only_names) fmt::print("{}\n", name);
    else fmt::print("{:<{}}  {}\n", name, width, first_sentence(data_path(files.folder / (name + ".yaml"))));
  }
  return exit_status::kOk;
}

int list_names(const ListOptions& options) {
  for (const auto& files : {kScenarios, kRobots, kManifests}) {
    if (options.kind == files.list_argument) return list_files(files, options.names);
  }
  const auto components = hosted_components();
  for (const auto& name : components) fmt::print("{}\n", name);
  return components.empty() ? exit_status::kSoftware : exit_status::kOk;
}

}  // namespace

void add_list(CLI::App& app, Action& action) {
  auto options = std::make_shared<ListOptions>();
  auto* sub =
      add_subcommand(app, "list", "list the scenarios, robots, manifests or components that can be chosen by name",
                     action, options, list_names);
  sub->add_option("KIND", options->kind, "scenarios, robots, manifests or components")
      ->required()
      ->check(one_of({"scenarios", "robots", "manifests", "components"}));
  sub->add_flag("--names", options->names, "print the names only, one per line, for scripts");
  sub->footer(help_footer("", {"constrictor list scenarios", "constrictor list components --names"},
                          "0 done; 64 wrong usage; 70 constrictor_host, which knows the components, does not start",
                          kDataEnvironment));
}

}  // namespace constrictor::cli
