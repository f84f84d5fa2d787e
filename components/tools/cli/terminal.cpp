#include "cli/terminal.hpp"

#include <fcntl.h>
#include <poll.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <csignal>
#include <stdexcept>
#include <string_view>

#include "common/interrupt.hpp"

namespace constrictor::cli {
namespace {

constexpr std::string_view kEnter = "\033[?1049h\033[?25l\033[2J";
constexpr std::string_view kLeave = "\033[0m\033[?25h\033[?1049l";

void put(std::string_view text) {
  while (!text.empty()) {
    const ssize_t written = ::write(STDOUT_FILENO, text.data(), text.size());
    if (written < 0 && errno != EINTR) return;
    if (written > 0) text.remove_prefix(static_cast<std::size_t>(written));
  }
}

/// Waits for a byte, or for the end of the pipe. At the end without a byte, the owner of the terminal has died:
/// restores the terminal.
[[noreturn]] void guard(int pipe, const termios& before) {
  for (const int number : {SIGINT, SIGTERM, SIGHUP, SIGQUIT, SIGTTOU, SIGTSTP}) ::signal(number, SIG_IGN);
  char farewell = 0;
  ssize_t count = 0;
  do {
    count = ::read(pipe, &farewell, 1);
  } while (count < 0 && errno == EINTR);
  if (count == 0) {
    put(kLeave);
    ::tcsetattr(STDIN_FILENO, TCSANOW, &before);
  }
  ::_exit(0);
}

}  // namespace

Terminal::Terminal() {
  if (::isatty(STDIN_FILENO) == 0 || ::isatty(STDOUT_FILENO) == 0 || ::tcgetattr(STDIN_FILENO, &before_) != 0) {
    throw std::runtime_error(
        "teleop needs a terminal; without one use `constrictor teleop --drive` or `constrictor task`");
  }
  int ends[2];
  if (::pipe2(ends, O_CLOEXEC) != 0) throw std::runtime_error("pipe failed");
  guardian_ = ::fork();
  if (guardian_ == 0) {
    ::close(ends[1]);
    guard(ends[0], before_);
  }
  ::close(ends[0]);
  guardian_pipe_ = ends[1];
  catch_interrupts();
  ::signal(SIGPIPE, SIG_IGN);
  // A handler that does nothing: a change of the size ends read(), so that the screen is drawn anew at once.
  struct sigaction resized {};
  resized.sa_handler = [](int) {};
  ::sigaction(SIGWINCH, &resized, nullptr);
  ::signal(SIGTSTP, SIG_IGN);  // `input` would regard a suspended operator as dead
  termios raw = before_;
  raw.c_lflag &= ~static_cast<tcflag_t>(ICANON | ECHO | IEXTEN);
  raw.c_iflag &= ~static_cast<tcflag_t>(IXON | ICRNL);
  raw.c_cc[VMIN] = 1;  // if 0, a shell that reads before the guardian restores the terminal would see an end of input
  raw.c_cc[VTIME] = 0;
  ::tcsetattr(STDIN_FILENO, TCSANOW, &raw);
  put(kEnter);
}

Terminal::~Terminal() {
  put(kLeave);
  ::tcsetattr(STDIN_FILENO, TCSANOW, &before_);
  static_cast<void>(!::write(guardian_pipe_, "x", 1));
  ::close(guardian_pipe_);
  if (guardian_ > 0) ::waitpid(guardian_, nullptr, 0);
}

bool Terminal::read(std::string& typed, std::chrono::milliseconds bound) {
  typed.clear();
  pollfd descriptor{STDIN_FILENO, POLLIN, 0};
  const int ready = ::poll(&descriptor, 1, static_cast<int>(bound.count()));
  if (ready <= 0) return ready == 0 || errno == EINTR;
  if (descriptor.revents & (POLLERR | POLLNVAL)) return false;
  char bytes[64];
  const ssize_t count = ::read(STDIN_FILENO, bytes, sizeof bytes);
  if (count <= 0)
    return count < 0 && (errno == EINTR || errno == EAGAIN);  // readable without a byte: the terminal hung up
  typed.assign(bytes, static_cast<std::size_t>(count));
  return true;
}

void Terminal::draw(const std::vector<std::string>& lines, ScreenSize size) {
  std::string text;
  if (size != drawn_size_) {
    text = "\033[2J";  // clear the screen: a resize moves its content
    drawn_.clear();
  }
  for (std::size_t row = 0; row < lines.size(); ++row) {
    if (row < drawn_.size() && drawn_[row] == lines[row]) continue;
    text += "\033[" + std::to_string(row + 1) + ";1H\033[0m\033[K" + lines[row];
  }
  drawn_ = lines;
  drawn_size_ = size;
  put(text);
}

}  // namespace constrictor::cli
