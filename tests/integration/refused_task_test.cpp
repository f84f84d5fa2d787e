// Who has authority after `constrictor task start` was refused.
#include "integration/commanded_run.hpp"

namespace constrictor::testing {
namespace {

class RefusedTask : public CommandedRun {};

TEST_F(RefusedTask, LeavesAuthorityAsItWas) {
  Process launcher = run("4x");
  Watcher watcher(domain());
  ASSERT_TRUE(watcher.wait_for_level(msg::kAuthorityNone));
  EXPECT_EQ(command({"task", "start", "rotate"}), exit_status::kUsage);
  EXPECT_NE(output_.find("rotate needs"), std::string::npos) << output_;
  watcher.poll();
  for (const auto& [authority, at] : watcher.authorities)
    EXPECT_EQ(authority.level, msg::kAuthorityNone) << "tick " << authority.header.tick;
  // `input` accepts this task; only navigation knows that no object was pregrasped, and refuses it.
  for (int i = 0; i < 5; ++i) {  // the refusal may arrive before or after the message with the new authority
    EXPECT_EQ(command({"task", "start", "grasp"}), exit_status::kFailed) << output_;
    EXPECT_NE(output_.find("authority was released"), std::string::npos) << output_;
    EXPECT_TRUE(watcher.wait_for_level(msg::kAuthorityNone));
  }
  // Authority that a script has had before is not released by a refusal.
  ASSERT_EQ(command({"task", "start", "rotate", "--direction", "left"}), exit_status::kOk) << output_;
  ASSERT_TRUE(watcher.wait_for_level(msg::kAuthorityOperator));
  EXPECT_EQ(command({"task", "start", "grasp"}), exit_status::kFailed) << output_;
  EXPECT_EQ(output_.find("released"), std::string::npos) << output_;
  EXPECT_EQ(command({"release"}), exit_status::kOk) << output_;
  EXPECT_TRUE(watcher.wait_for_level(msg::kAuthorityNone));
  end(launcher);
}

TEST_F(RefusedTask, DoesNotSetThePlannerInMotionAfterAnEmergencyStop) {
  Process launcher = run("4x", std::string(kBlindProcesses) + "  - {components: [planner]}\n");
  Watcher watcher(domain());
  ASSERT_EQ(command({"stop"}), exit_status::kOk) << output_;
  ASSERT_EQ(command({"clear-stop"}), exit_status::kOk) << output_;
  ASSERT_TRUE(watcher.wait_for_level(msg::kAuthorityNone));
  EXPECT_EQ(command({"task", "start", "grasp"}), exit_status::kFailed) << output_;
  EXPECT_NE(output_.find("nobody had authority; this script keeps it"), std::string::npos) << output_;
  EXPECT_TRUE(watcher.wait_for_level(msg::kAuthorityOperator));
  EXPECT_EQ(command({"release"}), exit_status::kOk) << output_;
  EXPECT_TRUE(watcher.wait_for_level(msg::kAuthorityNone));
  end(launcher);
}

}  // namespace
}  // namespace constrictor::testing
