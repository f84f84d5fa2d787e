// `constrictor run` and `constrictor check`: a run as separate processes, from launch manifest to report.
#pragma once

#include <filesystem>

#include "cli/launch_plan.hpp"

namespace CLI {
class App;
}

namespace constrictor::cli {

/// Makes a new directory and returns its path: `wanted`, or `wanted` with -2, -3 ... appended if it exists already. Two
/// processes that call this at the same time get different directories. Throws std::filesystem::filesystem_error.
std::filesystem::path make_new_directory(const std::filesystem::path& wanted);

/// Makes sure that the disk of the folder has room for the files of a run. Otherwise removes the folder if it is empty,
/// and throws std::runtime_error.
void require_space(const std::filesystem::path& folder);

/// The directory for the report of a run, as an absolute path: options.report_dir, without the files of an earlier run,
/// or else a new one in runs/, named by the scenario. Throws std::filesystem::filesystem_error, and as require_space().
std::filesystem::path make_report_dir(const RunOptions& options, const std::filesystem::path& scenario);

/// Adds the options that `run`, `check` and `serve` share: those that name files, and the seed.
void add_file_options(CLI::App& app, RunOptions& options);

/// Carries out a run, or continues the one in `given.resume_dir`. Throws UsageError or ConfigurationError for faults
/// that are found before a process is started. Returns the exit status: 0 only after a successful mission.
int run_command(const RunOptions& given);

}  // namespace constrictor::cli
