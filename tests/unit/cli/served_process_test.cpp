// A process that `constrictor serve` keeps alive, with shell commands in the place of components.
#include "cli/served_process.hpp"

#include <gtest/gtest.h>

#include <fstream>

#include "cli/launch_plan.hpp"
#include "support/eventually.hpp"
#include "support/temporary_folder.hpp"

namespace constrictor::cli {
namespace {

using constrictor::testing::eventually;
using namespace std::chrono_literals;

class Served : public ::testing::Test {
 protected:
  /// `script` is run by /bin/sh with the incarnation as $1 and, as $2, 1 if it comes back into the same run.
  std::unique_ptr<ServedProcess> make(const std::string& script) {
    return std::make_unique<ServedProcess>(
        "toy",
        [script](std::uint32_t incarnation, bool same_run) {
          return std::vector<std::string>{"/bin/sh",           "-c", script, "sh", std::to_string(incarnation),
                                          same_run ? "1" : "0"};
        },
        run_environment(), dir_.path() / "toy", [this](const std::string& line) { lines_.push_back(line); });
  }
  [[nodiscard]] bool printed(const std::string& line) const {
    return std::find(lines_.begin(), lines_.end(), line) != lines_.end();
  }
  /// Polls until `line` is printed or `bound` is over.
  [[nodiscard]] bool prints(ServedProcess& process, const std::string& line) {
    return eventually([&] { return process.poll(), printed(line); }, 20s);
  }

  testing::TemporaryFolder dir_;
  std::vector<std::string> lines_;
};

TEST_F(Served, AfterTheEndOfARunItWaitsForTheNextOneWithAHigherIncarnation) {
  const auto process = make("echo start $1 $2; [ $1 -lt 3 ] && exit 0; exec sleep 60");
  EXPECT_TRUE(prints(*process, "start 3 0"));
  EXPECT_TRUE(printed("start 1 0"));
  EXPECT_TRUE(printed("toy: the run is over; waiting for the next one"));
}

TEST_F(Served, AProcessThatDiedComesBackIntoTheSameRun) {
  const auto process = make("echo start $1 $2; [ $1 -eq 1 ] && kill -9 $$; exec sleep 60");
  EXPECT_TRUE(prints(*process, "start 2 1"));
  EXPECT_TRUE(printed("toy was killed by signal 9 (Killed); starting it again"));
}

TEST_F(Served, AProcessThatNoRunWantedStartsAfreshAndSaysSoOnce) {
  const auto process = make("echo start $1 $2; [ $1 -lt 4 ] && exit 75; exec sleep 60");
  EXPECT_TRUE(prints(*process, "start 4 0"));
  EXPECT_EQ(std::count(lines_.begin(), lines_.end(), "toy still waits for a run"), 1);
}

TEST_F(Served, AWrongConfigurationEndsIt) {
  const auto process = make("exit 78");
  std::optional<int> status;
  EXPECT_TRUE(eventually([&] { return (status = process->poll()).has_value(); }, 20s));
  EXPECT_EQ(status, 78);
  const auto missing = std::make_unique<ServedProcess>(
      "toy", [](std::uint32_t, bool) { return std::vector<std::string>{"/no/such/program"}; }, run_environment(),
      dir_.path() / "missing", [](const std::string&) {});
  EXPECT_TRUE(eventually([&] { return (status = missing->poll()).has_value(); }, 20s));
  EXPECT_EQ(status, 127);
}

TEST_F(Served, TheNumberOfTheStartSurvivesTheServerAndADamagedFile) {
  IncarnationFile first(dir_.path() / "n");
  EXPECT_EQ(first.next(), 1u);
  EXPECT_EQ(first.next(), 2u);
  EXPECT_EQ(IncarnationFile(dir_.path() / "n").next(), 3u);
  std::ofstream(dir_.path() / "n") << "not a number";
  EXPECT_EQ(IncarnationFile(dir_.path() / "n").next(), 1u);
  EXPECT_THROW(IncarnationFile(dir_.path() / "no" / "folder").next(), std::runtime_error);
}

TEST_F(Served, AStoppedProcessIsNotStartedAgain) {
  const auto process = make("echo start $1; exec sleep 60");
  ASSERT_TRUE(prints(*process, "start 1"));
  process->stop(SIGTERM);
  ASSERT_TRUE(eventually([&] { return process->poll(), !process->running(); }, 20s));
  for (int i = 0; i < 100; ++i) process->poll();
  EXPECT_FALSE(process->running());
  EXPECT_FALSE(printed("start 2"));
}

TEST_F(Served, ALongLineAndTheLastOneWithoutAnEndAreForwarded) {
  const auto process =
      make("[ $1 -gt 1 ] && exec sleep 60; head -c 5000 /dev/zero | tr '\\0' x; echo; printf last; exit 0");
  EXPECT_TRUE(prints(*process, "toy: the run is over; waiting for the next one"));
  EXPECT_TRUE(printed(std::string(4096, 'x')));
  EXPECT_TRUE(printed("last"));
}

}  // namespace
}  // namespace constrictor::cli
