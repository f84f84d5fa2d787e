#include "parameter_tables.hpp"

#include <fmt/format.h>

#include <fstream>
#include <sstream>

#include "host/known_components.hpp"
#include "video_capture/video_capture.hpp"

namespace constrictor {
namespace {

constexpr std::size_t kColumns = 120;

/// A comment that is wrapped at word boundaries.
std::string comment(const std::string& text, const std::string& indent) {
  std::string lines;
  std::string line = indent + "#";
  std::istringstream words(text);
  for (std::string word; words >> word;) {
    if (line.size() + 1 + word.size() > kColumns) {
      lines += line + "\n";
      line = indent + "#";
    }
    line += " " + word;
  }
  return lines + line + "\n";
}

std::string constraint(const ParameterRow& row) {
  return row.accepted + (row.unit.empty() ? "" : " " + row.unit) +
         (row.changes == Changes::kWhileRunning ? "; may change during a run" : "");
}

std::vector<std::string> split(const std::string& key) {
  std::vector<std::string> parts;
  std::istringstream stream(key);
  for (std::string part; std::getline(stream, part, '.');) parts.push_back(part);
  return parts;
}

std::string cell(const std::string& text) {
  std::string escaped;
  for (const char letter : text) {
    if (letter == '|') escaped += '\\';
    escaped += letter;
  }
  return escaped;
}

/// The README with another table between its two lines; nothing if it lacks them.
std::string with_table(const std::string& readme, const std::string& table) {
  const auto begin = readme.find(kTableBegin);
  const auto end = readme.find(kTableEnd);
  if (begin == std::string::npos || end == std::string::npos || end < begin) return {};
  return readme.substr(0, begin) + kTableBegin + "\n" + table + readme.substr(end);
}

}  // namespace

std::string yaml_text(const std::string& component, const std::string& folder, const std::vector<ParameterRow>& rows) {
  std::string text = comment(fmt::format("Parameters of {} and their defaults. The build target parameter_tables "
                                         "writes this file from the rows in {}. To use other values, write them into "
                                         "a file of your own, without the keys that keep their default, and run:",
                                         component, folder),
                             "");
  text += fmt::format("#   constrictor run --config {}=FILE.yaml\n", component);
  std::vector<std::string> open;  // the sections that the previous row stands in
  for (const auto& row : rows) {
    const auto parts = split(row.key);
    std::size_t common = 0;
    while (common < open.size() && common + 1 < parts.size() && open[common] == parts[common]) ++common;
    open.assign(parts.begin(), parts.end() - 1);
    for (std::size_t depth = common; depth + 1 < parts.size(); ++depth)
      text += std::string(2 * depth, ' ') + parts[depth] + ":\n";
    const std::string indent(2 * (parts.size() - 1), ' ');
    text += comment(row.meaning + ". [" + constraint(row) + "]", indent);
    text += indent + parts.back() + ": " + row.default_value + "\n";
  }
  return text;
}

std::string markdown_table(const std::vector<ParameterRow>& rows) {
  std::string text =
      "| parameter | default | unit | accepted | may change during a run | meaning |\n|---|---|---|---|---|---|\n";
  for (const auto& row : rows) {
    text += fmt::format("| `{}` | {} | {} | {} | {} | {} |\n", row.key, cell(row.default_value), cell(row.unit),
                        cell(row.accepted), row.changes == Changes::kWhileRunning ? "yes" : "no", cell(row.meaning));
  }
  return text;
}

std::string content_of(const std::filesystem::path& file) {
  std::ostringstream text;
  text << std::ifstream(file, std::ios::binary).rdbuf();
  return std::move(text).str();
}

std::vector<DerivedFile> derived_files(const std::filesystem::path& root) {
  std::vector<DerivedFile> files;
  std::vector<ComponentFactory> factories = {make_video_capture_factory()};  // it is not a part of constrictor_host
  for (const auto& [name, make] : known_components()) factories.push_back(make());
  for (const ComponentFactory& factory : factories) {
    if (!factory.parameters) continue;
    const auto rows = factory.parameters({});
    if (rows.empty()) continue;
    const auto folder = factory.default_config.parent_path();
    files.push_back({root / factory.default_config, yaml_text(factory.name, folder.string(), rows), {}});
    const auto readme = root / folder / "README.md";
    DerivedFile documented{readme, with_table(content_of(readme), markdown_table(rows)), {}};
    if (documented.text.empty()) {
      documented.error = fmt::format("{}: found no table of parameters, accepted a file with the lines\n{}\n{}",
                                     readme.string(), kTableBegin, kTableEnd);
    }
    files.push_back(std::move(documented));
  }
  return files;
}

}  // namespace constrictor
