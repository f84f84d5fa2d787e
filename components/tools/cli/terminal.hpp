// A terminal in full-screen mode that is restored however the program ends.
#pragma once

#include <sys/types.h>
#include <termios.h>

#include <chrono>
#include <string>
#include <vector>

#include "common/screen_size.hpp"

namespace constrictor::cli {

/// Alternate screen, no echo, keys one by one. A guardian process restores the terminal also if this process is killed.
/// The constructor calls catch_interrupts(): Ctrl-C only sets interrupt_signal().
class Terminal {
 public:
  /// Throws std::runtime_error if input or output is not a terminal. Forks: create it before any thread.
  Terminal();
  ~Terminal();
  Terminal(const Terminal&) = delete;
  Terminal& operator=(const Terminal&) = delete;

  /// Waits for keys or for another size of the terminal, at most `bound`; `typed` is empty if there were no keys.
  /// Returns false if the terminal is gone.
  bool read(std::string& typed, std::chrono::milliseconds bound);
  /// Draws the lines that differ from those drawn before; all of them if `size` has changed.
  void draw(const std::vector<std::string>& lines, ScreenSize size);

 private:
  termios before_{};
  int guardian_pipe_ = -1;
  pid_t guardian_ = -1;
  std::vector<std::string> drawn_;
  ScreenSize drawn_size_{0, 0};
};

}  // namespace constrictor::cli
