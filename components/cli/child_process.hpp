// One process that the launcher started: it cannot outlive the launcher, and its last words are kept.
#pragma once

#include <sys/types.h>
#include <sys/wait.h>

#include <csignal>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace constrictor::cli {

/// How a process ended.
struct ChildExit {
  int wait_status = 0;    ///< as of waitpid
  double cpu_s = 0;       ///< [s] user and system time over its life

  [[nodiscard]] bool clean() const { return wait_status == 0; }
  /// Exit status; none if a signal killed it.
  [[nodiscard]] std::optional<int> code() const;
  /// True if SIGKILL or SIGTERM ended it: somebody's will, not its own fault.
  [[nodiscard]] bool killed_from_outside() const { return WIFSIGNALED(wait_status) && (WTERMSIG(wait_status) == SIGKILL || WTERMSIG(wait_status) == SIGTERM); }
  /// "exit status 78 (configuration)", "killed by signal 9 (Killed)".
  [[nodiscard]] std::string describe() const;
};

class ChildProcess {
 public:
  /// Starts `argv` with the environment `environment` ("NAME=VALUE", complete), its output appended to `log`. The kernel
  /// kills it when the thread that called this ends, in whatever way. Throws std::system_error.
  ChildProcess(const std::vector<std::string>& argv, const std::vector<std::string>& environment, const std::filesystem::path& log);
  ~ChildProcess();  ///< kills it if it still runs
  ChildProcess(ChildProcess&& other) noexcept;
  ChildProcess& operator=(ChildProcess&&) = delete;

  [[nodiscard]] pid_t pid() const { return pid_; }
  [[nodiscard]] bool running() const { return !exit_; }
  /// Looks whether it ended; never waits.
  const std::optional<ChildExit>& poll();
  void signal(int number) const;
  /// [MiB] memory in use, shared pages in proportion; 0 if it cannot be told.
  [[nodiscard]] double pss_mib() const;

 private:
  pid_t pid_ = -1;
  std::optional<ChildExit> exit_;
};

/// The last `count` lines of a log file from byte `offset` on.
std::vector<std::string> last_lines(const std::filesystem::path& log, std::uintmax_t offset, std::size_t count);

}  // namespace constrictor::cli
