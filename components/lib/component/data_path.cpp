#include "component/data_path.hpp"

#include <cstdlib>
#include <set>

namespace constrictor {

namespace fs = std::filesystem;

std::vector<fs::path> data_folders() {
  std::error_code error;
  std::vector<fs::path> folders;
  const auto add = [&](const fs::path& folder) {
    if (fs::is_directory(folder, error)) folders.push_back(folder);
  };
  if (const char* folder = std::getenv("CONSTRICTOR_DATA")) add(folder);
  // An installed program (PREFIX/libexec/constrictor/NAME) uses its own prefix, also if the source tree still exists.
  const fs::path prefix = fs::read_symlink("/proc/self/exe", error).parent_path().parent_path().parent_path();
  if (fs::is_directory(prefix / "share/constrictor", error)) {
    add((prefix.filename() == "usr" ? prefix.parent_path() : prefix) / "etc/constrictor");
    add(prefix / "share/constrictor");
  } else {
    add(CONSTRICTOR_SOURCE_DIR);
  }
  return folders;
}

fs::path data_path(const fs::path& relative) {
  std::error_code error;
  for (const auto& folder : data_folders()) {
    if (fs::exists(folder / relative, error)) return folder / relative;
  }
  return fs::path(CONSTRICTOR_SOURCE_DIR) / relative;
}

fs::path default_robot_file() { return data_path("components/lib/robot/mamba.yaml"); }

fs::path default_scenario_file() { return data_path("sim/scenarios/case_study.yaml"); }

std::vector<std::string> data_names(const fs::path& relative) {
  std::set<std::string> names;
  std::error_code no_folder;
  for (const auto& folder : data_folders()) {
    for (const auto& entry : fs::directory_iterator(folder / relative, no_folder)) {
      if (entry.path().extension() == ".yaml") names.insert(entry.path().stem());
    }
  }
  return {names.begin(), names.end()};
}

}  // namespace constrictor
