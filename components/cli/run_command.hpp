// `constrictor run`: a whole run as separate processes, from launch manifest to report.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace constrictor::cli {

struct RunOptions {
  std::string scenario;                             ///< name in sim/scenarios or a path; empty: the manifest's
  std::string manifest = "case_study";              ///< name in deploy or a path
  std::string robot;                                ///< robot file; empty: the manifest's
  std::uint64_t seed = 1;
  std::string pace = "lockstep";                    ///< "lockstep", "realtime" or "2x"
  bool in_process = false;                          ///< every component in one process
  std::vector<std::vector<std::string>> groups;     ///< components that share a process
  std::filesystem::path report_dir;                 ///< empty: a new one under runs/
  double max_sim_time_s = 0;                        ///< [s] ends the run then; 0: never
  bool record = false;                              ///< log the messages themselves, for `constrictor diff`
  std::optional<std::uint32_t> domain;              ///< empty: the first free
  std::vector<std::string> config_files;            ///< "NAME=FILE"
};

/// Makes a directory that was not there before, even if others do the same at this moment: `wanted`, or that with -2, -3 ... appended.
/// Throws std::filesystem::filesystem_error.
std::filesystem::path make_new_directory(const std::filesystem::path& wanted);

/// Throws ConfigurationError for what is wrong before anything was started. Returns the exit status: 0 only after a
/// successful mission.
int run_command(const RunOptions& options);

}  // namespace constrictor::cli
