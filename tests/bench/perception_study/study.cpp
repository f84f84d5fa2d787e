#include "bench/perception_study/study.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <limits>
#include <nlohmann/json.hpp>
#include <set>
#include <stdexcept>

#include "configuration/configuration.hpp"

namespace constrictor::perception_study {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

constexpr double kAnyLevel = 1e6;

Factor read_factor(Configuration& row) {
  Factor factor;
  factor.name = row.text("name");
  const bool plain = !factor.name.empty() && factor.name != kReferenceFolder &&
                     factor.name.find_first_not_of("abcdefghijklmnopqrstuvwxyz0123456789_") == std::string::npos;
  if (!plain) {
    throw row.error("name", fmt::format("found '{}', accepted small letters, digits and _, and not '{}'", factor.name,
                                        kReferenceFolder));
  }
  factor.title = row.text("title");
  factor.axis = row.text("axis");
  factor.reference = row.number("reference", {-kAnyLevel, kAnyLevel});
  factor.levels = row.numbers("levels", {-kAnyLevel, kAnyLevel}, 1, 20);
  factor.settings = row.texts("vary");
  if (factor.settings.empty()) throw row.error("vary", "found nothing, accepted one or more settings");
  const std::string values = fmt::format("{:g}", fmt::join(factor.levels, ","));
  for (auto& setting : factor.settings) {
    if (const auto at = setting.find('@'); at != std::string::npos) setting.replace(at, 1, values);
  }
  row.finish();
  return factor;
}

const json& part(const json& object, const char* key) {
  const auto found = object.find(key);
  if (found == object.end()) throw std::runtime_error(fmt::format("{} is missing", key));
  return *found;
}

/// JSON has no NaN: an unknown figure is null.
double figure(const json& object, const char* key) {
  const json& value = part(object, key);
  return value.is_number() ? value.get<double>() : std::numeric_limits<double>::quiet_NaN();
}

Quartiles quartiles(const json& object) {
  return {figure(object, "p25"), figure(object, "median"), figure(object, "p75")};
}

LevelResult read_level(const json& variant, double level, bool reference) {
  LevelResult result;
  result.level = level;
  result.reference = reference;
  result.runs = part(variant, "runs").get<std::size_t>();
  result.errors = part(variant, "errors").get<std::size_t>();
  result.false_successes = part(variant, "false_successes").get<std::size_t>();
  const json& success = part(part(variant, "phases"), "mission succeeded");
  result.successes = part(success, "runs").get<std::size_t>();
  part(success, "wilson_95").at(0).get_to(result.wilson_low);
  part(success, "wilson_95").at(1).get_to(result.wilson_high);
  result.placement_m = quartiles(part(variant, "placement_m"));
  result.time_s = quartiles(part(variant, "mission_time_s"));
  return result;
}

/// The results of one evaluation that has these levels.
std::vector<LevelResult> read_evaluation(const fs::path& folder, const std::vector<double>& levels, bool reference) {
  const fs::path file = folder / "summary.json";
  std::ifstream stream(file);
  if (!stream) return {};
  try {
    const json summary = json::parse(stream);
    const json& variants = part(summary, "variants");
    if (!variants.is_array() || variants.size() != levels.size()) {
      throw std::runtime_error(
          fmt::format("found {} variants, accepted {}, one for each level", variants.size(), levels.size()));
    }
    std::vector<LevelResult> results;
    for (std::size_t i = 0; i < levels.size(); ++i) results.push_back(read_level(variants[i], levels[i], reference));
    std::erase_if(results, [](const LevelResult& result) { return result.runs == 0; });
    return results;
  } catch (const std::exception& error) {
    throw std::runtime_error(fmt::format("{}: {}", file.string(), error.what()));
  }
}

std::string known(double value, int decimals, const char* unknown = "") {
  return std::isfinite(value) ? fmt::format("{:.{}f}", value, decimals) : unknown;
}

}  // namespace

std::vector<Factor> read_factors(const fs::path& file) {
  Configuration root = Configuration::load(file);
  std::vector<Factor> factors;
  std::set<std::string> names;
  for (auto& row : root.list("factors")) {
    factors.push_back(read_factor(row));
    if (!names.insert(factors.back().name).second)
      throw row.error("name", fmt::format("found '{}' a second time, accepted each name once", factors.back().name));
  }
  if (factors.empty()) throw root.error("factors", "found nothing, accepted one or more");
  root.finish();
  return factors;
}

std::vector<LevelResult> read_results(const fs::path& study, const Factor& factor) {
  std::vector<LevelResult> results = read_evaluation(study / factor.name, factor.levels, false);
  if (results.empty()) return results;
  for (const auto& reference : read_evaluation(study / kReferenceFolder, {factor.reference}, true))
    results.push_back(reference);
  std::stable_sort(results.begin(), results.end(),
                   [](const LevelResult& a, const LevelResult& b) { return a.level < b.level; });
  return results;
}

std::string to_csv(const std::vector<Factor>& factors, const std::vector<std::vector<LevelResult>>& results) {
  std::string text =
      "factor,level,reference,runs,succeeded,wilson_low,wilson_high,false_successes,errors,placement_p25_m,"
      "placement_median_m,placement_p75_m,time_p25_s,time_median_s,time_p75_s\r\n";
  for (std::size_t i = 0; i < factors.size(); ++i) {
    for (const auto& level : results[i]) {
      text += fmt::format("{},{:g},{:d},{},{},{:.4f},{:.4f},{},{},{},{},{},{},{},{}\r\n", factors[i].name, level.level,
                          level.reference, level.runs, level.successes, level.wilson_low, level.wilson_high,
                          level.false_successes, level.errors, known(level.placement_m.low, 4),
                          known(level.placement_m.median, 4), known(level.placement_m.high, 4),
                          known(level.time_s.low, 1), known(level.time_s.median, 1), known(level.time_s.high, 1));
    }
  }
  return text;
}

std::string to_markdown(const std::vector<Factor>& factors, const std::vector<std::vector<LevelResult>>& results) {
  std::string text =
      "| error | level | succeeded | 95 % interval | believed, but not true | placement [m] | time [s] |\n"
      "|---|---|---|---|---|---|---|\n";
  for (std::size_t i = 0; i < factors.size(); ++i) {
    for (const auto& level : results[i]) {
      text += fmt::format("| {} | {:g}{} | {} of {} | {:.0f} to {:.0f} % | {} | {} | {} |\n",
                          factors[i].title + ", " + factors[i].axis, level.level, level.reference ? " (none)" : "",
                          level.successes, level.runs, 100 * level.wilson_low, 100 * level.wilson_high,
                          level.false_successes, known(level.placement_m.median, 3, "–"),
                          known(level.time_s.median, 0, "–"));
    }
  }
  return text;
}

}  // namespace constrictor::perception_study
