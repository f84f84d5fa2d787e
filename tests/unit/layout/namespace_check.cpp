#include <fstream>
#include <iterator>
#include <map>
#include <regex>
#include <set>

#include "layout_check.hpp"

namespace constrictor::testing {
namespace {

namespace fs = std::filesystem;

/// Folders whose namespace has the name of what they wrap.
const std::map<std::string, std::string>& wrappers() {
  static const std::map<std::string, std::string> names = {{"components/lib/cyclone", "dds"},
                                                           {"components/lib/recording", "mcap"}};
  return names;
}

/// Namespaces of libraries that are opened to declare a type of theirs without their header.
const std::set<std::string> kForeign = {"CLI", "YAML", "cv"};
/// Folders of tests that belong to no code: they test the project, or all components.
const std::set<std::string> kOfTheWhole = {"tests/unit/hostile", "tests/unit/layout", "tests/unit/steady_state"};

/// The namespaces of the folders in which a file is, without "constrictor::".
std::set<std::string> namespaces_of(const fs::path& folder) {
  std::set<std::string> names;
  fs::path path;
  for (const auto& part : folder) {
    path /= part;
    const auto wrapper = wrappers().find(path.string());
    names.insert(wrapper != wrappers().end() ? wrapper->second : part.string());
  }
  return names;
}

class NamespaceCheck {
 public:
  explicit NamespaceCheck(const fs::path& root) : root_(root) {
    for (const char* top : {"idl", "components", "sim", "tests/bench"}) {
      for (const auto& file : files_below(root, {top}, {".hpp", ".cpp"}))
        of_code_.merge(namespaces_of(fs::relative(file.parent_path(), root)));
    }
  }

  std::vector<std::string> violations() {
    for (const auto& file : files_below(root_, {"idl", "components", "sim", "tests"}, {".hpp", ".cpp"})) check(file);
    return found_;
  }

 private:
  void check(const fs::path& path) {
    static const std::regex opening("^(?:inline )?namespace ([A-Za-z_][\\w:]*) \\{.*");
    static const std::regex closing("^\\}  // namespace constrictor\\b.*");
    const fs::path file = fs::relative(path, root_);
    bool inside = false;
    std::ifstream stream(path);
    std::string line;
    std::smatch match;
    for (int number = 1; std::getline(stream, line); ++number) {
      if (std::regex_match(line, closing)) inside = false;
      if (!std::regex_match(line, match, opening)) continue;
      const std::string name = match[1];
      const bool own = name == "constrictor" || name.starts_with("constrictor::");
      // Inside the namespace of its folder a file may group names in further ones, but not in that of another folder.
      const bool good = own      ? may_open(file, first_below_constrictor(name))
                        : inside ? (!of_code_.contains(name) && name != "testing") || may_open(file, name)
                                 : kForeign.contains(name);
      if (!good) found_.push_back(file.string() + ":" + std::to_string(number) + ": opens namespace " + name);
      inside |= own;
    }
  }

  /// "dds" of "constrictor::dds::primitives"; empty for "constrictor".
  static std::string first_below_constrictor(const std::string& name) {
    const std::string rest = name == "constrictor" ? "" : name.substr(std::string("constrictor::").size());
    return rest.substr(0, rest.find("::"));
  }

  /// Whether this file may open `constrictor::NAME`, or `constrictor` if the name is empty.
  [[nodiscard]] bool may_open(const fs::path& file, const std::string& name) const {
    const bool is_test = *file.begin() == "tests";
    if (name.empty()) return true;
    if (name == "testing") {
      const bool of_class = file.string().starts_with("tests/unit/") && file.string().ends_with("_test.cpp");
      return is_test && (!of_class || kOfTheWhole.contains(file.parent_path().string()));
    }
    return namespaces_of(file.parent_path()).contains(name) || (is_test && of_code_.contains(name));
  }

  fs::path root_;
  std::set<std::string> of_code_;  ///< of all folders that tests may test
  std::vector<std::string> found_;
};

}  // namespace

std::vector<std::string> namespace_violations(const fs::path& root) { return NamespaceCheck(root).violations(); }

}  // namespace constrictor::testing
