// Log lines of any origin (the topic `log`, log files), which of them a user wants, and how they are printed.
#pragma once

#include <cstdint>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "constrictor/messages.hpp"
#include "log/log.hpp"

namespace constrictor::cli {

/// A line with the process that wrote it. What is not known is empty or 0.
struct LogEntry {
  LogRecord record;
  std::string process;  ///< its components, comma separated, or the name of the program
  std::string host;
  std::int32_t pid = 0;
  std::uint32_t incarnation = 0;
  /// The line was written by a library, directly into the file: it has the time of the line before, and counts as a
  /// warning.
  bool foreign = false;
};

[[nodiscard]] LogEntry entry_of(const msg::LogLine& line);

/// Which lines a user wants.
struct LogFilter {
  std::uint8_t least_level = msg::kLogInfo;
  std::vector<std::string> components;  ///< empty: all
  std::int64_t since_tick = -1;         ///< lines of earlier ticks are left out; -1: none are
  std::string text;                     ///< part of the message; empty: any

  [[nodiscard]] bool accepts(const LogEntry& entry) const;
};

/// The text of a line as in a log file; it contains the host if that is not `own_host`.
[[nodiscard]] std::string text_of(const LogEntry& entry, const std::string& own_host);
[[nodiscard]] nlohmann::ordered_json to_json(const LogEntry& entry);

/// The lines of one log file that the filter accepts, in their order.
[[nodiscard]] std::vector<LogEntry> read_log_file(const std::filesystem::path& file, const LogFilter& filter);
/// The lines of all log files of a run, in the order of their time; lines of one file keep their order. `folder`: of a
/// report, or its folder `logs`. Throws std::runtime_error if there are no log files.
[[nodiscard]] std::vector<LogEntry> read_logs(const std::filesystem::path& folder, const LogFilter& filter);

}  // namespace constrictor::cli
