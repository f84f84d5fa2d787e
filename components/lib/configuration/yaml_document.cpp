#include "configuration/yaml_document.hpp"

#include <fmt/format.h>

#include <cstddef>
#include <vector>

namespace constrictor {
namespace {

constexpr int kMostLevels = 256;
constexpr std::size_t kMostValues = 5'000'000;  // aliases make a small file large

/// Visits all values as often as they are named.
void visit(const YAML::Node& node, int level, std::size_t& values) {
  if (level > kMostLevels)
    throw YAML::ParserException(
        node.Mark(), fmt::format("an alias to a value that contains it, or more than {} levels", kMostLevels));
  if (++values > kMostValues)
    throw YAML::ParserException(node.Mark(), fmt::format("more than {} values, with aliases", kMostValues));
  if (node.IsSequence()) {
    for (const auto& item : node) visit(item, level + 1, values);
  } else if (node.IsMap()) {
    for (const auto& entry : node) {
      visit(entry.first, level + 1, values);
      visit(entry.second, level + 1, values);
    }
  }
}

constexpr const char* kNotClosed = "a list or map that is not closed";

/// All documents of the text. What yaml-cpp calls "end of sequence flow not found" gets a name that people understand.
std::vector<YAML::Node> load_all(const std::string& text) {
  try {
    return YAML::LoadAll(text);
  } catch (const YAML::ParserException& error) {
    if (!error.msg.ends_with("flow not found")) throw;
    throw YAML::ParserException(error.mark, kNotClosed);
  }
}

}  // namespace

YAML::Node parse_yaml(const std::string& text) {
  YAML::Node found;
  for (const YAML::Node& document : load_all(text)) {
    if (document.IsNull()) continue;  // such as the nothing after a last line of "---"
    if (!found.IsNull()) throw YAML::ParserException(document.Mark(), "a second document; only one is read");
    found.reset(document);
  }
  std::size_t values = 0;
  visit(found, 0, values);
  return found;
}

std::string accepted_yaml(const YAML::Exception& error) {
  if (error.msg == kNotClosed) return "valid YAML (is a ']', '}' or comma missing?)";
  return error.msg.find("flow") == std::string::npos ? "valid YAML" : "valid YAML (is a comma missing?)";
}

}  // namespace constrictor
