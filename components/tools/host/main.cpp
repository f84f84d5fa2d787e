// constrictor_host NAME[,NAME...] [OPTION...]: hosts several components in one process.
#include <fmt/format.h>
#include <algorithm>

#include <cstdio>
#include <sstream>

#include "component/data_path.hpp"
#include "configuration/closest_name.hpp"
#include "host/known_components.hpp"
#include "runtime/component_main.hpp"
#include "runtime/component_replay.hpp"
#include "runtime/git_revision.hpp"
#include "runtime/host.hpp"
#include "runtime/loaded_libraries.hpp"
#include "runtime/numeric_profile.hpp"
#include "runtime/version_text.hpp"

int main(int argc, char** argv) {
  using namespace constrictor;
  const std::string first = argc > 1 ? argv[1] : "--help";
  if (first == "--version") {
    std::printf("%s\n", version_text("constrictor_host", kGitRevision).c_str());
    return exit_status::kOk;
  }
  if (first == "--describe") {
    ensure_numeric_environment(argv);
    std::printf("profile %s\n", numeric_profile().c_str());
    for (const auto& [name, version] : loaded_libraries())
      std::printf("library %s %s\n", name.c_str(), version.c_str());
    for (const auto& [name, make] : known_components()) {
      const auto file = make().default_config;
      if (!file.empty()) std::printf("default %s %s\n", name.c_str(), data_path(file).c_str());
    }
    return exit_status::kOk;
  }
  if (first == "--components") {
    for (const auto& [name, make] : known_components()) std::printf("%s\n", name.c_str());
    return exit_status::kOk;
  }
  if (first == "--replay" && argc > 3) {
    ensure_numeric_environment(argv);
    return replay_main({argv + 2, argv + argc}, [](const std::string& name) -> std::optional<ComponentFactory> {
      const auto known = known_components().find(name);
      if (known == known_components().end()) return std::nullopt;
      return known->second();
    });
  }
  if (first[0] == '-') {
    std::printf(
        "usage: constrictor_host NAME[,NAME...] [OPTION...]\n"
        "       constrictor_host --components      # print the names, one per line\n"
        "       constrictor_host --describe        # print numeric profile, libraries, default configurations\n"
        "       constrictor_host --replay FILE [--output DIR] NAME...  # replay components of a recorded run\n"
        "       constrictor_host --replay FILE --restore OUT  # compute the images of a recording again\n"
        "All components have the same options: constrictor_host NAME --help. Components:");
    for (const auto& [name, make] : known_components()) std::printf(" %s", name.c_str());
    std::printf("\n");
    return first == "--help" ? exit_status::kOk : exit_status::kUsage;
  }
  ensure_numeric_environment(argv);  // with all arguments, because it may start the program again
  std::vector<ComponentFactory> factories;
  std::istringstream names(first);
  for (std::string name; std::getline(names, name, ',');) {
    const auto known = known_components().find(name);
    if (known == known_components().end()) {
      std::vector<std::string> accepted;
      for (const auto& [other, make] : known_components()) accepted.push_back(other);
      fmt::print(stderr, "constrictor_host: found component '{}', accepted {}{}\n", name, fmt::join(accepted, ", "),
                 did_you_mean(name, accepted));
      return exit_status::kUsage;
    }
    factories.push_back(known->second());
    const std::string& added = factories.back().name;
    if (std::count_if(factories.begin(), factories.end(), [&](const auto& one) { return one.name == added; }) > 1) {
      fmt::print(stderr, "constrictor_host: found component '{}' twice, accepted each once\n", added);
      return exit_status::kUsage;
    }
  }
  std::string program = "constrictor_host " + first;  // as its help and its errors of usage call it
  argv[1] = program.data();
  return host_main(argc - 1, argv + 1, std::move(factories));
}
