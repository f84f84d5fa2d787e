// A terminal in full-screen mode that is itself again however its user ends.
#pragma once

#include <sys/types.h>
#include <termios.h>

#include <chrono>
#include <string>
#include <vector>

namespace constrictor::cli {

/// Alternate screen, no echo, keys one by one. A small guardian process restores the terminal also if this one is killed.
/// Signals (TERM, HUP, INT, QUIT) only set interrupted().
class Terminal {
 public:
  /// Throws std::runtime_error if input or output is no terminal. Forks: to be made before any thread.
  Terminal();
  ~Terminal();
  Terminal(const Terminal&) = delete;
  Terminal& operator=(const Terminal&) = delete;

  /// What was typed within `bound`; empty if nothing. False once the terminal is gone.
  bool read(std::string& typed, std::chrono::milliseconds bound);
  /// Draws what differs from the lines drawn before.
  void draw(const std::vector<std::string>& lines);
  [[nodiscard]] static bool interrupted();

 private:
  termios before_{};
  int guardian_pipe_ = -1;
  pid_t guardian_ = -1;
  std::vector<std::string> drawn_;
};

}  // namespace constrictor::cli
