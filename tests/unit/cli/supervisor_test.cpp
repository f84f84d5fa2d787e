// The supervisor with shell scripts in place of components.
#include "cli/supervisor.hpp"

#include <gtest/gtest.h>

#include <csignal>
#include <fstream>

#include "runtime/host.hpp"
#include "support/eventually.hpp"
#include "support/temporary_folder.hpp"

namespace constrictor::cli {
namespace {

using namespace std::chrono_literals;
using State = Supervisor::State;

constexpr const char* kWaitForever = "exec sleep 1000";

class SupervisorTest : public ::testing::Test {
 protected:
  /// Starts a run of a plant and two members. The plant and the member `control` execute these scripts, in which $1 is
  /// the incarnation. The member `input` waits forever.
  void start(const std::string& plant, const std::string& member, int restarts = 100, int restarts_of_plant = 0) {
    LaunchManifest manifest;
    manifest.plant = "physics";
    manifest.processes = {
        {{"control"}, "", restarts, {"WORD=hello"}}, {{"physics"}, "", restarts_of_plant, {}}, {{"input"}, "", 9, {}}};
    const auto command_line = [=](const ProcessPlan& process, std::uint32_t incarnation) {
      const std::string script = process.name() == "physics"   ? plant
                                 : process.name() == "control" ? member
                                                               : kWaitForever;
      return std::vector<std::string>{"/bin/sh", "-c", script, "sh", std::to_string(incarnation)};
    };
    supervisor_ = std::make_unique<Supervisor>(manifest, command_line, std::vector<std::string>{"PATH=/usr/bin:/bin"},
                                               folder_.path() / "logs",
                                               [this](const std::string& line) { printed_ += line + "\n"; });
    supervisor_->start();
  }
  /// Polls until `condition` holds; false if it does not within the bound.
  template <class Condition>
  bool poll_until(Condition&& condition, std::chrono::seconds bound = 30s) {
    return testing::eventually(
        [&] {
          supervisor_->poll();
          return condition();
        },
        bound, 1ms);
  }
  bool poll_until_over() {
    return poll_until([this] { return supervisor_->poll() != State::kRunning; });
  }
  /// Part of a script: waits for go().
  [[nodiscard]] std::string wait_for_go() const {
    return "while [ ! -e " + (folder_.path() / "go").string() + " ]; do sleep 0.01; done; ";
  }
  void go() const { std::ofstream(folder_.path() / "go").close(); }
  [[nodiscard]] bool printed(const std::string& text) const { return printed_.find(text) != std::string::npos; }
  [[nodiscard]] std::string log(const std::string& name) const {
    std::ifstream file(folder_.path() / "logs" / (name + ".log"));
    return {std::istreambuf_iterator<char>(file), {}};
  }
  [[nodiscard]] ProcessRecord record(std::size_t index) const { return supervisor_->records().at(index); }

