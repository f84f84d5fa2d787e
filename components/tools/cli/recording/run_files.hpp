// The files of a run that its recording contains, whichever program makes the recording.
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "cli/launch_plan.hpp"
#include "recording/mcap_format.hpp"

namespace constrictor::cli {

/// Manifest, faults and configurations of a run, by their names in a recording. `options`: those of the launcher, with
/// absolute files (absolute_options()). Starts constrictor_host, which knows the default configurations. Throws
/// std::runtime_error if it fails.
[[nodiscard]] std::map<std::string, std::filesystem::path> recorded_files(const RunOptions& options,
                                                                          const std::vector<std::string>& roster);

struct RunFiles {
  std::vector<mcap::Attachment> attachments;
  std::string missing;  ///< what is missing among them and why; empty: nothing
};

/// The attachments that `run --record` would write for the run in this domain: scenario, robot, manifest, faults,
/// configurations and versions, as the files are now. The launcher's folder names them, so that the run must have been
/// started on this host.
[[nodiscard]] RunFiles files_of_run(std::uint32_t domain);

}  // namespace constrictor::cli
