// The directory of a new run.
#include <fmt/format.h>

#include "cli/run_command.hpp"

namespace constrictor::cli {

namespace fs = std::filesystem;

fs::path make_new_directory(const fs::path& wanted) {
  if (wanted.has_parent_path()) fs::create_directories(wanted.parent_path());
  fs::path directory = wanted;
  for (int number = 2; !fs::create_directory(directory); ++number)
    directory = fmt::format("{}-{}", wanted.string(), number);
  return directory;
}

}  // namespace constrictor::cli
