// `constrictor keys`: makes the files with which the processes of a run know each other (DDS Security).
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "cli/launch_plan.hpp"

namespace constrictor::cli {

/// The name of the identity of a process: its components, joined by "+".
[[nodiscard]] std::string identity_of(const ProcessPlan& process);

/// Checks that `folder` has valid files for every process of the plan and for the operator. Throws ConfigurationError
/// with everything that is missing or has expired, and what to do.
void check_keys(const std::filesystem::path& folder, const LaunchPlan& plan);

}  // namespace constrictor::cli
