// The keys of `constrictor replay`, on a pseudoterminal.
#include "cli/recording/key_input.hpp"

#include <gtest/gtest.h>
#include <pty.h>
#include <signal.h>
#include <sys/wait.h>

#include <functional>

namespace constrictor::cli {
namespace {

using namespace std::chrono_literals;
using Clock = std::chrono::steady_clock;

constexpr int kAsExpected = 7;

/// A child whose standard input is a pseudoterminal, of whose session it is the leader.
class OnTerminal {
 public:
  explicit OnTerminal(const std::function<bool()>& test) : child_(::forkpty(&person_, nullptr, nullptr, nullptr)) {
    if (child_ != 0) return;
    ::alarm(20);  // a test that waits for ever fails
    ::_exit(test() ? kAsExpected : 1);
  }
  ~OnTerminal() { hang_up(); }
  OnTerminal(const OnTerminal&) = delete;
  OnTerminal& operator=(const OnTerminal&) = delete;

  void type(char key) const { EXPECT_EQ(::write(person_, &key, 1), 1); }
  /// Waits until the child has called ready().
  void await_ready() const {
    char said = 0;
    EXPECT_EQ(::read(person_, &said, 1), 1);
  }
  static void ready() { static_cast<void>(!::write(STDOUT_FILENO, "r", 1)); }
  void hang_up() {
    if (person_ >= 0) ::close(person_);
    person_ = -1;
  }
  [[nodiscard]] bool as_expected() const {
    int status = 0;
    return ::waitpid(child_, &status, 0) == child_ && WIFEXITED(status) && WEXITSTATUS(status) == kAsExpected;
  }

 private:
  int person_ = -1;
  pid_t child_;
};

bool reads_lines() {
  termios now{};
  return ::tcgetattr(STDIN_FILENO, &now) == 0 && (now.c_lflag & ICANON) != 0 && (now.c_lflag & ECHO) != 0;
}

void set_lines() {
  termios now{};
  ::tcgetattr(STDIN_FILENO, &now);
  now.c_lflag |= ICANON | ECHO;
  ::tcsetattr(STDIN_FILENO, TCSANOW, &now);
}

TEST(KeyInput, ReadsAKeyWithoutANewLineAndGivesTheTerminalBack) {
  OnTerminal child([] {
    char key = 0;
    {
      KeyInput keys;
      while (key == 0) key = keys.read(100ms);
    }
    return key == 'q' && reads_lines();
  });
  child.type('q');
  EXPECT_TRUE(child.as_expected());
}

TEST(KeyInput, ReadsKeysAlsoAfterAShellHasChangedTheTerminal) {
  OnTerminal child([] {
    KeyInput keys;
    set_lines();  // as a shell does when it lets a suspended program continue
    char key = 0;
    while (key == 0) key = keys.read(100ms);
    return key == 's';
  });
  child.type('s');
  EXPECT_TRUE(child.as_expected());
}

TEST(KeyInput, WaitsItsTimeWhenTheTerminalWasClosed) {
  OnTerminal child([] {
    ::signal(SIGHUP, SIG_IGN);
    KeyInput keys;
    OnTerminal::ready();
    while (::tcgetpgrp(STDIN_FILENO) >= 0) static_cast<void>(keys.read(10ms));  // until the terminal is closed
    const auto start = Clock::now();
    for (int i = 0; i < 5; ++i)
      if (keys.read(20ms) != 0) return false;
    return Clock::now() - start >= 100ms;
  });
  child.await_ready();
  child.hang_up();
  EXPECT_TRUE(child.as_expected());
}

TEST(KeyInput, LeavesTheTerminalAloneInTheBackground) {
  OnTerminal child([] {
    const pid_t job = ::fork();
    if (job == 0) {
      ::setpgid(0, 0);  // a group of its own, which is not the one in the foreground
      {
        KeyInput keys;
        if (keys.read(20ms) != 0) ::_exit(1);
      }
      ::_exit(reads_lines() ? kAsExpected : 1);
    }
    int status = 0;
    ::waitpid(job, &status, WUNTRACED);
    if (WIFSTOPPED(status)) ::kill(job, SIGKILL);  // by SIGTTOU
    return WIFEXITED(status) && WEXITSTATUS(status) == kAsExpected;
  });
  EXPECT_TRUE(child.as_expected());
}

}  // namespace
}  // namespace constrictor::cli
