#include "configuration/configuration.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <fstream>
#include <sstream>
#include <utility>

#include "configuration/closest_name.hpp"
#include "configuration/yaml_document.hpp"

namespace constrictor {
namespace {

constexpr std::size_t kLongestQuotation = 60;

/// Line of a node, from 1. yaml-cpp counts from 0; nodes that stand in no file have line -1.
int line_of(const YAML::Node& node) { return std::max(node.Mark().line, 0) + 1; }

std::string key_path(const std::string& path, std::string_view key) {
  return path.empty() ? std::string(key) : fmt::format("{}.{}", path, key);
}

/// The text that describes a node in an error message.
std::string describe(const YAML::Node& node) {
  if (!node.IsDefined()) return "nothing";
  if (node.IsNull()) return "an empty value";
  if (node.IsMap()) return "a map";
  if (node.IsSequence()) return fmt::format("a list of {}", node.size());
  const std::string& text = node.Scalar();
  if (text.empty()) return "an empty text";
  return text.size() <= kLongestQuotation ? text : text.substr(0, kLongestQuotation) + "...";
}

std::string describe(const std::vector<std::string>& choices) {
  if (choices.empty()) return "a text";
  return (choices.size() == 1 ? "" : "one of ") + fmt::format("{}", fmt::join(choices, ", "));
}

std::string describe(Range accepted) { return fmt::format("{:g} to {:g}", accepted.min, accepted.max); }

/// The whole scalar as a number in the notation of the C locale, whatever the locale of the process is.
template <class Number>
std::optional<Number> parse_number(const YAML::Node& node) {
  if (!node.IsScalar()) return std::nullopt;
  std::string_view text = node.Scalar();
  if (text.size() > 1 && text.front() == '+' && text[1] != '-') text.remove_prefix(1);
  Number value{};
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size()) return std::nullopt;
  return value;
}

std::optional<double> parse_finite(const YAML::Node& node, Range accepted) {
  const std::optional<double> value = parse_number<double>(node);
  if (!value || !std::isfinite(*value) || *value < accepted.min || *value > accepted.max) return std::nullopt;
  return value;
}

bool is_choice(const std::string& value, const std::vector<std::string>& choices) {
  return choices.empty() || std::find(choices.begin(), choices.end(), value) != choices.end();
}

ConfigurationError located(const std::string& file, int line, const std::string& key, const std::string& found,
                           const std::string& accepted) {
  return ConfigurationError(fmt::format("{}:{}: {}: found {}, accepted {}", file, line, key, found, accepted));
}

/// The value of a key. operator[] of yaml-cpp would insert a missing key into the map.
YAML::Node value_of(const YAML::Node& map, std::string_view key) {
  if (map.IsMap()) {
    for (const auto& entry : map) {
      if (entry.first.IsScalar() && entry.first.Scalar() == key) return entry.second;
    }
  }
  return YAML::Node(YAML::NodeType::Undefined);
}

bool present(const YAML::Node& node) { return node.IsDefined() && !node.IsNull(); }

/// Rejects keys that are lists or maps, and equal keys: yaml-cpp silently uses only one of two equal keys.
void reject_odd_keys(const YAML::Node& map, const std::string& file, const std::string& path) {
  std::set<std::string> seen;
  for (const auto& entry : map) {
    if (!entry.first.IsScalar()) {
      throw located(file, line_of(entry.first), path.empty() ? "(root)" : path, describe(entry.first) + " as a key",
                    "a plain text");
    }
    const std::string& key = entry.first.Scalar();
    if (!seen.insert(key).second) {
      throw located(file, line_of(entry.first), key_path(path, key), "the key a second time", "each key once");
    }
  }
}

/// Flow style ({a: 1, b: [2, 3]}) has no line breaks.
void set_flow_style(YAML::Node& node) {
  if (!node.IsMap() && !node.IsSequence()) return;
  node.SetStyle(YAML::EmitterStyle::Flow);
  for (auto child : node) {
    if (node.IsMap()) set_flow_style(child.second);
    else set_flow_style(child);
  }
}

YAML::Node parse_root(const std::string& text, const std::string& name) {
  try {
    return parse_yaml(text);
  } catch (const YAML::Exception& error) {
    throw located(name, std::max(error.mark.line, 0) + 1, "(syntax)", error.msg, accepted_yaml(error));
  }
}

}  // namespace

