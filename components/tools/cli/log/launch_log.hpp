// The log of `constrictor run` itself: in a file beside those of its processes, and on the topic `log`.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

#include "cli/run_observer.hpp"
#include "common/progress_display.hpp"
#include "log/log.hpp"
#include "runtime/log_publisher.hpp"

namespace constrictor::cli {

class LaunchLog {
 public:
  static constexpr const char* kName = "launcher";

  /// `folder`: of the logs; it is made. `continued`: the log of the launcher that began the run is continued. Display
  /// and participant must outlive this object. Throws std::exception if the file cannot be written.
  LaunchLog(ProgressDisplay& display, const std::filesystem::path& folder, std::int32_t participant,
            std::uint64_t run_id, bool continued);
  /// Waits until the last lines have been received, at most 0.2 s.
  ~LaunchLog();
  LaunchLog(const LaunchLog&) = delete;
  /// Prints and logs a line.
  void say(const std::string& line);
  /// The same for something that should not happen.
  void warn(const std::string& line);
  /// From now on lines carry the epoch and the tick of the run.
  void at(const RunView& view) const;

 private:
  ProgressDisplay& display_;
  std::int32_t participant_;
  std::uint64_t run_id_;
  Log log_;
  LogPublisher publisher_;
};

}  // namespace constrictor::cli
