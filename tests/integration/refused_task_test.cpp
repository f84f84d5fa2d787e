// Who has authority after `constrictor task start` was refused.
#include "integration/run_watcher.hpp"
#include "runtime/host.hpp"

namespace constrictor::testing {
namespace {

using namespace std::chrono_literals;

class RefusedTask : public CliFixture {
 protected:
  /// A run of these processes, without camera and perception: no test here needs them.
  [[nodiscard]] Process run(const std::string& processes) {
    write("run.yaml", case_study_manifest(20, processes));
    Process process =
        start({"run", "--manifest", (dir_ / "run.yaml").string(), "--report", (dir_ / "r").string(), "--pace", "4x"});
    EXPECT_TRUE(process.wait_for("simulated", 30s)) << process.output() << process.errors();
    return process;
  }
  void end(Process& launcher) {
    EXPECT_EQ(command({"end"}), exit_status::kOk) << output_;
    EXPECT_EQ(launcher.wait(10s), 128 + SIGTERM);
  }
};

TEST_F(RefusedTask, LeavesAuthorityAsItWas) {
  Process launcher = run(kBlindProcesses);
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
  Process launcher = run(std::string(kBlindProcesses) + "  - {components: [planner]}\n");
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
