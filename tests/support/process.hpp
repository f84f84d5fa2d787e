// Child processes of tests. Waits for them have bounds, and none of them survives its test.
#pragma once

#include <sys/types.h>
#include <chrono>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "support/project.hpp"
#include "support/temporary_folder.hpp"

namespace constrictor::testing {

class Process {
 public:
  /// Starts the program `arguments[0]` and collects its output and its errors in files. `environment` is added to the
  /// environment of this process.
  explicit Process(std::vector<std::string> arguments, const std::map<std::string, std::string>& environment = {});
  Process(Process&& other) noexcept;
  Process& operator=(Process&& other) noexcept;
  Process(const Process&) = delete;
  /// Kills the process if it still runs.
  ~Process();

  [[nodiscard]] pid_t pid() const { return pid_; }
  void signal(int number) const;
  /// Exit status, or 128 + signal; empty if it still runs after `bound`.
  std::optional<int> wait(std::chrono::seconds bound);
  [[nodiscard]] bool running();
  [[nodiscard]] std::string output() const;
  [[nodiscard]] std::string errors() const;
  /// Waits until the output or the errors contain `text`. Returns false if that does not happen within `bound`, or if
  /// the process ends before.
  bool wait_for(const std::string& text, std::chrono::seconds bound);

 private:
  void discard();
  pid_t pid_ = -1;
  std::optional<int> status_;
  std::unique_ptr<TemporaryFolder> folder_;  ///< of output and errors
};

/// The domain that a `constrictor run` has claimed and printed; 0 if it printed none in time.
unsigned domain_of(Process& run);

}  // namespace constrictor::testing
