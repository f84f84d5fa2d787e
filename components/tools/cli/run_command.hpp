// `constrictor run` and `constrictor check`: a run as separate processes, from launch manifest to report.
#pragma once

#include <filesystem>

#include "cli/launch_plan.hpp"

namespace constrictor::cli {

/// Makes a directory that did not exist before, also if other processes do the same at this moment: `wanted`, or that
/// with -2, -3 ... appended. Throws std::filesystem::filesystem_error.
std::filesystem::path make_new_directory(const std::filesystem::path& wanted);

/// Throws UsageError or ConfigurationError for whatever is wrong before anything is started. Returns the exit status:
/// 0 only after a successful mission.
int run_command(const RunOptions& options);

}  // namespace constrictor::cli
