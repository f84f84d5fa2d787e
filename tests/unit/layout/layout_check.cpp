#include "layout_check.hpp"

#include <algorithm>
#include <array>
#include <fstream>
#include <regex>
#include <sstream>

namespace constrictor::test {
namespace {

namespace fs = std::filesystem;

bool starts_with_any(const std::string& text, const std::vector<std::string>& prefixes) {
  return std::any_of(prefixes.begin(), prefixes.end(), [&](const std::string& p) { return text.rfind(p, 0) == 0; });
}

/// Where a file belongs: "idl", "components/NAME", "sim/NAME".
std::string folder_of(const fs::path& file, const fs::path& root) {
  const fs::path relative = fs::relative(file, root);
  auto part = relative.begin();
  const std::string top = part->string();
  if (top == "idl") return top;
  return top + "/" + (++part)->string();
}

/// Prefixes of project headers that a file of this folder may include, its own folder aside.
std::vector<std::string> allowed_of(const std::string& folder, bool is_main) {
  if (folder == "idl") return {"constrictor/"};
  if (folder == "components/configuration") return {};
  if (folder == "components/robot") return {"constrictor/", "configuration/"};
  if (folder == "components/runtime") return {"constrictor/", "configuration/"};
  // Programs on top of the runtime, outside the barrier.
  if (folder == "components/cli" || folder == "components/ros_bridge") return {"constrictor/", "configuration/", "robot/", "runtime/"};
  std::vector<std::string> allowed = {"constrictor/", "configuration/", "robot/", "runtime/component.hpp",
                                      "runtime/concluding.hpp", "runtime/ports.hpp", "runtime/outside_requests.hpp", "runtime/topics.hpp",
                                      "runtime/share.hpp", "runtime/parameters.hpp"};
  if (is_main) allowed.emplace_back("runtime/component_main.hpp");
  if (folder.rfind("sim/", 0) == 0) allowed.emplace_back("sim/");
  return allowed;
}

/// Words that only the simulation, the runtime and the command may use.
const std::regex& ground_truth() {
  static const std::regex words(
      "\\b(kWorldState|kSceneDescription|kTouchedState|kOverviewImage|WorldState|SceneDescription|TouchedState|scenario_file)\\b");
  return words;
}

}  // namespace

std::vector<std::string> source_violations(const fs::path& root) {
  static const std::regex include_line("^\\s*#\\s*include\\s*([<\"])([^>\"]+)[>\"]");
  std::vector<fs::path> files;
  for (const char* top : {"idl", "components", "sim"}) {
    if (!fs::exists(root / top)) continue;
    for (const auto& entry : fs::recursive_directory_iterator(root / top)) {
      if (entry.path().extension() == ".hpp" || entry.path().extension() == ".cpp") files.push_back(entry.path());
    }
  }
  std::sort(files.begin(), files.end());
  std::vector<std::string> found;
  for (const auto& file : files) {
    const std::string folder = folder_of(file, root);
    std::vector<std::string> allowed = allowed_of(folder, file.filename() == "main.cpp");
    // Includes name a component's header from components/, sim's and idl's from the root.
    allowed.push_back(folder.rfind("components/", 0) == 0 ? folder.substr(11) + "/" : folder + "/");
    const bool sees_truth = folder.rfind("components/", 0) != 0 || folder == "components/runtime" || folder == "components/cli";
    std::ifstream stream(file);
    std::string line;
    for (int number = 1; std::getline(stream, line); ++number) {
      const auto report = [&](const std::string& why) {
        found.push_back(fs::relative(file, root).string() + ":" + std::to_string(number) + ": " + why);
      };
      const std::string code = line.substr(0, line.find("//"));
      std::smatch match;
      if (std::regex_search(line, match, include_line)) {
        const std::string header = match[2];
        const bool is_dds = header.rfind("dds/", 0) == 0;
        if (is_dds && folder != "components/runtime") report("includes " + header + "; only components/runtime may");
        const bool is_project = match[1] == "\"" && header.find('/') != std::string::npos;
        if (is_project && !is_dds && !starts_with_any(header, allowed)) report("includes " + header);
      } else if (!sees_truth && std::regex_search(code, match, ground_truth())) {
        report("uses " + match[1].str() + ", which a robot does not have");
      }
    }
  }
  return found;
}

std::vector<std::string> symbol_violations(const std::string& name, const std::string& nm_output) {
  // The runtime and the programs on top of it are there to talk DDS and to look at the clock.
  if (name == "libconstrictor_runtime.a" || name.rfind("libconstrictor_cli", 0) == 0 || name == "libconstrictor_messages.a") return {};
  static const std::array<const char*, 12> kForbidden = {
      "clock_gettime", "gettimeofday", "nanosleep", "clock_nanosleep", "usleep", "sleep", "time", "rand", "random",
      "_ZNSt6chrono3_V212steady_clock3nowEv", "_ZNSt6chrono3_V212system_clock3nowEv",
      "_ZNSt13random_device9_M_getvalEv"};
  std::vector<std::string> found;
  std::istringstream lines(nm_output);
  for (std::string line; std::getline(lines, line);) {
    const auto at = line.find(" U ");
    if (at == std::string::npos) continue;
    const std::string symbol = line.substr(at + 3, line.find('@', at) - at - 3);
    if (symbol.rfind("dds_", 0) == 0 || symbol.rfind("ddsi_", 0) == 0) found.push_back(name + " needs " + symbol + ": no DDS outside the runtime");
    if (std::find(kForbidden.begin(), kForbidden.end(), symbol) != kForbidden.end()) {
      found.push_back(name + " needs " + symbol + ": time is an argument and random numbers are seeded");
    }
  }
  return found;
}

}  // namespace constrictor::test
