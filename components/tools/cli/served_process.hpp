// One process that `constrictor serve` keeps alive from run to run.
#pragma once

#include <chrono>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "cli/child_process.hpp"

namespace constrictor::cli {

/// The number of the last incarnation of a process on this host, kept in a file. A run accepts a process that comes
/// back only with a higher incarnation than before, also after the host was started again.
class IncarnationFile {
 public:
  explicit IncarnationFile(std::filesystem::path file) : file_(std::move(file)) {}
  /// One more than the last time; 1 if there is no file, or nothing useful in it. Throws std::runtime_error if the file
  /// cannot be written.
  std::uint32_t next();

 private:
  std::filesystem::path file_;
};

class ServedProcess {
 public:
  using Clock = std::chrono::steady_clock;
  /// The command line of an incarnation. `same_run`: the process comes back to the run that it belonged to.
  using CommandLine = std::function<std::vector<std::string>(std::uint32_t incarnation, bool same_run)>;
  using Print = std::function<void(const std::string& line)>;

  ServedProcess(std::string name, CommandLine command_line, std::vector<std::string> environment,
                std::filesystem::path incarnation_file, Print print);
  ~ServedProcess();  ///< kills the process if it still runs
  ServedProcess(const ServedProcess&) = delete;
  ServedProcess& operator=(const ServedProcess&) = delete;

  /// Prints what the process has written, and starts it (again) when it is time. After a run the process waits for the
  /// next one at once. If it died soon after its start, or was refused, it is started again after a pause that doubles
  /// from 0.2 s to 10 s. Returns the exit status of a process that a new start cannot help (usage, configuration, no
  /// such program). Throws std::system_error.
  std::optional<int> poll();
  /// Sends the signal to the process if it runs. It is not started again.
  void stop(int signal);
  [[nodiscard]] bool running() const { return child_ != nullptr; }
  [[nodiscard]] const std::string& name() const { return name_; }

 private:
  void start();
  std::optional<int> handle_exit(const ChildExit& exit);
  void forward_output();

  std::string name_;
  CommandLine command_line_;
  std::vector<std::string> environment_;
  IncarnationFile incarnations_;
  Print print_;
  std::unique_ptr<ChildProcess> child_;
  int output_[2] = {-1, -1};  ///< a pipe: to read from, and to write to
  std::string unfinished_line_;
  Clock::time_point started_{};
  Clock::time_point start_at_{};
  std::chrono::milliseconds pause_{0};
  bool same_run_ = false;
  bool waited_ = false;  ///< the last incarnation ended because no run began
  bool stopping_ = false;
};

}  // namespace constrictor::cli
