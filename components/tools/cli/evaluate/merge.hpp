// Gathers the runs of several machines.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "cli/evaluate/evaluation.hpp"

namespace constrictor::cli {

/// The seeds of the evaluations in these folders, sorted. Throws UsageError if a folder holds none.
[[nodiscard]] std::vector<std::uint64_t> seeds_of(const std::vector<std::filesystem::path>& folders);

/// Copies the runs that are over from folders that hold parts of the requested evaluation into request.folder. A run
/// that is there already, and not an error, stays. Returns the reasons why runs could not be copied; the others are
/// copied all the same. Throws UsageError if a folder holds another evaluation.
[[nodiscard]] std::vector<std::string> merge_evaluations(const std::vector<std::filesystem::path>& folders,
                                                         const EvaluationRequest& request);

}  // namespace constrictor::cli
