// The progress line on terminals of several widths.
#include <gtest/gtest.h>
#include <pty.h>
#include <sys/wait.h>
#include <unistd.h>

#include <string>
#include <vector>

#include "common/progress_display.hpp"

namespace constrictor::cli {
namespace {

/// What a program prints that shows these status lines on a terminal of this width.
std::string printed(unsigned short columns, const std::vector<std::string>& lines) {
  const winsize size{24, columns, 0, 0};
  int terminal = -1;
  const pid_t child = ::forkpty(&terminal, nullptr, nullptr, &size);
  if (child == 0) {
    ProgressDisplay display;
    for (const auto& line : lines) display.show_status(line);
    ::_exit(0);
  }
  std::string text;
  char bytes[256];
  ssize_t count = 0;
  while ((count = ::read(terminal, bytes, sizeof bytes)) > 0) text.append(bytes, static_cast<std::size_t>(count));
  ::close(terminal);
  ::waitpid(child, nullptr, 0);
  return text;
}

const std::string kLine = "12 of 40 runs done, 11 succeeded, about 25 min left";

TEST(ProgressDisplay, NoStatusLineWrapsOnANarrowTerminal) {
  const std::string begin = "\r\033[K";
  EXPECT_EQ(printed(20, {kLine, "short"}), begin + "12 of 40 runs done>" + begin + "short");
  EXPECT_EQ(printed(static_cast<unsigned short>(kLine.size() + 1), {kLine}), begin + kLine);
  EXPECT_EQ(printed(static_cast<unsigned short>(kLine.size()), {kLine}),
            begin + kLine.substr(0, kLine.size() - 2) + ">");
  EXPECT_EQ(printed(1, {kLine}), begin);
}

TEST(ProgressDisplay, ATerminalThatReportsNoSizeHas80Columns) {
  EXPECT_EQ(printed(0, {std::string(200, 'x')}), "\r\033[K" + std::string(78, 'x') + ">");
}

TEST(ScreenLine, IsPrintableAndNotLongerThanItsColumns) {
  EXPECT_EQ(screen_line("tab\there  ", 20), "tab?here");
  EXPECT_EQ(screen_line("twelve chars", 12), "twelve chars");
  EXPECT_EQ(screen_line("twelve chars", 11), "twelve cha>");
  EXPECT_EQ(screen_line("twelve chars", 0), "");
}

}  // namespace
}  // namespace constrictor::cli
