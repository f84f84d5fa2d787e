#include "cli/evaluate/variation.hpp"

#include <fmt/format.h>
#include <yaml-cpp/yaml.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <charconv>
#include <fstream>
#include <map>
#include <set>
#include <sstream>

#include "cli/usage.hpp"
#include "component/data_path.hpp"
#include "configuration/closest_name.hpp"
#include "configuration/configuration.hpp"
#include "configuration/whole_file.hpp"
#include "configuration/yaml_document.hpp"

namespace constrictor::cli {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kMostSeeds = 100'000;
constexpr std::size_t kMostVariants = 1'000;

std::uint64_t parse_seed(const std::string& text, const std::string& whole) {
  std::uint64_t seed = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), seed);
  if (text.empty() || error != std::errc() || end != text.data() + text.size())
    throw UsageError(fmt::format("--seeds: found '{}', accepted seeds and ranges such as 1..40 or 1,5,9..12", whole));
  return seed;
}

/// Splits at commas that are not inside of brackets.
std::vector<std::string> split_values(const std::string& text) {
  std::vector<std::string> values(1);
  int depth = 0;
  for (const char c : text) {
    depth += (c == '[' || c == '{') ? 1 : (c == ']' || c == '}') ? -1 : 0;
    if (c == ',' && depth == 0) values.emplace_back();
    else values.back() += c;
  }
  return values;
}

/// The value as a number in one spelling, so that 0.5 equals 0.50; other values without blanks around them.
std::string plain_value(const std::string& value) {
  const std::string text = CLI::detail::trim_copy(value);
  double number = 0.0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  return error == std::errc() && end == text.data() + text.size() ? fmt::to_string(number) : text;
}

/// Throws UsageError if a value of a variation is there twice: its runs would be done twice.
void refuse_equal_values(const Variation& variation) {
  std::set<std::string> values;
  for (const auto& value : variation.values) {
    if (values.insert(plain_value(value)).second) continue;
    throw UsageError(
        fmt::format("--vary {}: found the value {} twice, accepted each value once: its runs would be "
                    "done twice",
                    variation.name(), CLI::detail::trim_copy(value)));
  }
}

/// Throws UsageError if a variation overwrites what an earlier one has set.
void refuse_equal_keys(const std::vector<Variation>& variations) {
  for (auto later = variations.begin(); later != variations.end(); ++later) {
    for (auto earlier = variations.begin(); earlier != later; ++earlier) {
      if (earlier->file != later->file || !(earlier->key + ".").starts_with(later->key + ".")) continue;
      throw UsageError(
          fmt::format("--vary {}: found also --vary {}, which it would overwrite, accepted each key once; "
                      "write all values of a key in one --vary, such as {}=1,2",
                      later->name(), earlier->name(), later->name()));
    }
  }
}

std::string folder_name(std::string text) {
  std::replace_if(
      text.begin(), text.end(),
      [](unsigned char c) {
        return std::isalnum(c) == 0 && std::string_view("._=-").find(static_cast<char>(c)) == std::string_view::npos;
      },
      '_');
  return text.substr(0, 150);
}

YAML::Node value_of(const Setting& setting) {
  try {
    return parse_yaml(setting.value);
  } catch (const YAML::Exception& error) {
    throw ConfigurationError(
        fmt::format("--vary {}: found '{}', accepted a value in YAML: {}", setting.key, setting.value, error.msg));
  }
}

/// Sets the value below `node` with the key KEY.KEY..., creating maps that do not exist.
void set(YAML::Node node, const std::vector<std::string>& path, const Setting& setting, const fs::path& file) {
  for (std::size_t i = 0; i < path.size(); ++i) {
    const bool last = i + 1 == path.size();
    if (node.IsSequence()) {
      std::size_t index = 0;
      const auto [end, error] = std::from_chars(path[i].data(), path[i].data() + path[i].size(), index);
      if (error != std::errc() || end != path[i].data() + path[i].size() || index >= node.size()) {
        throw ConfigurationError(
            fmt::format("--vary {}: {} has a list there; found '{}', accepted an index from 0 to {}", setting.key,
                        file.string(), path[i], node.size() - 1));
      }
      if (last) node[index] = value_of(setting);
      else node.reset(node[index]);
    } else if (node.IsMap() || node.IsNull() || !node.IsDefined()) {
      if (last) node[path[i]] = value_of(setting);
      else node.reset(node[path[i]]);
    } else {
      throw ConfigurationError(
          fmt::format("--vary {}: found '{}' below a value that is neither a list nor a map in {}, accepted a key that "
                      "exists",
                      setting.key, path[i], file.string()));
    }
  }
}

fs::path file_of(const std::string& name, const LaunchPlan& plan) {
  if (name == "scenario") return plan.manifest.scenario_file;
  if (name == "robot") return plan.manifest.robot_file;
  std::vector<std::string> names = plan.roster;
  if (std::find(names.begin(), names.end(), name) == names.end()) {
    names.insert(names.begin(), {"scenario", "robot"});
    throw ConfigurationError(
        fmt::format("--vary: found file '{}', accepted {}{}", name, fmt::join(names, ", "), did_you_mean(name, names)));
  }
  if (fs::path file = config_file_of(name, plan); !file.empty()) return file;
  throw ConfigurationError(
      fmt::format("--vary: {} has no configuration file; name one with --config {}=FILE", name, name));
}

}  // namespace