  const testing::TemporaryFolder folder_;
  std::string printed_;
  std::unique_ptr<Supervisor> supervisor_;
};

TEST_F(SupervisorTest, RestartsAMemberThatDiesAsTheNextIncarnation) {
  start(kWaitForever, "[ $1 = 1 ] && { echo incarnation $1 fails; exit 3; }; echo incarnation $1 lives $WORD; " +
                          std::string(kWaitForever));
  ASSERT_TRUE(poll_until([&] { return log("control").find("incarnation 2 lives hello") != std::string::npos; }))
      << printed_;
  EXPECT_EQ(record(0).restarts, 1u);
  EXPECT_TRUE(printed("control: incarnation 1 fails\n"))
      << "the last lines of the member's log must be printed: " << printed_;
  EXPECT_TRUE(printed("control ended with status 3; restarted as incarnation 2\n")) << printed_;
  EXPECT_EQ(supervisor_->poll(), State::kRunning);
}

TEST_F(SupervisorTest, FailsAfterTheRestartsThatTheManifestAllows) {
  start(kWaitForever, "exit 3", 2);
  ASSERT_TRUE(poll_until_over());
  EXPECT_EQ(supervisor_->poll(), State::kFailed);
  EXPECT_EQ(supervisor_->failure(), "control ended with status 3, and the manifest allows 2 restarts");
  EXPECT_EQ(supervisor_->failure_status(), exit_status::kSoftware);
}

TEST_F(SupervisorTest, FailsWhenAMemberDiesFiveTimesAtOneTick) {
  start(kWaitForever, "exit 3");
  supervisor_->run_is_at(7, false);
  ASSERT_TRUE(poll_until_over());
  EXPECT_EQ(supervisor_->failure(),
            "control died 5 times in a row while the run stood at tick 7; the last time it ended with status 3");
  EXPECT_EQ(record(0).restarts, 4u);
}

TEST_F(SupervisorTest, DeathsDoNotCountWhileTicksAdvance) {
  start(kWaitForever, "[ $1 -lt 9 ] && exit 3; " + std::string(kWaitForever));
  std::int64_t tick = 0;
  EXPECT_TRUE(poll_until([&] {
    supervisor_->run_is_at(++tick, false);
    return record(0).restarts == 8u;
  })) << printed_;
  EXPECT_EQ(supervisor_->poll(), State::kRunning) << supervisor_->failure();
}

TEST_F(SupervisorTest, DeathsDoNotCountWhileAPauseHoldsTheRun) {
  start(kWaitForever, "[ $1 -lt 9 ] && exit 3; " + std::string(kWaitForever));
  EXPECT_TRUE(poll_until([&] {
    supervisor_->run_is_at(7, true);
    return record(0).restarts == 8u;
  })) << printed_;
  EXPECT_EQ(supervisor_->poll(), State::kRunning) << supervisor_->failure();
}

TEST_F(SupervisorTest, DoesNotRestartAfterAStatusThatARestartCannotChange) {
  for (const int status :
       {exit_status::kUsage, exit_status::kConfiguration, exit_status::kRefused, exit_status::kWaitedTooLong}) {
    start(kWaitForever, "exit " + std::to_string(status));
    ASSERT_TRUE(poll_until_over());
    EXPECT_EQ(supervisor_->failure_status(), status);
    EXPECT_EQ(record(0).restarts, 0u) << status;
  }
  start(kWaitForever, "exec /nowhere/program 2>&1");
  ASSERT_TRUE(poll_until_over());
  EXPECT_EQ(supervisor_->failure_status(), exit_status::kSoftware);
}

TEST_F(SupervisorTest, DoesNotRepeatTheNameInALineThatBeginsWithIt) {
  start(kWaitForever, "echo 'control: configuration: x.yaml:1: y'; exit 78");
  ASSERT_TRUE(poll_until_over());
  EXPECT_TRUE(printed("control: configuration: x.yaml:1: y\n")) << printed_;
  EXPECT_FALSE(printed("control: control:")) << printed_;
}

TEST_F(SupervisorTest, RestartsThePlantAsEveryOtherProcess) {
  start("test $1 -lt 3 && kill -KILL $$; exec sleep 1000", kWaitForever, 100, 2);
  ASSERT_TRUE(poll_until([this] { return record(1).restarts == 2; })) << printed_;
  EXPECT_EQ(supervisor_->poll(), State::kRunning) << supervisor_->failure();
  EXPECT_TRUE(printed("physics was killed by signal 9 (Killed); restarted as incarnation 3")) << printed_;
}

TEST_F(SupervisorTest, RestartsAPlantThatIsKilledAfterTheEndOfTheRun) {
  start("test $1 -lt 2 && { " + wait_for_go() + "kill -KILL $$; }; exit 0", kWaitForever, 100, 2);
  supervisor_->expect_end();
  go();
  ASSERT_TRUE(poll_until_over());
  EXPECT_EQ(supervisor_->poll(), State::kEnded) << supervisor_->failure();
  EXPECT_EQ(record(1).restarts, 1u);
}

TEST_F(SupervisorTest, EndsAMemberThatWasRestartedAfterTheRunWhenThePlantHasEnded) {
  start(wait_for_go() + "exit 0", "test $1 -lt 2 && kill -KILL $$; trap 'exit 0' TERM; while :; do sleep 0.05; done",
        100, 2);
  supervisor_->expect_end();
  ASSERT_TRUE(poll_until([this] { return record(0).restarts == 1; }))
      << "as long as the plant runs, it may still have something to write";
  go();
  ASSERT_TRUE(poll_until_over());
  EXPECT_EQ(supervisor_->poll(), State::kEnded) << supervisor_->failure();
  EXPECT_EQ(record(0).restarts, 1u);
  ASSERT_TRUE(poll_until([this] { return record(0).cpu_s > 0.0; })) << "it must end by itself";
}

TEST_F(SupervisorTest, EndsAMemberThatHeardOfTheEndOfTheRunSecondsBeforeTheLauncher) {
  start(wait_for_go() + "exit 0", "test $1 -lt 2 && exit 0; trap 'exit 0' TERM; while :; do sleep 0.05; done");
  ASSERT_TRUE(poll_until([this] { return record(0).restarts == 1; })) << "it could also have ended by a fault";
  EXPECT_TRUE(printed("control ended before the run did; restarted as incarnation 2")) << printed_;
  supervisor_->expect_end();
  go();
  ASSERT_TRUE(poll_until_over());
  EXPECT_EQ(supervisor_->poll(), State::kEnded) << supervisor_->failure();
  ASSERT_TRUE(poll_until([this] { return record(0).cpu_s > 0.0; })) << "it would wait for the plant for ever";
}

TEST_F(SupervisorTest, FailsWhenThePlantDiesAndTheManifestAllowsNoRestart) {
  start("kill -SEGV $$", kWaitForever);
  ASSERT_TRUE(poll_until_over());
  EXPECT_EQ(supervisor_->poll(), State::kFailed);
  EXPECT_EQ(supervisor_->failure(), "physics, the plant, was killed by signal 11 (Segmentation fault)");
}

TEST_F(SupervisorTest, FailsWhenThePlantEndsBeforeTheRun) {
  start("exit 0", kWaitForever);
  ASSERT_TRUE(poll_until_over());
  EXPECT_EQ(supervisor_->poll(), State::kFailed);
  EXPECT_NE(supervisor_->failure().find("physics, the plant (pid "), std::string::npos) << supervisor_->failure();
}

TEST_F(SupervisorTest, EndsWithoutFailureIfThePlantEndsAfterTheRun) {
  start("exit 0", kWaitForever);
  supervisor_->expect_end();
  ASSERT_TRUE(poll_until_over());
  EXPECT_EQ(supervisor_->poll(), State::kEnded);
  supervisor_->finish(0s);
  EXPECT_EQ(supervisor_->failure(), "control did not end within 0 s of the run's end");
}

TEST_F(SupervisorTest, FinishReturnsAtOnceIfGiveUpReturnsTrue) {
  start("exit 0", kWaitForever);
  supervisor_->expect_end();
  ASSERT_TRUE(poll_until_over());
  supervisor_->finish(100s, [] { return true; });
  EXPECT_EQ(supervisor_->failure(), "");
}

TEST_F(SupervisorTest, KillsProcessesThatIgnoreSigtermOrAreStopped) {
  start("trap '' TERM; echo ready; while :; do sleep 0.01; done", "kill -STOP $$");
  ASSERT_TRUE(poll_until([&] { return log("physics") == "ready\n"; }));
  const auto start = std::chrono::steady_clock::now();
  supervisor_->stop();
  EXPECT_GE(std::chrono::steady_clock::now() - start, 3s) << "SIGKILL is sent 3 s after SIGTERM";
  EXPECT_GT(record(1).cpu_s, 0.0);
}

}  // namespace
}  // namespace constrictor::cli
