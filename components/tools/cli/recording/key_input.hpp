// Single keys from a terminal.
#pragma once

#include <poll.h>
#include <termios.h>
#include <unistd.h>

#include <chrono>
#include <thread>

namespace constrictor::cli {

/// Single keys from a terminal; nothing if the input is not a terminal.
class KeyInput {
 public:
  KeyInput() : terminal_(::isatty(STDIN_FILENO) == 1 && ::tcgetattr(STDIN_FILENO, &before_) == 0) {
    if (!terminal_) return;
    termios raw = before_;
    raw.c_lflag &= static_cast<tcflag_t>(~(ICANON | ECHO));
    ::tcsetattr(STDIN_FILENO, TCSANOW, &raw);
  }
  ~KeyInput() {
    if (terminal_) ::tcsetattr(STDIN_FILENO, TCSANOW, &before_);
  }
  KeyInput(const KeyInput&) = delete;
  KeyInput& operator=(const KeyInput&) = delete;
  /// The key that was typed within `bound`; 0: none.
  [[nodiscard]] char read(std::chrono::milliseconds bound) const {
    if (!terminal_) {
      std::this_thread::sleep_for(bound);
      return 0;
    }
    pollfd input{STDIN_FILENO, POLLIN, 0};
    char key = 0;
    if (::poll(&input, 1, static_cast<int>(bound.count())) <= 0 || ::read(STDIN_FILENO, &key, 1) != 1) return 0;
    return key;
  }

 private:
  termios before_{};
  bool terminal_;
};

}  // namespace constrictor::cli
