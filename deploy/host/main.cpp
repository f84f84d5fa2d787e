// constrictor_host NAME[,NAME...] [OPTION...]: several components in one process, queues between them, DDS to the others.
#include <cstdio>
#include <sstream>

#include "known_components.hpp"
#include "runtime/component_main.hpp"
#include "runtime/host.hpp"
#include "runtime/numeric_profile.hpp"
#include "runtime/version.hpp"

int main(int argc, char** argv) {
  using namespace constrictor;
  const std::string first = argc > 1 ? argv[1] : "--help";
  if (first == "--version") {
    std::printf("%s\n", kVersion);
    return exit_status::kOk;
  }
  if (first[0] == '-') {
    std::printf("usage: constrictor_host NAME[,NAME...] [OPTION...]\nOPTIONs are those of every component, see constrictor_host NAME --help. Components:");
    for (const auto& [name, make] : known_components()) std::printf(" %s", name.c_str());
    std::printf("\n");
    return first == "--help" ? exit_status::kOk : exit_status::kUsage;
  }
  ensure_numeric_environment(argv);  // before the names are taken off: it starts the program anew
  std::vector<ComponentFactory> factories;
  std::istringstream names(first);
  for (std::string name; std::getline(names, name, ',');) {
    const auto known = known_components().find(name);
    if (known == known_components().end()) {
      std::fprintf(stderr, "constrictor_host: found component '%s', accepted those of --help\n", name.c_str());
      return exit_status::kUsage;
    }
    factories.push_back(known->second());
  }
  return host_main(argc - 1, argv + 1, std::move(factories));
}
