// The files by which an evaluation can be continued: what it evaluates, and the outcome of each run.
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "cli/evaluate/variation.hpp"
#include "cli/launch_plan.hpp"

namespace constrictor::cli {

/// evaluation.json: which evaluation the folder holds. Results of two different evaluations must not be mixed.
struct EvaluationRecord {
  std::string scenario;                           ///< name
  std::vector<std::string> vary;                  ///< as on the command line
  std::vector<std::uint64_t> seeds;               ///< of all calls so far
  std::map<std::string, std::string> identities;  ///< SHA-256 of each file and of the program; other options as text
};

/// The inputs on which every result of an evaluation depends, besides seed and variant.
[[nodiscard]] std::map<std::string, std::string> identities_of(const RunOptions& options);

void write_record(const std::filesystem::path& folder, const EvaluationRecord& record);
/// Empty if the folder holds no evaluation. Throws ConfigurationError if its file is damaged.
[[nodiscard]] std::optional<EvaluationRecord> read_record(const std::filesystem::path& folder);

/// How two records differ, as text for an error message; empty if they are of the same evaluation. Seeds may differ.
[[nodiscard]] std::string difference(const EvaluationRecord& found, const EvaluationRecord& wanted);

}  // namespace constrictor::cli
