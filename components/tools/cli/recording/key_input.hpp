// Single keys from a terminal.
#pragma once

#include <poll.h>
#include <termios.h>
#include <unistd.h>

#include <cerrno>
#include <chrono>
#include <thread>

namespace constrictor::cli {

/// Single keys from a terminal; nothing if the input is not a terminal, if the program runs in the background, or after
/// the terminal was closed. A program in the background does not touch the terminal, because it would be stopped.
class KeyInput {
 public:
  KeyInput() : terminal_(::isatty(STDIN_FILENO) == 1) { take_terminal(); }
  ~KeyInput() {
    if (taken_ && in_foreground()) ::tcsetattr(STDIN_FILENO, TCSANOW, &before_);
  }
  KeyInput(const KeyInput&) = delete;
  KeyInput& operator=(const KeyInput&) = delete;

  /// The key that was typed within `bound`; 0: none.
  [[nodiscard]] char read(std::chrono::milliseconds bound) {
    if (!take_terminal()) {
      std::this_thread::sleep_for(bound);
      return 0;
    }
    pollfd input{STDIN_FILENO, POLLIN, 0};
    if (::poll(&input, 1, static_cast<int>(bound.count())) <= 0) return 0;
    char key = 0;
    const ssize_t count = in_foreground() ? ::read(STDIN_FILENO, &key, 1) : -1;
    if (count == 0 || (count < 0 && errno != EINTR && in_foreground())) terminal_ = false;  // it was closed
    return count == 1 ? key : '\0';
  }

 private:
  [[nodiscard]] static bool in_foreground() { return ::tcgetpgrp(STDIN_FILENO) == ::getpgrp(); }

  /// Makes the terminal pass each key at once and without an echo, if it does not: a shell takes this back when the
  /// user suspends the program and lets it continue. False if there are no keys for this program.
  bool take_terminal() {
    if (!terminal_ || !in_foreground()) return false;
    termios now{};
    if (::tcgetattr(STDIN_FILENO, &now) != 0) return terminal_ = false;
    constexpr auto kLines = static_cast<tcflag_t>(ICANON | ECHO);
    if ((now.c_lflag & kLines) == 0) return true;
    before_ = now;
    now.c_lflag &= ~kLines;
    ::tcsetattr(STDIN_FILENO, TCSANOW, &now);
    return taken_ = true;
  }

  termios before_{};
  bool terminal_;
  bool taken_ = false;
};

}  // namespace constrictor::cli
