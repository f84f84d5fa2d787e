// The log files of a run, and the bound on their size.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace constrictor::cli {

/// [byte] A log file that is larger is put aside, so that each process has at most about twice as much on the disk.
inline constexpr std::uintmax_t kMostLogBytes = 8 << 20;

/// The name of the process whose log this is: `physics` for logs/physics.log and logs/physics.old.log.
[[nodiscard]] std::string process_of_log(const std::filesystem::path& file);
/// All log files of a folder: for each process first the older one, then the present one.
[[nodiscard]] std::vector<std::filesystem::path> log_files(const std::filesystem::path& folder);
/// Removes the log of a process of an earlier run.
void remove_log(const std::filesystem::path& log);

/// Puts the content of a log larger than `most` aside, as NAME.old.log, in place of what was put aside before, and
/// empties the log; its first line then says how much was dropped. The process that writes it goes on; it must append
/// (O_APPEND). What it writes between the copy and the cut, some microseconds, is lost. Returns whether the log was
/// larger. Errors leave the log as it is.
bool bound_log(const std::filesystem::path& log, std::uintmax_t most = kMostLogBytes);
/// bound_log() for each log of a folder.
void bound_logs(const std::filesystem::path& folder, std::uintmax_t most = kMostLogBytes);

}  // namespace constrictor::cli
