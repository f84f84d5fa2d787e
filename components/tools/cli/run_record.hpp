// The data on a run that `constrictor run --resume` needs besides the checkpoint: the file run.json in the run's
// folder.
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <string>

#include "cli/launch_plan.hpp"
#include "cli/remote/message_channel.hpp"

namespace constrictor::cli {

struct RunRecord {
  RunOptions options;  ///< of the launcher that began the run; all files as absolute paths
  std::uint64_t run_id = 0;
  std::map<std::string, std::uint32_t> incarnations;  ///< newest incarnation of each process, by its name
  std::string hosts_token;                            ///< names the run for the agents of other hosts
  bool over = false;                                  ///< the run ended in order: there is nothing to continue
};

/// The options with which a run of this plan can be started again, whatever the present folder is then.
[[nodiscard]] RunOptions absolute_options(RunOptions options, const LaunchPlan& plan);

/// Replaces `folder`/run.json as a whole. Throws std::runtime_error if it cannot be written.
void write_run_record(const std::filesystem::path& folder, const RunRecord& record);
/// Throws ConfigurationError if there is no such file, if it is of another release, or if the run is over.
[[nodiscard]] RunRecord read_run_record(const std::filesystem::path& folder);

/// Keeps other launchers away from the run in `folder` as long as the returned descriptor is open. Throws
/// ConfigurationError if another one has it.
[[nodiscard]] Descriptor lock_run(const std::filesystem::path& folder);
/// Makes sure that the plant will find a complete checkpoint: the newest one, or the copy on the disk if the computer
/// was started anew or the newest one is damaged. Waits a few seconds for processes of the run that are still ending.
/// Returns a line for the user. Throws ConfigurationError if the run is still going on, or if there is no complete
/// checkpoint.
std::string prepare_checkpoint(const std::filesystem::path& folder);
/// Removes the checkpoints of a run that is over.
void remove_checkpoints(const std::filesystem::path& folder);

/// Whether a run that was interrupted can be continued. `checkpoints`: the run was started with checkpoints.
[[nodiscard]] bool is_continuable(const LaunchManifest& manifest, const std::filesystem::path& folder,
                                  bool checkpoints);
/// Throws ConfigurationError if the run has programs beside it: their state has ended with their launcher.
void require_continuable(const LaunchManifest& manifest);

}  // namespace constrictor::cli
