#include "cli/child_process.hpp"

#include <gtest/gtest.h>
#include <unistd.h>

#include <csignal>
#include <fstream>
#include <sstream>

#include "support/eventually.hpp"

namespace constrictor::cli {
namespace {

namespace fs = std::filesystem;
using namespace std::chrono_literals;

class ChildProcessTest : public ::testing::Test {
 protected:
  ChildProcessTest() : log_(fs::temp_directory_path() / ("child_process_" + std::to_string(::getpid()) + ".log")) {
    fs::remove(log_);
  }
  ~ChildProcessTest() override { fs::remove(log_); }
  [[nodiscard]] ChildProcess shell(const std::string& script) const {
    return {{"/bin/sh", "-c", script}, {"WORD=hello"}, log_};
  }
  static ChildExit wait(ChildProcess& child) {
    EXPECT_TRUE(testing::eventually([&] { return child.poll().has_value(); }));
    return child.poll().value_or(ChildExit{-1, 0});
  }
  fs::path log_;
};

TEST_F(ChildProcessTest, ReportsExitStatusAndTheLastLinesOfTheLog) {
  ChildProcess child = shell("echo one; echo two >&2; echo $WORD; exit 78");
  const ChildExit exit = wait(child);
  EXPECT_EQ(exit.code(), 78);
  EXPECT_EQ(exit.describe(), "ended with status 78 (configuration)");
  EXPECT_EQ(last_lines(log_, 0, 2), (std::vector<std::string>{"two", "hello"}));
  EXPECT_EQ(last_lines(log_, 4, 9).size(), 2u);
}

TEST_F(ChildProcessTest, ReportsTheSignalThatKilledIt) {
  ChildProcess child = shell("kill -SEGV $$");
  EXPECT_EQ(wait(child).describe(), "was killed by signal 11 (Segmentation fault)");
}

TEST_F(ChildProcessTest, ReportsAMissingProgram) {
  ChildProcess child({"/nowhere/program"}, {}, log_);
  EXPECT_EQ(wait(child).code(), 127);
  EXPECT_EQ(last_lines(log_, 0, 1), std::vector<std::string>{"/nowhere/program: No such file or directory"});
}

TEST_F(ChildProcessTest, CountsCpuTimeAndMemory) {
  ChildProcess child = shell("while :; do :; done");
  // Wait until the kernel has counted 0.1 s of CPU time for the child, which takes long on a busy machine.
  const auto computed_s = [&] {
    std::ifstream file("/proc/" + std::to_string(child.pid()) + "/stat");
    std::string skipped;
    for (int field = 1; field <= 13; ++field) file >> skipped;  // the name, field 2, has no blank here
    long user = 0, system = 0;
    file >> user >> system;
    return static_cast<double>(user + system) / static_cast<double>(::sysconf(_SC_CLK_TCK));
  };
  ASSERT_TRUE(testing::eventually([&] { return computed_s() >= 0.1; }, 60s));
  const double least_s = computed_s();
  EXPECT_GT(child.pss_mib(), 0.01);
  child.signal(SIGKILL);
  EXPECT_GE(wait(child).cpu_s, least_s - 0.02);
}

TEST_F(ChildProcessTest, IsKilledByTheDestructor) {
  pid_t pid = 0;
  {
    const ChildProcess child = shell("sleep 100");
    pid = child.pid();
    EXPECT_EQ(::kill(pid, 0), 0);
  }
  EXPECT_NE(::kill(pid, 0), 0);
}

}  // namespace
}  // namespace constrictor::cli