std::vector<std::uint64_t> parse_seeds(const std::string& text) {
  std::vector<std::uint64_t> seeds;
  for (const auto& part : CLI::detail::split(text, ',')) {
    const auto dots = part.find("..");
    const std::uint64_t first = parse_seed(part.substr(0, dots), text);
    const std::uint64_t last = dots == std::string::npos ? first : parse_seed(part.substr(dots + 2), text);
    if (last < first) throw UsageError(fmt::format("--seeds: found '{}', accepted ranges that ascend", part));
    if (last - first >= kMostSeeds || seeds.size() + (last - first) >= kMostSeeds)
      throw UsageError(fmt::format("--seeds: found '{}', accepted at most {} seeds", text, kMostSeeds));
    for (std::uint64_t i = 0; i <= last - first; ++i) {
      if (std::find(seeds.begin(), seeds.end(), first + i) == seeds.end()) seeds.push_back(first + i);
    }
  }
  if (seeds.empty()) throw UsageError("--seeds: found nothing, accepted seeds and ranges such as 1..40 or 1,5,9..12");
  return seeds;
}

Variation parse_variation(const std::string& text) {
  const auto equals = text.find('=');
  const auto colon = text.substr(0, equals).find(':');
  Variation variation;
  variation.file = colon == std::string::npos ? "scenario" : text.substr(0, colon);
  const std::size_t key = colon == std::string::npos ? 0 : colon + 1;
  if (equals != std::string::npos) {
    variation.key = text.substr(key, equals - key);
    variation.values = split_values(text.substr(equals + 1));
  }
  const bool empty_value = std::any_of(variation.values.begin(), variation.values.end(),
                                       [](const std::string& value) { return value.empty(); });
  if (variation.file.empty() || variation.key.empty() || variation.values.empty() || empty_value) {
    throw UsageError(
        fmt::format("--vary: found '{}', accepted [FILE:]KEY=VALUE[,VALUE...], for example noise.camera_sd=0,0.02 or "
                    "navigation:travel.speed_m_s=0.8,1.0",
                    text));
  }
  refuse_equal_values(variation);
  return variation;
}

fs::path config_file_of(const std::string& component, const LaunchPlan& plan) {
  const auto given = plan.manifest.config_files.find(component);
  if (given != plan.manifest.config_files.end()) return given->second;
  for (const char* parent : {"components", "sim"}) {
    fs::path file = data_path(fs::path(parent) / component / (component + ".yaml"));
    if (fs::is_regular_file(file)) return file;
  }
  return {};
}

std::vector<Variant> make_variants(const std::vector<Variation>& variations) {
  refuse_equal_keys(variations);
  std::vector<Variant> variants(1);
  for (const auto& variation : variations) {
    std::vector<Variant> longer;
    for (const auto& variant : variants) {
      for (const auto& value : variation.values) {
        longer.push_back(variant);
        Variant& added = longer.back();
        added.name += (added.name.empty() ? "" : ", ") + variation.name() + "=" + value;
        added.settings.push_back({variation.file, variation.key, value});
      }
    }
    variants = std::move(longer);
    if (variants.size() > kMostVariants)
      throw UsageError(fmt::format("--vary: found more than {} combinations, accepted fewer", kMostVariants));
  }
  std::map<std::string, int> used;
  for (auto& variant : variants) {
    variant.folder = variant.name.empty() ? "as_given" : folder_name(variant.name);
    if (const int number = ++used[variant.folder]; number > 1) variant.folder += fmt::format("_{}", number);
    if (variant.name.empty()) variant.name = "as given";
  }
  return variants;
}

RunOptions options_of(const Variant& variant, const RunOptions& base, const fs::path& folder) {
  RunOptions options = base;
  const LaunchPlan plan = make_launch_plan(base);
  std::map<std::string, YAML::Node> changed;
  for (const auto& setting : variant.settings) {
    const fs::path file = file_of(setting.file, plan);
    try {
      auto [node, added] = changed.try_emplace(setting.file);
      if (added) node->second = YAML::LoadFile(file.string());
      set(node->second, CLI::detail::split(setting.key, '.'), setting, file);
    } catch (const YAML::Exception& error) {
      throw ConfigurationError(
          fmt::format("--vary {}={}: {}: {}", setting.key, setting.value, file.string(), error.what()));
    }
  }
  for (const auto& [name, node] : changed) {
    fs::create_directories(folder);
    // The name of a run is that of its scenario's file.
    const fs::path file =
        folder / (name == "scenario" ? plan.manifest.scenario_file.filename() : fs::path(name + ".yaml"));
    std::ostringstream content;
    content << "# " << variant.name << "\n" << node << "\n";
    std::ostringstream present;
    present << std::ifstream(file).rdbuf();
    // An evaluation that goes on needs no space for the file that it has.
    if (present.str() != content.str()) write_whole(file, content.str());
    if (name == "scenario") options.scenario = file.string();
    else if (name == "robot") options.robot = file.string();
    else options.config_files.push_back(name + "=" + file.string());
  }
  return options;
}

}  // namespace constrictor::cli
