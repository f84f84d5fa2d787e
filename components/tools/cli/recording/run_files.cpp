#include "cli/recording/run_files.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <sstream>
#include <utility>

#include "cli/run_record.hpp"
#include "client/run_registry.hpp"
#include "configuration/configuration.hpp"
#include "runtime/recorded_files.hpp"

namespace constrictor::cli {
namespace {

namespace fs = std::filesystem;

std::string file_of_configuration(const std::string& component) { return "configuration/" + component + ".yaml"; }

/// The description of the build by constrictor_host: its numeric profile, libraries and default configurations.
struct BuildDescription {
  std::string numeric_profile;
  std::vector<std::pair<std::string, std::string>> libraries;
  std::map<std::string, fs::path> configurations;  ///< by component
};

BuildDescription describe_build() {
  BuildDescription build;
  for (const auto& line : ask_host("--describe")) {
    std::istringstream words(line);
    std::string kind, name, rest;
    words >> kind;
    if (kind == "profile") {
      std::getline(words >> std::ws, build.numeric_profile);
      continue;
    }
    words >> name;
    std::getline(words >> std::ws, rest);
    if (kind == "library") build.libraries.emplace_back(name, rest);
    if (kind == "default" && !rest.empty()) build.configurations[name] = rest;
  }
  return build;
}

std::map<std::string, fs::path> files_of(const RunOptions& options, const std::vector<std::string>& roster,
                                         const BuildDescription& build) {
  std::map<std::string, fs::path> files;
  for (const auto& [name, file] : build.configurations) {
    if (std::find(roster.begin(), roster.end(), name) != roster.end()) files[file_of_configuration(name)] = file;
  }
  for (const auto& text : options.config_files) {
    const auto equals = std::min(text.find('='), text.size());
    const std::string name = text.substr(0, equals);
    if (std::find(roster.begin(), roster.end(), name) != roster.end())
      files[file_of_configuration(name)] = text.substr(std::min(equals + 1, text.size()));
  }
  files["manifest.yaml"] = options.manifest;
  if (!options.faults_file.empty()) files["faults.yaml"] = options.faults_file;
  return files;
}

}  // namespace

std::map<std::string, fs::path> recorded_files(const RunOptions& options, const std::vector<std::string>& roster) {
  return files_of(options, roster, describe_build());
}

RunFiles files_of_run(std::uint32_t domain) {
  RunFiles files;
  const auto run = live_run(domain);
  if (!run) {
    files.missing = fmt::format(
        "the recording has no attachments (scenario, robot, manifest, configuration, versions): this host has started "
        "no run in DDS domain {}",
        domain);
    return files;
  }
  try {
    const RunOptions options = read_run_record(run->report_dir).options;
    const BuildDescription build = describe_build();
    auto wanted = files_of(options, run->roster, build);
    wanted["scenario.yaml"] = options.scenario;
    wanted["robot.yaml"] = options.robot;
    for (const auto& [name, file] : wanted) {
      if (auto attachment = attached_file(name, file)) files.attachments.push_back(std::move(*attachment));
      else files.missing += fmt::format("{}{}", files.missing.empty() ? "" : ", ", file.string());
    }
    if (!files.missing.empty())
      files.missing = "these files of the run cannot be read, and are not in the recording: " + files.missing;
    files.attachments.push_back(attached_versions(build.numeric_profile, build.libraries));
  } catch (const std::exception& error) {
    files.missing = fmt::format(
        "the recording has no attachments (scenario, robot, manifest, configuration, "
        "versions): {} does not describe the run: {}",
        run->report_dir.string(), error.what());
  }
  return files;
}

}  // namespace constrictor::cli
