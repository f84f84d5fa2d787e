// One process that the launcher started: on this host, where it cannot outlive the launcher, or on another one.
#pragma once

#include <sys/types.h>
#include <sys/wait.h>

#include <csignal>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace constrictor::cli {

/// Exit status of a child that could not execute its program, as shells use it.
inline constexpr int kNoSuchProgram = 127;

/// How a process ended.
struct ChildExit {
  int wait_status = 0;  ///< as waitpid reports it
  double cpu_s = 0;     ///< [s] user and system time over the life of the process

  /// Ended with exit status 0.
  [[nodiscard]] bool clean() const { return wait_status == 0; }
  /// Exit status; empty if a signal ended the process.
  [[nodiscard]] std::optional<int> code() const;
  /// Ended by SIGKILL or SIGTERM, which only other processes send.
  [[nodiscard]] bool killed_from_outside() const {
    return WIFSIGNALED(wait_status) && (WTERMSIG(wait_status) == SIGKILL || WTERMSIG(wait_status) == SIGTERM);
  }
  /// "ended with status 78 (configuration)", "was killed by signal 9 (Killed)".
  [[nodiscard]] std::string describe() const;
};

/// A process that the launcher started, on any host.
class Child {
 public:
  Child() = default;
  Child(const Child&) = delete;
  Child& operator=(const Child&) = delete;
  virtual ~Child() = default;  ///< kills the process if it still runs

  [[nodiscard]] virtual pid_t pid() const = 0;
  /// Returns how the process ended, or nothing while it runs. Never waits. Everything that the process wrote is in its
  /// log when this returns the end.
  virtual const std::optional<ChildExit>& poll() = 0;
  virtual void signal(int number) = 0;
  /// [MiB] memory in use, each shared page divided by the number of its users; 0 if it is not known.
  [[nodiscard]] virtual double pss_mib() const = 0;
};

/// fork() for a child that executes another program at once: the kernel kills the child when the calling thread ends,
/// Ctrl-C on the terminal does not reach it, and no signal is blocked in it. Returns as fork() does.
[[nodiscard]] pid_t fork_bound_to_caller();

/// A process on this host.
class ChildProcess : public Child {
 public:
  /// Starts `argv` with the environment `environment` ("NAME=VALUE", complete); its output is appended to `log`. The
  /// kernel kills the process when the thread that called this ends, however it ends. Throws std::system_error.
  ChildProcess(const std::vector<std::string>& argv, const std::vector<std::string>& environment,
               const std::filesystem::path& log);
  ~ChildProcess() override;

  [[nodiscard]] pid_t pid() const override { return pid_; }
  [[nodiscard]] bool running() const { return !exit_; }
  const std::optional<ChildExit>& poll() override;
  void signal(int number) override;
  [[nodiscard]] double pss_mib() const override;

 private:
  pid_t pid_ = -1;
  std::optional<ChildExit> exit_;
};

/// The last `count` lines of a log file after byte `offset`, without empty lines.
std::vector<std::string> last_lines(const std::filesystem::path& log, std::uintmax_t offset, std::size_t count);

}  // namespace constrictor::cli
