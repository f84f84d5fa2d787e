#include "idl/generator/constant_groups.hpp"

#include <algorithm>
#include <cctype>
#include <set>
#include <stdexcept>

namespace constrictor::generator {
namespace {

bool is_upper(char c) { return std::isupper(static_cast<unsigned char>(c)) != 0; }

/// "FollowLine" becomes "follow_line".
std::string snake_case(const std::string& camel) {
  std::string text;
  for (const char c : camel) {
    if (is_upper(c) && !text.empty()) text += '_';
    text += static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  }
  return text;
}

bool belongs_to(const std::string& constant, const std::string& prefix) {
  return constant.size() > prefix.size() && constant.starts_with(prefix) && is_upper(constant[prefix.size()]);
}

}  // namespace

std::string group_of(const Field& field) {
  const std::string& comment = field.comment;
  if (field.type != "std::uint8_t" || field.is_sequence) return {};
  const auto dots = comment.find("...");
  if (dots == std::string::npos) return {};
  auto begin = dots;
  while (begin > 0 && std::isalnum(static_cast<unsigned char>(comment[begin - 1]))) --begin;
  const std::string word = comment.substr(begin, dots - begin);
  return word.size() > 1 && word[0] == 'k' && is_upper(word[1]) ? word : "";
}

std::vector<ConstantGroup> constant_groups(const Model& model) {
  std::set<std::string> prefixes;
  for (const auto& one : model.structs) {
    for (const auto& field : one.fields) {
      const std::string prefix = group_of(field);
      if (prefix.empty()) continue;
      const auto fits = [&](const Constant& constant) { return belongs_to(constant.name, prefix); };
      if (std::none_of(model.constants.begin(), model.constants.end(), fits)) {
        throw std::runtime_error(one.file + ": the comment of " + one.name + "." + field.name + " names " + prefix +
                                 "..., but no constant begins with " + prefix);
      }
      prefixes.insert(prefix);
    }
  }
  std::vector<ConstantGroup> groups;
  for (const auto& constant : model.constants) {
    if (constant.type != "std::uint8_t") continue;
    const std::string where = constant.file + ":" + std::to_string(constant.line) + ": " + constant.name;
    const auto prefix = std::find_if(prefixes.begin(), prefixes.end(),
                                     [&](const std::string& each) { return belongs_to(constant.name, each); });
    if (prefix == prefixes.end()) {
      throw std::runtime_error(where + " belongs to no group; accepted: a name whose beginning stands in the comment " +
                               "of a field, followed by \"...\"");
    }
    if (groups.empty() || groups.back().prefix != *prefix) groups.push_back({*prefix, {}});
    if (constant.value != groups.back().names.size()) {
      throw std::runtime_error(where + ": found value " + std::to_string(constant.value) + ", accepted " +
                               std::to_string(groups.back().names.size()) + "; constants of a group stand together " +
                               "and count from 0");
    }
    groups.back().names.push_back(snake_case(constant.name.substr(prefix->size())));
  }
  return groups;
}

}  // namespace constrictor::generator
