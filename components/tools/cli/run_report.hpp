// report.json: the report component's account of the mission, merged with the launcher's account of the processes.
#pragma once

#include <cstdint>
#include <filesystem>
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
  std::string error;       ///< why the run failed or its processes were killed; empty: the run ended in order
  std::string end_reason;  ///< why a run ended in order before its mission did: a user, the time limit; else empty
};

struct RunVerdict {
  bool success = false;
  std::string reason;     ///< why it is no success; empty only after success
  double sim_time_s = 0;  ///< [s] simulated
};

/// Merges `report_dir`/mission.json, if the report component wrote it, with `outcome`, `view` and `processes` into
/// `report_dir`/report.json. The run is a success if mission.json reports one and there is no error. The reason is the
/// first of these that is not empty: the error, the reason in mission.json (which the figure shows, too), the end
/// reason, and a remark that there is none. Throws std::runtime_error if the file cannot be written.
RunVerdict write_report(const std::filesystem::path& report_dir, const RunOutcome& outcome, const RunView& view,
                        const std::vector<ProcessRecord>& processes);

}  // namespace constrictor::cli
