#include <algorithm>
#include <cctype>
#include <fstream>
#include <regex>
#include <set>

#include "layout_check.hpp"

namespace constrictor::testing {
namespace {

namespace fs = std::filesystem;

/// The Markdown files of the project; folders of builds and of git are left out.
std::vector<fs::path> markdown_files(const fs::path& root) {
  std::vector<fs::path> files;
  for (auto at = fs::recursive_directory_iterator(root); at != fs::recursive_directory_iterator(); ++at) {
    const std::string name = at->path().filename().string();
    const bool skipped = name == "build" || name == "runs" || name == "node_modules" || name == ".git";
    if (at->is_directory() && skipped) at.disable_recursion_pending();
    else if (at->is_regular_file() && at->path().extension() == ".md") files.push_back(at->path());
  }
  std::sort(files.begin(), files.end());
  return files;
}

/// The name under which a link finds a heading on GitHub: small letters, blanks as hyphens, no other punctuation.
std::string anchor_of(const std::string& heading) {
  static const std::regex link("\\[([^\\]]*)\\]\\([^)]*\\)");
  std::string anchor;
  for (const char c : std::regex_replace(heading, link, "$1")) {
    const auto byte = static_cast<unsigned char>(c);
    if (c == ' ') anchor += '-';
    else if (std::isalnum(byte) != 0 || c == '-' || c == '_' || byte >= 0x80)
      anchor += static_cast<char>(std::tolower(byte));
  }
  return anchor;
}

std::set<std::string> anchors_in(const fs::path& file) {
  static const std::regex heading("^#+ +(.*?) *$");
  std::set<std::string> anchors;
  std::ifstream stream(file);
  std::smatch match;
  for (std::string line; std::getline(stream, line);)
    if (std::regex_match(line, match, heading)) anchors.insert(anchor_of(match[1]));
  return anchors;
}

bool leads_somewhere(const fs::path& file, const std::string& target) {
  if (target.find(':') != std::string::npos) return true;  // a page of the web
  const std::string path = target.substr(0, target.find('#'));
  const fs::path to = path.empty() ? file : file.parent_path() / path;
  if (!fs::exists(to)) return false;
  const auto hash = target.find('#');
  return hash == std::string::npos || to.extension() != ".md" || anchors_in(to).contains(target.substr(hash + 1));
}

}  // namespace

std::vector<std::string> broken_links(const fs::path& root) {
  static const std::regex link("\\]\\(([^)\\s]+)\\)");
  std::vector<std::string> found;
  for (const auto& file : markdown_files(root)) {
    std::ifstream stream(file);
    std::string line;
    for (int number = 1; std::getline(stream, line); ++number) {
      for (auto at = std::sregex_iterator(line.begin(), line.end(), link); at != std::sregex_iterator(); ++at) {
        const std::string target = (*at)[1];
        if (!leads_somewhere(file, target))
          found.push_back(fs::relative(file, root).string() + ":" + std::to_string(number) + ": " + target);
      }
    }
  }
  return found;
}

}  // namespace constrictor::testing
