#include "layout_check.hpp"

#include <algorithm>
#include <array>
#include <fstream>
#include <iterator>
#include <regex>
#include <sstream>
#include <utility>

namespace constrictor::testing {
namespace {

namespace fs = std::filesystem;

constexpr int kMostLines = 300;
constexpr const char* kForeignCode = "components/tools/dashboard/page/three/";  // three.js
constexpr std::ptrdiff_t kMostColumns = 120;

bool is_below(const std::string& file, const std::vector<std::string>& folders) {
  return std::any_of(folders.begin(), folders.end(), [&](const auto& one) { return file.rfind(one + "/", 0) == 0; });
}

/// Words that only the simulation, the runtime and the programs for people may use.
const std::regex& ground_truth() {
  static const std::regex words(
      "\\b(kWorldState|kSceneDescription|kTouchedState|kOverviewImage|WorldState|SceneDescription|TouchedState|"
      "scenario_file)\\b");
  return words;
}

std::string text_of(const fs::path& file) {
  std::ifstream stream(file);
  return {std::istreambuf_iterator<char>(stream), {}};
}

/// The text without its line breaks, at which sentences of a README are wrapped.
std::string in_one_line(std::string text) {
  std::replace(text.begin(), text.end(), '\n', ' ');
  return text;
}

/// One column for each character: bytes that continue a character of UTF-8 begin with the bits 10.
std::ptrdiff_t columns_of(const std::string& text) {
  return std::count_if(text.begin(), text.end(), [](char byte) { return (byte & 0xC0) != 0x80; });
}

/// A row of a table, or a single word, for example a link without blanks. A link with blanks in its text can be wrapped
/// there.
bool cannot_be_wrapped(const std::string& line) {
  if (line.starts_with("|")) return true;
  static const std::regex mark("[-*+>]|[0-9]+\\.|#+");  // of a list, a quotation or a heading: stays with what follows
  std::istringstream words(line);
  int count = 0;
  for (std::string word; words >> word;)
    if (!std::regex_match(word, mark)) ++count;
  return count == 1;
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

}  // namespace

std::vector<fs::path> files_below(const fs::path& root, const std::vector<std::string>& tops,
                                  const std::vector<std::string>& extensions) {
  std::vector<fs::path> files;
  for (const auto& top : tops) {
    if (!fs::exists(root / top)) continue;
    for (const auto& entry : fs::recursive_directory_iterator(root / top)) {
      const std::string extension = entry.path().extension().string();
      if (std::count(extensions.begin(), extensions.end(), extension) > 0) files.push_back(entry.path());
    }
  }
  std::sort(files.begin(), files.end());
  return files;
}

std::vector<std::string> source_violations(const fs::path& root) {
  static const std::regex include_line("^\\s*#\\s*include\\s*[<\"]([^>\"]+)[>\"]");
  static const std::vector<std::string> kCallsDds = {"components/lib/cyclone", "components/lib/runtime"};
  static const std::vector<std::string> kSeesTruth = {"components/lib", "components/tools", "sim", "idl"};
  std::vector<std::string> found;
  for (const auto& path : files_below(root, {"idl", "components", "sim"}, {".hpp", ".cpp"})) {
    const std::string file = fs::relative(path, root).string();
    std::ifstream stream(path);
    std::string line;
    for (int number = 1; std::getline(stream, line); ++number) {
      const auto report = [&](const std::string& why) {
        found.push_back(file + ":" + std::to_string(number) + ": " + why);
      };
      const std::string code = line.substr(0, line.find("//"));
      std::smatch match;
      if (std::regex_search(line, match, include_line)) {
        const std::string header = match[1];
        if (header.rfind("dds/", 0) == 0 && !is_below(file, kCallsDds)) report("includes " + header);
        if (header.find("..") != std::string::npos) report("includes " + header + " by its place, not by its name");
      } else if (!is_below(file, kSeesTruth) && std::regex_search(code, match, ground_truth())) {
        report("uses " + match[1].str() + ", which a robot does not have");
      }
    }
  }
  return found;
}

std::vector<std::string> long_files(const fs::path& root) {
  std::vector<std::string> found;
  const auto files = files_below(root, {"idl", "components", "sim", "deploy", "examples", "tests", "scripts"},
                                 {".hpp", ".cpp", ".idl", ".py", ".js", ".sh", ".cmake"});
  for (const auto& file : files) {
    if (fs::relative(file, root).string().rfind(kForeignCode, 0) == 0) continue;
    const std::string text = text_of(file);
    const auto lines = std::count(text.begin(), text.end(), '\n');
    if (lines <= kMostLines) continue;
    fs::path folder = file.parent_path();
    while (folder != root && !fs::exists(folder / "README.md")) folder = folder.parent_path();
    const std::string readme = in_one_line(text_of(folder / "README.md"));
    const std::string statement = "`" + file.filename().string() + "` is longer than 300 lines because ";
    const auto at = readme.find(statement);
    const bool explained = at != std::string::npos && at + statement.size() < readme.size();
    if (!explained) found.push_back(fs::relative(file, root).string() + ": " + std::to_string(lines) + " lines");
  }
  return found;
}

std::vector<std::string> long_lines(const fs::path& root) {
  const std::vector<std::string> tops = {"idl",      "components", "sim",     "deploy",
                                         "examples", "tests",      "scripts", ".github"};
  const std::vector<std::string> extensions = {".hpp", ".cpp",  ".idl", ".def", ".txt", ".cmake", ".in",
                                               ".sh",  ".yaml", ".yml", ".md",  ".py",  ".pyi"};
  std::vector<fs::path> files = files_below(root, tops, extensions);
  for (const auto& entry : fs::directory_iterator(root)) {
    const std::string extension = entry.path().extension().string();
    if (entry.is_regular_file() && (extension == ".md" || extension == ".txt")) files.push_back(entry.path());
  }
  std::vector<std::string> found;
  for (const auto& path : files) {
    const bool is_text = path.extension() == ".md";
    std::ifstream stream(path);
    std::string line;
    for (int number = 1; std::getline(stream, line); ++number) {
      const auto columns = columns_of(line);
      if (columns > kMostColumns && !(is_text && cannot_be_wrapped(line)))
        found.push_back(fs::relative(path, root).string() + ":" + std::to_string(number) + ": " +
                        std::to_string(columns) + " columns");
    }
  }
  std::sort(found.begin(), found.end());
  return found;
}

std::vector<Library> declared_libraries(const fs::path& root) {
  static const std::regex call("(?:^|\\n)(constrictor_library|constrictor_component|add_library)\\((\\w+)( STATIC)?");
  std::vector<Library> found;
  for (const auto& file : files_below(root, {"idl", "components", "sim"}, {".txt"})) {
    const std::string text = text_of(file);
    for (std::sregex_iterator at(text.begin(), text.end(), call), end; at != end; ++at) {
      const std::string function = (*at)[1];
      if (function == "add_library" && !(*at)[3].matched) continue;  // of other kinds
      const std::string name = (function == "constrictor_component" ? "constrictor_" : "") + (*at)[2].str();
      found.push_back({fs::relative(file.parent_path(), root).string(), "lib" + name + ".a", {}});
    }
  }
  return found;
}

std::vector<std::string> symbol_violations(const Library& library) {
  const std::string& name = library.name;
  // The runtime and the programs on top of it are there to talk DDS and to look at the clock.
  const bool talks_dds = library.folder == "components/lib/cyclone" || library.folder == "components/lib/runtime" ||
                         library.folder == "components/lib/client" || library.folder == "components/tools/cli" ||
                         library.folder == "components/tools/common";
  // A serial port has answers to wait for, and a frame has an age; they give the time to the driver as an argument.
  const bool waits_for_devices = library.folder == "components/lib/serial" || library.folder == "components/lib/video";
  if (talks_dds || waits_for_devices || library.folder == "idl") return {};
  static const std::array<const char*, 12> kForbidden = {"clock_gettime",
                                                         "gettimeofday",
                                                         "nanosleep",
                                                         "clock_nanosleep",
                                                         "usleep",
                                                         "sleep",
                                                         "time",
                                                         "rand",
                                                         "random",
                                                         "_ZNSt6chrono3_V212steady_clock3nowEv",
                                                         "_ZNSt6chrono3_V212system_clock3nowEv",
                                                         "_ZNSt13random_device9_M_getvalEv"};
  std::vector<std::string> found;
  for (const auto& [kind, symbol] : symbols_of(library.nm)) {
    if (kind != 'U') continue;
    if (symbol.rfind("dds_", 0) == 0 || symbol.rfind("ddsi_", 0) == 0)
      found.push_back(name + " needs " + symbol + ": no DDS outside the runtime");
    if (std::find(kForbidden.begin(), kForbidden.end(), symbol) != kForbidden.end()) {
      found.push_back(name + " needs " + symbol + ": time is an argument and random numbers are seeded");
    }
  }
  return found;
}

}  // namespace constrictor::testing
