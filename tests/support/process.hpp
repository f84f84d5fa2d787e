// Real processes for tests: started with arguments, watched with bounds, and never left running.
#pragma once

#include <sys/types.h>
#include <chrono>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "support/temporary_folder.hpp"

namespace constrictor::testing {

class Process {
 public:
  /// Starts `arguments[0]`; output and errors are collected in files. `environment` is added to this process's own.
  explicit Process(std::vector<std::string> arguments, const std::map<std::string, std::string>& environment = {});
  Process(Process&& other) noexcept;
  Process& operator=(Process&& other) noexcept;
  Process(const Process&) = delete;
  /// Kills what still runs.
  ~Process();

  [[nodiscard]] pid_t pid() const { return pid_; }
  void signal(int number) const;
  /// Exit status, or 128 + signal; empty if it still runs after `bound`.
  std::optional<int> wait(std::chrono::seconds bound);
  [[nodiscard]] bool running();
  [[nodiscard]] std::string output() const;
  [[nodiscard]] std::string errors() const;
  /// True once `text` stands in the output or the errors; false if not within `bound` or when it ended without.
  bool wait_for(const std::string& text, std::chrono::seconds bound);

 private:
  void discard();
  pid_t pid_ = -1;
  std::optional<int> status_;
  std::unique_ptr<TemporaryFolder> folder_;  ///< of output and errors
};

/// Path of a program of this build.
std::string program(const std::string& name);

}  // namespace constrictor::testing
