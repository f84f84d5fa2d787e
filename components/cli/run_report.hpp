// report.json: what the report component says of the mission, and what the launcher says of the processes.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "cli/run_observer.hpp"
#include "cli/supervisor.hpp"

namespace constrictor::cli {

struct RunOutcome {
  std::string scenario;
  std::uint64_t seed = 1;
  double wall_time_s = 0;   ///< [s] from starting the processes to the plant's end
  std::string error;        ///< why the run failed or was ended; empty: it ended by itself
};

/// Merges `report_dir`/mission.json, if the report component wrote it, with the launcher's knowledge into
/// `report_dir`/report.json. Returns whether the mission succeeded: the report says so and nothing failed.
bool write_report(const std::filesystem::path& report_dir, const RunOutcome& outcome, const RunView& view,
                  const std::vector<ProcessRecord>& processes);

}  // namespace constrictor::cli
