// The first difference of two runs: tick, component, topic and field.
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
  std::string component;  ///< the writer of the topic
  std::string topic;
  std::string field;  ///< empty if a run was made without --record, or if a message is missing
  std::string a;      ///< the value in the first run, as text
  std::string b;
  std::uint64_t sequence_number = 0;  ///< of the message in its topic
};

/// Compares two logs, each ordered by (tick, topic, sequence number) as HashLog::read returns them. The plant ends
/// first, so messages of the last ticks may be missing from a log; that is not a difference.
std::optional<RunDifference> first_run_difference(const std::vector<HashLog::Entry>& a,
                                                  const std::vector<HashLog::Entry>& b);

/// Compares two runs, each given by its report directory or by its recording (run.mcap). Throws std::runtime_error if a
/// log is missing, damaged, or of a run that never ticked.
std::optional<RunDifference> compare_runs(const std::filesystem::path& a, const std::filesystem::path& b);

}  // namespace constrictor::cli
