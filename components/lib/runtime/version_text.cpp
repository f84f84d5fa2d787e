#include "runtime/version_text.hpp"

#include <fmt/format.h>

#include "constrictor/messages.hpp"
#include "runtime/loaded_libraries.hpp"
#include "runtime/version.hpp"

namespace constrictor {

// A weak reference: programs without this constant are linked nevertheless, and then its address is null.
[[gnu::weak]] extern const char* const kGitRevision;

std::string own_git_revision() {
  return &kGitRevision == nullptr ? "not known: the program does not contain it" : kGitRevision;
}

std::string version_text(const std::string& program, const std::string& git_revision) {
  std::string text = fmt::format("{} {}\n", program, kVersion);
  if (!git_revision.empty()) text += fmt::format("git {}\n", git_revision);
  text += fmt::format("IDL {}", msg::kIdlHash);
  for (const auto& [name, version] : loaded_libraries()) {
    if (name == "cyclonedds") text += fmt::format("\nCyclone DDS {}", version);
  }
  return text;
}

}  // namespace constrictor