Configuration::Configuration(std::shared_ptr<YAML::Node> node, std::string file, std::string path)
    : node_(std::move(node)), file_(std::move(file)), path_(std::move(path)) {
  if (!node_->IsNull() && node_->IsDefined() && !node_->IsMap()) {
    throw located(file_, line_of(*node_), path_.empty() ? "(root)" : path_, describe(*node_), "a map");
  }
  if (node_->IsMap()) reject_odd_keys(*node_, file_, path_);
}

Configuration Configuration::load(const std::filesystem::path& file) {
  std::ifstream stream(file);
  std::ostringstream text;
  text << stream.rdbuf();
  if (!stream.is_open() || stream.bad() || (text.fail() && stream.peek() != std::ifstream::traits_type::eof())) {
    throw ConfigurationError(fmt::format("{}: found no readable file, accepted a YAML file", file.string()));
  }
  return parse(text.str(), file.string());
}

Configuration Configuration::parse(const std::string& text, const std::string& name) {
  return {std::make_shared<YAML::Node>(parse_root(text, name)), name, ""};
}

bool Configuration::has(std::string_view key) {
  known_.emplace(key);
  return present(value_of(*node_, key));
}

double Configuration::number(std::string_view key, Range accepted, std::optional<double> fallback) {
  known_.emplace(key);
  const YAML::Node node = value_of(*node_, key);
  if (!node.IsDefined() && fallback) return *fallback;
  if (const auto value = parse_finite(node, accepted)) return *value;
  throw refusal(key, node, describe(accepted));
}

std::int64_t Configuration::integer(std::string_view key, std::int64_t min, std::int64_t max,
                                    std::optional<std::int64_t> fallback) {
  known_.emplace(key);
  const YAML::Node node = value_of(*node_, key);
  if (!node.IsDefined() && fallback) return *fallback;
  const auto value = parse_number<std::int64_t>(node);
  if (value && *value >= min && *value <= max) return *value;
  throw refusal(key, node, fmt::format("a whole number {} to {}", min, max));
}

bool Configuration::flag(std::string_view key, std::optional<bool> fallback) {
  known_.emplace(key);
  const YAML::Node node = value_of(*node_, key);
  if (!node.IsDefined() && fallback) return *fallback;
  if (node.IsScalar() && (node.Scalar() == "true" || node.Scalar() == "false")) return node.Scalar() == "true";
  throw refusal(key, node, "true or false");
}

std::string Configuration::text(std::string_view key, const std::vector<std::string>& choices,
                                std::optional<std::string> fallback) {
  known_.emplace(key);
  const YAML::Node node = value_of(*node_, key);
  if (!node.IsDefined() && fallback) return *fallback;
  if (node.IsScalar() && is_choice(node.Scalar(), choices)) return node.Scalar();
  throw refusal(key, node, describe(choices) + (node.IsScalar() ? did_you_mean(node.Scalar(), choices) : ""));
}

std::vector<double> Configuration::numbers(std::string_view key, Range accepted, std::size_t min_count,
                                           std::size_t max_count, const std::optional<std::vector<double>>& fallback) {
  known_.emplace(key);
  const YAML::Node node = value_of(*node_, key);
  if (!node.IsDefined() && fallback) return *fallback;
  const std::string count =
      min_count == max_count ? std::to_string(min_count) : fmt::format("{} to {}", min_count, max_count);
  if (!node.IsSequence() || node.size() < min_count || node.size() > max_count)
    throw refusal(key, node, fmt::format("a list of {} numbers, each {}", count, describe(accepted)));
  std::vector<double> values;
  values.reserve(node.size());
  for (std::size_t i = 0; i < node.size(); ++i) {
    const auto value = parse_finite(node[i], accepted);
    if (!value) {
      throw located(file_, line_of(node[i]), fmt::format("{}[{}]", key_path(path_, key), i), describe(node[i]),
                    describe(accepted));
    }
    values.push_back(*value);
  }
  return values;
}

