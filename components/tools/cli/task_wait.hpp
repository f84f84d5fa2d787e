// `constrictor task wait`: waits for an event of a goal, or for its end.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

namespace constrictor::cli {

struct TaskWaitOptions {
  std::string goal;   ///< a goal's number or id, "any", or empty: the newest goal
  std::string event;  ///< name of the event; empty with `end`
  bool end = false;   ///< wait for the end of the goal
  std::string timeout = "60s";
  bool json = false;  ///< print what came as one JSON object
};

/// Waits in the run of this DDS domain; returns the exit status. Events of the goal that happened before the call count
/// too, so that none is missed between `task start` and `task wait`; with goal "any" only later events count.
/// Throws UsageError.
int task_wait(const TaskWaitOptions& options, std::optional<std::uint32_t> run);

}  // namespace constrictor::cli
