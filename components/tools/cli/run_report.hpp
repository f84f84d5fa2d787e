// report.json: the report component's account of the mission, merged with the launcher's account of the processes.
#pragma once

#include <cstdint>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "cli/run_observer.hpp"
#include "cli/supervisor.hpp"

namespace constrictor::cli {

/// The end of a run as the launcher knows it.
struct RunOutcome {
  std::string scenario;
  std::uint64_t seed = 1;
  double wall_time_s = 0;  ///< [s] from the start of the processes to the plant's end
  std::string error;       ///< why the run failed or its processes were killed; empty if the run ended normally
  std::string end_reason;  ///< why the run ended normally, but before its mission (user, time limit); else empty
  nlohmann::ordered_json recording = nullptr;  ///< content of run.mcap; null: the run is not recorded
};

struct RunVerdict {
  bool success = false;
  std::string reason;      ///< why the run is not a success; empty only after success
  double sim_time_s = 0;   ///< [s] simulated
  std::string truth = {};  ///< what emulated devices say of their world (truth.json); empty: there are none
  /// For people: what emulated devices say of their world (truth.json), and which files could not be written.
  std::vector<std::string> notices = {};
};

/// Merges `report_dir`/mission.json, if the report component wrote it, with `outcome`, `view` and `processes` into
/// `report_dir`/report.json. The run is a success if mission.json reports one and there is no error. The reason is the
/// first of these texts that is not empty: the error, the reason in mission.json (which the figure also shows), the end
/// reason. If all are empty, it says that the report component gave no reason, or that none judged the mission.
/// `hosts`: HostSet::report(). The file truth.json of emulated devices becomes the key `truth`; it does not decide the
/// success. A report.json that cannot be written is named in the verdict.
RunVerdict write_report(const std::filesystem::path& report_dir, const RunOutcome& outcome, const RunView& view,
                        const std::vector<ProcessRecord>& processes, const nlohmann::ordered_json& hosts = {});

}  // namespace constrictor::cli
