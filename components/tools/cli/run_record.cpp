#include "cli/run_record.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>

#include <cerrno>
#include <chrono>
#include <fstream>
#include <nlohmann/json.hpp>
#include <optional>
#include <stdexcept>
#include <thread>

#include "configuration/configuration.hpp"
#include "configuration/whole_file.hpp"
#include "runtime/checkpoint_file.hpp"
#include "runtime/run_store.hpp"
#include "runtime/version.hpp"

namespace constrictor::cli {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

constexpr const char* kFile = "run.json";
constexpr auto kEndingBound = std::chrono::seconds(5);  // processes of a launcher that was killed end at once

}  // namespace

RunOptions absolute_options(RunOptions options, const LaunchPlan& plan) {
  options.scenario = plan.manifest.scenario_file.string();
  options.robot = plan.manifest.robot_file.string();
  options.manifest = find_file(options.manifest, kManifests).string();
  if (!options.secure.empty()) options.secure = fs::absolute(options.secure);
  options.faults_file = plan.manifest.faults_file;
  options.config_files.clear();
  for (const auto& [name, file] : plan.manifest.config_files)
    options.config_files.push_back(name + "=" + file.string());
  return options;
}

void write_run_record(const fs::path& folder, const RunRecord& record) {
  const RunOptions& options = record.options;
  const Json json = {{"version", kVersion},
                     {"run_id", record.run_id},
                     {"over", record.over},
                     {"incarnations", record.incarnations},
                     {"hosts_token", record.hosts_token},
                     {"scenario", options.scenario},
                     {"manifest", options.manifest},
                     {"robot", options.robot},
                     {"seed", options.seed},
                     {"pace", options.pace},
                     {"in_process", options.in_process},
                     {"groups", options.groups},
                     {"max_sim_time_s", options.max_sim_time_s},
                     {"record", options.record},
                     {"images", options.images},
                     {"config_files", options.config_files},
                     {"secure", options.secure.string()},
                     {"faults", options.faults_file.string()}};
  write_whole(folder / kFile, json.dump(1) + "\n");
}

RunRecord read_run_record(const fs::path& folder) {
  const fs::path path = folder / kFile;
  const auto wrong = [&](const std::string& what) {
    return ConfigurationError(fmt::format("--resume: {}: {}", path.string(), what));
  };
  std::ifstream file(path);
  if (!file) throw wrong("found no such file, accepted the report directory of a run");
  RunRecord record;
  try {
    const Json json = Json::parse(file);
    const std::string version = json.at("version");
    if (version != kVersion)
      throw wrong(
          fmt::format("found release {}, accepted {}: another release computes other results", version, kVersion));
    record.run_id = json.at("run_id");
    record.over = json.at("over");
    record.hosts_token = json.at("hosts_token");
    record.incarnations = json.at("incarnations").get<std::map<std::string, std::uint32_t>>();
    RunOptions& options = record.options;
    options.scenario = json.at("scenario");
    options.manifest = json.at("manifest");
    options.robot = json.at("robot");
    options.seed = json.at("seed");
    options.pace = json.at("pace");
    options.in_process = json.at("in_process");
    options.groups = json.at("groups").get<std::vector<std::string>>();
    options.max_sim_time_s = json.at("max_sim_time_s");
    options.record = json.at("record");
    options.images = json.at("images");
    options.config_files = json.at("config_files").get<std::vector<std::string>>();
    options.secure = json.value("secure", "");
    options.faults_file = json.value("faults", "");
  } catch (const Json::exception& error) {
    throw wrong(fmt::format("it is damaged: {}", error.what()));
  }
  if (record.over) throw wrong("the run is over: there is nothing to continue");
  record.options.report_dir = fs::absolute(folder);
  return record;
}

Descriptor lock_run(const fs::path& folder) {
  Descriptor lock(::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC));
  if (!lock.open() || (::flock(lock.get(), LOCK_EX | LOCK_NB) != 0 && errno == EWOULDBLOCK))
    throw ConfigurationError(
        fmt::format("{}: another launcher uses this folder; is the run still going on?", folder.string()));
  return lock;
}

bool is_continuable(const LaunchManifest& manifest, const fs::path& folder, bool checkpoints) {
  if (!manifest.beside.empty()) return false;
  return fs::exists(folder / RunStore::kFile) || (!manifest.host_of_plant().empty() && checkpoints);
}

void require_continuable(const LaunchManifest& manifest) {
  if (manifest.beside.empty()) return;
  throw ConfigurationError(fmt::format(
      "--resume: found a run with {} beside it, accepted a run without programs beside it: the emulated "
      "world has ended with the launcher, and the robot of a new one is not where the run has left it. Start "
      "a new run",
      manifest.beside.front().program));
}

std::string prepare_checkpoint(const fs::path& folder) {
  const fs::path path = folder / RunStore::kFile;
  const fs::path copy = folder / RunStore::kCopy;
  if (!fs::exists(path) && !fs::exists(copy))
    throw ConfigurationError(fmt::format(
        "--resume: found no {} in {}: the run has not begun, keeps no checkpoints (--no-checkpoints), or is over",
        RunStore::kFile, folder.string()));
  const auto give_up = std::chrono::steady_clock::now() + kEndingBound;
  std::string problem;
  try {
    std::optional<CheckpointFile> file;
    while (!file) {
      try {
        file.emplace(path);
      } catch (const CheckpointInUse&) {
        if (std::chrono::steady_clock::now() > give_up) throw;
        std::this_thread::sleep_for(std::chrono::milliseconds(20));
      }
    }
    if (file->of_this_boot()) {
      try {
        if (file->read()) return "the run continues from its newest checkpoint";
        problem = "no checkpoint was stored";
      } catch (const std::runtime_error& error) {
        problem = error.what();
      }
    } else {
      problem = "the computer was started anew";
    }
    const auto saved = CheckpointFile::read_copy(copy);
    if (!saved && problem == "no checkpoint was stored")
      return "no checkpoint was stored: the run had not begun, or its disk was full; it begins anew";
    if (!saved) throw std::runtime_error(fmt::format("{}, and there is no copy {}", problem, copy.string()));
    file->clear();
    file->write(*saved);
  } catch (const std::runtime_error& error) {
    throw ConfigurationError(fmt::format("--resume: {}", error.what()));
  }
  return fmt::format("{}; the run continues from the copy that was synchronised with the disk", problem);
}

void remove_checkpoints(const fs::path& folder) {
  std::error_code ignored;
  fs::remove(folder / RunStore::kFile, ignored);
  fs::remove(folder / RunStore::kCopy, ignored);
}

}  // namespace constrictor::cli