std::vector<std::string> Configuration::texts(std::string_view key, const std::vector<std::string>& choices,
                                              const std::optional<std::vector<std::string>>& fallback) {
  known_.emplace(key);
  const YAML::Node node = value_of(*node_, key);
  if (!node.IsDefined() && fallback) return *fallback;
  if (!node.IsSequence()) throw refusal(key, node, "a list, each " + describe(choices));
  std::vector<std::string> values;
  for (std::size_t i = 0; i < node.size(); ++i) {
    if (!node[i].IsScalar() || !is_choice(node[i].Scalar(), choices)) {
      throw located(file_, line_of(node[i]), fmt::format("{}[{}]", key_path(path_, key), i), describe(node[i]),
                    describe(choices));
    }
    values.push_back(node[i].Scalar());
  }
  return values;
}

Configuration Configuration::section(std::string_view key, bool required) {
  known_.emplace(key);
  const YAML::Node node = value_of(*node_, key);
  if (!present(node) && required) throw refusal(key, node, "a map");
  if (!present(node)) return {std::make_shared<YAML::Node>(YAML::NodeType::Map), file_, key_path(path_, key)};
  return {std::make_shared<YAML::Node>(node), file_, key_path(path_, key)};
}

std::vector<Configuration> Configuration::list(std::string_view key, bool required) {
  known_.emplace(key);
  const YAML::Node node = value_of(*node_, key);
  if (!present(node) && !required) return {};
  if (!node.IsSequence()) throw refusal(key, node, "a list of maps");
  std::vector<Configuration> items;
  for (std::size_t i = 0; i < node.size(); ++i) {
    const std::string path = fmt::format("{}[{}]", key_path(path_, key), i);
    if (!node[i].IsMap()) throw located(file_, line_of(node[i]), path, describe(node[i]), "a map");
    items.push_back(Configuration(std::make_shared<YAML::Node>(node[i]), file_, path));
  }
  return items;
}

std::string Configuration::one_line(std::string_view key) {
  known_.emplace(key);
  const YAML::Node node = value_of(*node_, key);
  if (!present(node)) return {};
  YAML::Node copy = YAML::Clone(node);
  set_flow_style(copy);
  YAML::Emitter emitter;
  emitter << copy;
  return emitter.c_str();
}

void Configuration::finish() const {
  if (!node_->IsMap()) return;
  for (const auto& entry : *node_) {
    const std::string& key = entry.first.Scalar();
    if (known_.contains(key)) continue;
    const std::string accepted =
        known_.empty() ? std::string("no keys here") : fmt::format("the keys {}", fmt::join(known_, ", "));
    throw located(file_, line_of(entry.first), key_path(path_, key), "an unknown key",
                  accepted + did_you_mean(key, {known_.begin(), known_.end()}));
  }
}

ConfigurationError Configuration::refusal(std::string_view key, const YAML::Node& node,
                                          const std::string& accepted) const {
  return error(key, fmt::format("found {}, accepted {}{}", describe(node), accepted,
                                node.IsDefined() ? std::string() : misspelt(key)));
}

std::string Configuration::misspelt(std::string_view key) const {
  if (!node_->IsMap()) return {};
  for (const auto& entry : *node_) {
    const std::string& other = entry.first.Scalar();
    if (!known_.contains(other) && is_slip_of(other, key))
      return fmt::format("; line {} has a key '{}': rename it if it is meant", line_of(entry.first), other);
  }
  return {};
}

ConfigurationError Configuration::error(std::string_view key, const std::string& found_and_accepted) const {
  int line = line_of(*node_);  // the line of the map, if the map lacks the key
  YAML::Node node(*node_);
  std::string_view rest = key;
  while (!rest.empty() && node.IsMap()) {
    const auto dot = rest.find('.');
    const std::string_view first = rest.substr(0, dot);
    rest = dot == std::string_view::npos ? "" : rest.substr(dot + 1);
    YAML::Node below(YAML::NodeType::Undefined);
    for (const auto& entry : node) {
      if (!entry.first.IsScalar() || entry.first.Scalar() != first) continue;
      line = line_of(entry.first);
      below.reset(entry.second);
    }
    node.reset(below);
  }
  return ConfigurationError(fmt::format("{}:{}: {}: {}", file_, line, key_path(path_, key), found_and_accepted));
}

}  // namespace constrictor
