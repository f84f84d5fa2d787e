#include "cli/evaluate/evaluation_record.hpp"

#include <fmt/format.h>

#include <fstream>
#include <nlohmann/json.hpp>
#include <span>
#include <sstream>

#include "configuration/configuration.hpp"
#include "configuration/whole_file.hpp"
#include "constrictor/hex.hpp"
#include "constrictor/sha256.hpp"
#include "runtime/version.hpp"

namespace constrictor::cli {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

constexpr const char* kRecordFile = "evaluation.json";

std::string hash_of(const fs::path& file) {
  if (file.empty()) return "none";
  std::ifstream stream(file, std::ios::binary);
  std::ostringstream bytes;
  bytes << stream.rdbuf();
  if (!stream) throw ConfigurationError(fmt::format("cannot read {}", file.string()));
  const std::string text = bytes.str();
  return hex(sha256(std::as_bytes(std::span(text))));
}

}  // namespace

std::map<std::string, std::string> identities_of(const RunOptions& options) {
  const LaunchPlan plan = make_launch_plan(options);
  std::map<std::string, std::string> identities{
      {"version", kVersion},
      {"program", hash_of(program_folder() / "constrictor_host")},
      {"manifest", hash_of(find_file(options.manifest, kManifests))},
      {"robot", hash_of(plan.manifest.robot_file)},
      {"scenario", hash_of(plan.manifest.scenario_file)},
      {"faults", hash_of(plan.manifest.faults_file)},
      {"max_sim_time_s", fmt::format("{}", options.max_sim_time_s)},
  };
  for (const auto& component : plan.roster)
    identities["configuration of " + component] = hash_of(config_file_of(component, plan));
  return identities;
}

void write_record(const fs::path& folder, const EvaluationRecord& record) {
  const json content = {
      {"scenario", record.scenario}, {"vary", record.vary}, {"seeds", record.seeds}, {"identities", record.identities}};
  write_whole(folder / kRecordFile, content.dump(1) + "\n");
}

std::optional<EvaluationRecord> read_record(const fs::path& folder) {
  std::ifstream stream(folder / kRecordFile);
  if (!stream) return {};
  try {
    const json content = json::parse(stream);
    EvaluationRecord record;
    content.at("scenario").get_to(record.scenario);
    content.at("vary").get_to(record.vary);
    content.at("seeds").get_to(record.seeds);
    content.at("identities").get_to(record.identities);
    return record;
  } catch (const json::exception& error) {
    throw ConfigurationError(
        fmt::format("{}: damaged ({}); choose another --output", (folder / kRecordFile).string(), error.what()));
  }
}

std::string difference(const EvaluationRecord& found, const EvaluationRecord& wanted) {
  if (found.vary != wanted.vary) {
    return fmt::format("--vary: found '{}' there, '{}' now", fmt::join(found.vary, " "), fmt::join(wanted.vary, " "));
  }
  for (const auto& [name, identity] : wanted.identities) {
    const auto there = found.identities.find(name);
    if (there != found.identities.end() && there->second == identity) continue;
    if (name == "scenario" && found.scenario != wanted.scenario)
      return fmt::format("it is of the scenario {}, and not of {}", found.scenario, wanted.scenario);
    return name + (there == found.identities.end() ? " did not belong to it" : " has changed since");
  }
  for (const auto& [name, identity] : found.identities) {
    if (!wanted.identities.contains(name)) return name + " no longer belongs to it";
  }
  return {};
}

}  // namespace constrictor::cli
