// A named pipe from which an emulator reads commands, one a line.
#pragma once

#include <filesystem>
#include <functional>
#include <string>

namespace constrictor::emulation {

class CommandPipe {
 public:
  /// Makes the pipe, in place of an older file, and locks it as long as this process runs: one emulator of a name uses
  /// a folder. Throws ConfigurationError if another one does, and std::system_error.
  explicit CommandPipe(std::filesystem::path file);
  ~CommandPipe();
  CommandPipe(const CommandPipe&) = delete;
  CommandPipe& operator=(const CommandPipe&) = delete;
  [[nodiscard]] int descriptor() const { return descriptor_; }

  /// Calls `use` for each whole line that has arrived. Never waits.
  void read(const std::function<void(const std::string& line)>& use);

 private:
  /// Makes, opens and locks the pipe; false if it must be tried again.
  [[nodiscard]] bool claim();
  std::filesystem::path file_;
  int descriptor_ = -1;
  std::string text_;
};

}  // namespace constrictor::emulation
