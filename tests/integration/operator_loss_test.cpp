// The process of `input` is killed and restarted while an operator drives: it detects operators that die during the
// restart or later, and obeys requests that were made during the restart.
#include <signal.h>

#include <algorithm>
#include <functional>
#include <optional>

#include "common/operator.hpp"
#include "constrictor/topics.hpp"
#include "cyclone/endpoint.hpp"
#include "integration/cli_fixture.hpp"
#include "runtime/host.hpp"

namespace constrictor::testing {
namespace {

using namespace std::chrono_literals;

class OperatorLoss : public CliFixture {
 protected:
  void SetUp() override {
    write("blind.yaml",  // a run without camera and perception
          case_study_manifest(20, kBlindProcesses));
    launcher_.emplace(start(
        {"run", "--manifest", (dir_ / "blind.yaml").string(), "--report", (dir_ / "r").string(), "--pace", "1x"}));
    ASSERT_TRUE(launcher_->wait_for("report in", 30s)) << launcher_->output() << launcher_->errors();
    hand_.emplace(domain(), operator_options("hand"));
    ASSERT_TRUE(hand_->connect(60s)) << launcher_->output()
                                     << launcher_->errors();  // succeeds when `input` has stepped
    authority_ = dds::Reader<msg::Authority>::member(hand_->participant(), std::string(topics::kAuthority.name));
    commands_ = dds::Reader<msg::JointCommand>::member(hand_->participant(), std::string(topics::kJointCommand.name));
    statuses_ = dds::Reader<msg::ComponentStatus>::member(hand_->participant(), "component_status");
  }
  void TearDown() override {
    EXPECT_EQ(command({"end"}), exit_status::kOk) << output_;
    EXPECT_EQ(launcher_->wait(30s), 128 + SIGTERM);
  }
  void poll() {
    authority_.take([this](const msg::Authority& m) { now_ = m; });
    commands_.take([this](const msg::JointCommand& m) { setpoints_.push_back(m); });
    statuses_.take([this](const msg::ComponentStatus& m) {
      if (std::string(m.component) == "input") input_ = m;
    });
  }
  [[nodiscard]] bool until(const std::function<bool()>& condition, std::chrono::seconds bound = 30s) {
    return eventually(
        [&] {
          poll();
          return condition();
        },
        bound);
  }
  [[nodiscard]] bool level(std::uint8_t level) {
    return until([&] { return now_.level == level; });
  }
  /// A teleop client that drives the robot.
  [[nodiscard]] Process drive() {
    Process teleop = start({"teleop", "--drive", "0.3,0.1"});
    EXPECT_TRUE(teleop.wait_for("driving", 30s)) << teleop.errors();
    EXPECT_TRUE(level(msg::kAuthorityOperator));
    return teleop;
  }
  void kill_input() {
    ASSERT_TRUE(until([&] { return input_.pid > 0; }));
    ASSERT_EQ(::kill(input_.pid, SIGKILL), 0);
  }
  [[nodiscard]] bool input_is_back(std::uint32_t incarnation) {
    return until([&] { return input_.incarnation >= incarnation && now_.header.incarnation >= incarnation; });
  }
  /// Expects the setpoints to stay constant for a while after this tick.
  void expect_held_after(std::int64_t tick) {
    ASSERT_TRUE(until([&] { return !setpoints_.empty() && setpoints_.back().header.tick > tick + 60; }));
    const auto held =
        std::find_if(setpoints_.begin(), setpoints_.end(), [&](const auto& c) { return c.header.tick >= tick + 1; });
    for (auto c = held; c != setpoints_.end(); ++c) {
      for (int j = 0; j < c->joint_count; ++j)
        ASSERT_EQ(c->position_rad[j], held->position_rad[j]) << "tick " << c->header.tick;
    }
  }

  std::optional<Process> launcher_;
  std::optional<RequestClient> hand_;  // the readers use its participant: a process joins a domain once
  dds::Reader<msg::Authority> authority_;
  dds::Reader<msg::JointCommand> commands_;
  dds::Reader<msg::ComponentStatus> statuses_;
  msg::Authority now_{};
  msg::ComponentStatus input_{};
  std::vector<msg::JointCommand> setpoints_;
};

TEST_F(OperatorLoss, ARestartedInputKeepsALivingOperatorAndDetectsItsDeath) {
  Process teleop = drive();
  kill_input();
  ASSERT_TRUE(input_is_back(2));
  const std::int64_t restarted = now_.header.tick;
  ASSERT_TRUE(until([&] { return now_.header.tick > restarted + 220; }))
      << "well beyond the 3 s for writers that are not found again";
  ASSERT_EQ(now_.level, msg::kAuthorityOperator);
  ASSERT_FALSE(teleop.wait(0s)) << teleop.errors();
  teleop.signal(SIGKILL);
  ASSERT_TRUE(until([&] { return now_.level == msg::kAuthorityNone; }, 5s))
      << "level " << int{now_.level} << " of " << now_.source;
  expect_held_after(now_.header.tick);

  // The operator dies while `input` is away: the new process has never met its writer.
  Process second = drive();
  kill_input();
  second.signal(SIGKILL);
  ASSERT_TRUE(input_is_back(3));
  ASSERT_TRUE(until([&] { return now_.level == msg::kAuthorityNone; }, 15s))
      << "level " << int{now_.level} << " of " << now_.source;
  expect_held_after(now_.header.tick);
}

TEST_F(OperatorLoss, AnEmergencyStopRequestedDuringARestartOfInputIsObeyedAfterwards) {
  Process teleop = drive();
  ASSERT_TRUE(until([&] { return input_.pid > 0; }));
  // Stop the process first, so that the request certainly reaches a process that never takes it.
  ASSERT_EQ(::kill(input_.pid, SIGSTOP), 0);
  const std::uint64_t number = hand_->ask(msg::kRequestEmergencyStop);
  // The plant obeys the stop at its next tick, if there is one before the run waits for `input`; `input` cannot.
  static_cast<void>(hand_->wait_for_answer(number, 500ms));
  poll();
  EXPECT_NE(now_.level, msg::kAuthorityEmergencyStop);
  ASSERT_EQ(::kill(input_.pid, SIGKILL), 0);
  EXPECT_EQ(hand_->wait_for_answer(number, 20s), RequestClient::Answer::kGranted);
  EXPECT_TRUE(level(msg::kAuthorityEmergencyStop));
}

}  // namespace
}  // namespace constrictor::testing
