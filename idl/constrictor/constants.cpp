#include "constrictor/constants.hpp"

#include <algorithm>
#include <cctype>

namespace constrictor {
namespace {

char plain(char c) {
  return c == '-' || c == ' ' ? '_' : static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
}

}  // namespace

const char* name_of(const ConstantGroup& group, std::uint8_t value) {
  return value < group.names.size() ? group.names[value] : "?";
}

std::string words_of(const ConstantGroup& group, std::uint8_t value) {
  std::string words = name_of(group, value);
  std::replace(words.begin(), words.end(), '_', ' ');
  return words;
}

std::optional<std::uint8_t> value_of(const ConstantGroup& group, std::string_view name) {
  const auto same = [&](std::string_view each) {
    return std::equal(each.begin(), each.end(), name.begin(), name.end(), [](char a, char b) { return a == plain(b); });
  };
  const auto found = std::find_if(group.names.begin(), group.names.end(), same);
  if (found == group.names.end()) return {};
  return static_cast<std::uint8_t>(found - group.names.begin());
}

std::vector<std::string> names_of(const ConstantGroup& group, std::uint8_t first) {
  return {group.names.begin() + std::min<std::size_t>(first, group.names.size()), group.names.end()};
}

std::string listed(const ConstantGroup& group, std::uint8_t first) {
  std::string text;
  for (const auto& name : names_of(group, first)) text += (text.empty() ? "" : ", ") + name;
  return text;
}

}  // namespace constrictor
