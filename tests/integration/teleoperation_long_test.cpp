// An operator takes over in mid-mission, drives and lets go: the planner takes up from the world as it is and completes
// the mission.
#include "integration/cli_fixture.hpp"
#include "runtime/host.hpp"

namespace constrictor::testing {
namespace {

class MidMission : public CliFixture {
 protected:
  /// Status of the run as scripts see it.
  [[nodiscard]] nlohmann::json status() {
    EXPECT_EQ(command({"status", "--json"}), exit_status::kOk) << output_;
    return nlohmann::json::parse(output_, nullptr, false);
  }
  void wait_for_event(const std::string& event) {
    ASSERT_EQ(
        command({"task", "wait", "--event", event, "--goal", "any", "--timeout", "150s"}, std::chrono::seconds(160)),
        exit_status::kOk)
        << event << output_;
  }
  void drive(const std::string& speed_turn) {
    ASSERT_EQ(command({"teleop", "--drive", speed_turn, "--for", "2s"}), exit_status::kOk) << output_;
  }
};

TEST_F(MidMission, AnOperatorDrivesWhileTheLineIsFollowedAndWhileTheObjectIsCarriedAndTheMissionSucceeds) {
  Process launcher = start({"run", "short", "--report", (dir_ / "r").string()});
  ASSERT_TRUE(launcher.wait_for("simulated", std::chrono::seconds(60))) << launcher.output() << launcher.errors();
  drive("0.3,0.4");
  wait_for_event("object grasped");
  const nlohmann::json before = status();
  drive("0.15,0.0");
  const auto end = launcher.wait(std::chrono::seconds(300));
  EXPECT_EQ(end, exit_status::kOk) << launcher.output() << launcher.errors();

  const nlohmann::json told = report("r");
  ASSERT_TRUE(told.is_object());
  EXPECT_TRUE(told["success"]) << told["objects"];
  EXPECT_TRUE(told["objects"][0]["in_zone"]) << told["objects"];
  // Each time it went on by looking where it was: empty, then with the object in its arms.
  std::vector<std::string> states;
  for (const auto& state : told["states"]) states.push_back(state["state"]);
  EXPECT_GE(std::count(states.begin(), states.end(), "search line or object"), 2) << told["states"];
  EXPECT_GE(std::count(states.begin(), states.end(), "search line"), 1) << told["states"];
  EXPECT_EQ(std::count(states.begin(), states.end(), "grasp"), 1) << told["states"];
  // What scripts saw of it in between.
  ASSERT_TRUE(before.is_object()) << output_;
  EXPECT_EQ(before["components"].size(), 10U) << before;
}

}  // namespace
}  // namespace constrictor::testing
