#include "layout_check.hpp"

#include <algorithm>
#include <array>
#include <fstream>
#include <iterator>
#include <map>
#include <regex>
#include <set>
#include <sstream>
#include <utility>

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

/// Type and name of each symbol in the output of `nm`, versions ("@GLIBC_2.17") left out.
std::vector<std::pair<char, std::string>> symbols_of(const std::string& nm) {
  static const std::regex line_of("^[0-9a-f ]{16} ([A-Za-z]) ([^@]+).*");
  std::vector<std::pair<char, std::string>> symbols;
  std::istringstream lines(nm);
  std::smatch match;
  for (std::string line; std::getline(lines, line);) {
    if (std::regex_match(line, match, line_of)) symbols.emplace_back(match[1].str()[0], match[2]);
  }
  return symbols;
}

/// Whether a library may need another one: what the #include lines may name, by whole libraries.
bool may_link(const Library& library, const Library& other) {
  using Folders = std::vector<std::string>;
  static const Folders kBase = {"idl", "components/configuration"};
  static const Folders kOnRuntime = {"idl", "components/configuration", "components/robot", "components/runtime"};
  static const std::map<std::string, Folders> kOutsideTheBarrier = {
      {"idl", {}}, {"components/configuration", {}}, {"components/robot", kBase}, {"components/runtime", kBase},
      {"components/cli", kOnRuntime}, {"components/ros_bridge", kOnRuntime}};
  const auto is_one_of = [&other](const Folders& folders) { return std::find(folders.begin(), folders.end(), other.folder) != folders.end(); };
  if (library.folder == other.folder) return true;
  const auto outside = kOutsideTheBarrier.find(library.folder);
  if (outside != kOutsideTheBarrier.end()) return is_one_of(outside->second);
  const bool both_sim = library.folder.rfind("sim/", 0) == 0 && other.folder.rfind("sim/", 0) == 0;
  // Of the runtime a component needs what it may include, which is a library of its own.
  return both_sim || is_one_of(kBase) || other.folder == "components/robot" || other.name == "libconstrictor_component_api.a";
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

std::vector<std::string> long_files(const fs::path& root) {
  std::vector<std::string> found;
  for (const char* top : {"idl", "components", "sim", "deploy", "examples", "tests"}) {
    if (!fs::exists(root / top)) continue;
    const int most = std::string(top) == "tests" ? 500 : 400;
    for (const auto& entry : fs::recursive_directory_iterator(root / top)) {
      const std::string kind = entry.path().extension().string();
      if (kind != ".hpp" && kind != ".cpp" && kind != ".idl") continue;
      std::ifstream stream(entry.path());
      const auto lines = std::count(std::istreambuf_iterator<char>(stream), {}, '\n');
      const std::string file = fs::relative(entry.path(), root).string();
      if (lines > most) found.push_back(file + ": " + std::to_string(lines) + " lines, at most " + std::to_string(most));
    }
  }
  std::sort(found.begin(), found.end());
  return found;
}

std::vector<Library> declared_libraries(const fs::path& root) {
  static const std::regex call("(?:^|\\n)(constrictor_library|constrictor_component|add_library)\\((\\w+)( STATIC)?");
  std::vector<fs::path> folders = {root / "idl"};
  for (const char* top : {"components", "sim"}) {
    for (const auto& entry : fs::directory_iterator(root / top)) folders.push_back(entry.path());
  }
  std::sort(folders.begin(), folders.end());
  std::vector<Library> found;
  for (const auto& folder : folders) {
    std::ifstream stream(folder / "CMakeLists.txt");
    const std::string text{std::istreambuf_iterator<char>(stream), {}};
    for (std::sregex_iterator at(text.begin(), text.end(), call), end; at != end; ++at) {
      const std::string function = (*at)[1];
      if (function == "add_library" && !(*at)[3].matched) continue;  // of other kinds
      const std::string name = (function == "constrictor_component" ? "constrictor_" : "") + (*at)[2].str();
      found.push_back({fs::relative(folder, root).string(), "lib" + name + ".a", {}});
    }
  }
  return found;
}

std::vector<std::string> symbol_violations(const Library& library) {
  const std::string& name = library.name;
  // The runtime and the programs on top of it are there to talk DDS and to look at the clock.
  if (name == "libconstrictor_runtime.a" || name.rfind("libconstrictor_cli", 0) == 0 || name == "libconstrictor_messages.a") return {};
  static const std::array<const char*, 12> kForbidden = {
      "clock_gettime", "gettimeofday", "nanosleep", "clock_nanosleep", "usleep", "sleep", "time", "rand", "random",
      "_ZNSt6chrono3_V212steady_clock3nowEv", "_ZNSt6chrono3_V212system_clock3nowEv",
      "_ZNSt13random_device9_M_getvalEv"};
  std::vector<std::string> found;
  for (const auto& [kind, symbol] : symbols_of(library.nm)) {
    if (kind != 'U') continue;
    if (symbol.rfind("dds_", 0) == 0 || symbol.rfind("ddsi_", 0) == 0) found.push_back(name + " needs " + symbol + ": no DDS outside the runtime");
    if (std::find(kForbidden.begin(), kForbidden.end(), symbol) != kForbidden.end()) {
      found.push_back(name + " needs " + symbol + ": time is an argument and random numbers are seeded");
    }
  }
  return found;
}

std::vector<std::string> link_violations(const std::vector<Library>& libraries) {
  struct Need {
    const Library* library;
    std::string symbol;
  };
  std::map<std::string, std::vector<const Library*>> owners;
  std::vector<Need> needs;
  for (const auto& library : libraries) {
    std::set<std::string> own;
    std::set<std::string> needed;
    for (const auto& [kind, symbol] : symbols_of(library.nm)) {
      const bool defined = std::string("TDBRVW").find(kind) != std::string::npos;
      if (kind == 'U') needed.insert(symbol);
      else if (defined && own.insert(symbol).second) owners[symbol].push_back(&library);
    }
    for (const auto& symbol : needed) {
      if (!own.contains(symbol)) needs.push_back({&library, symbol});
    }
  }
  std::vector<std::string> found;
  for (const auto& [library, symbol] : needs) {
    const auto owner = owners.find(symbol);
    // Of a template that is instantiated in several libraries any copy will do: enough if one may be known.
    if (owner == owners.end()) continue;
    const bool allowed = std::any_of(owner->second.begin(), owner->second.end(), [&, of = library](const Library* other) {
      return may_link(*of, *other);
    });
    const Library& other = *owner->second.front();
    if (!allowed) found.push_back(library->folder + "/" + library->name + " needs " + symbol + " of " + other.folder + "/" + other.name);
  }
  return found;
}

}  // namespace constrictor::test
