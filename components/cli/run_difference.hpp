// Where two runs part: the first tick, component, topic and field.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "runtime/hash_log.hpp"

namespace constrictor::cli {

struct RunDifference {
  std::int64_t tick = 0;
  std::string component;  ///< that wrote it
  std::string topic;
  std::string field;      ///< empty if the messages themselves were not recorded, or if a message is missing
  std::string a;          ///< what the first run has, as text
  std::string b;
};

/// Compares two logs, each ordered by (tick, topic, sequence) as HashLog::read gives them. What a member did in the last
/// ticks may be missing from a log, because the plant ends first: that is no difference; other contents are.
std::optional<RunDifference> first_run_difference(const std::vector<HashLog::Entry>& a, const std::vector<HashLog::Entry>& b);

/// Reads and compares two report directories. Throws std::runtime_error if a log is missing, damaged, or of a run that never ticked.
std::optional<RunDifference> compare_runs(const std::filesystem::path& a, const std::filesystem::path& b);

}  // namespace constrictor::cli
