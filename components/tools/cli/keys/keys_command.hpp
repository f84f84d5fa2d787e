// `constrictor keys`: makes the files with which the processes of a run know each other (DDS Security).
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "cli/launch_plan.hpp"

namespace constrictor::cli {

/// The name of the identity of a process: its components, joined by "+".
[[nodiscard]] std::string identity_of(const ProcessPlan& process);

/// The files that processes with these identities need, relative to the folder of the keys.
[[nodiscard]] std::vector<std::filesystem::path> files_of_identities(const std::vector<std::string>& identities);

/// Why the keys in `folder` cannot be used for this run: one line for each identity that is missing or has expired,
/// among those of the processes and the operator's. Processes with keys of their own are left out.
[[nodiscard]] std::string problems_of_keys(const std::filesystem::path& folder, const LaunchManifest& manifest);

/// Lets this process and those that it starts use the identities in `folder`. Throws ConfigurationError, with
/// everything that is missing or has expired and what to do, unless it has valid files for every process of the plan
/// and for the operator.
void use_keys(const std::filesystem::path& folder, const LaunchPlan& plan);

}  // namespace constrictor::cli
