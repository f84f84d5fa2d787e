// An operator takes authority in the middle of a mission, drives and releases authority. The planner then continues
// with the robot where it is, and completes the mission.
#include "integration/cli_fixture.hpp"
#include "runtime/host.hpp"

namespace constrictor::testing {
namespace {

class MidMission : public CliFixture {
 protected:
  /// The output of `constrictor status --json`.
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

TEST_F(MidMission, TheMissionSucceedsAlthoughAnOperatorDrivesOnTheLineAndWithTheObject) {
  // The robot is on the line for ten seconds of simulated time. As fast as possible, they would pass before the
  // operator's client has started.
  Process launcher = start({"run", "short", "--pace", "1x", "--report", (dir_ / "r").string()});
  ASSERT_TRUE(launcher.wait_for("simulated", std::chrono::seconds(60))) << launcher.output() << launcher.errors();
  drive("0.3,0.4");
  ASSERT_EQ(command({"pace", "lockstep"}), exit_status::kOk) << output_;
  wait_for_event("object grasped");
  const nlohmann::json before = status();
  drive("0.15,0.0");
  const auto end = launcher.wait(std::chrono::seconds(300));
  EXPECT_EQ(end, exit_status::kOk) << launcher.output() << launcher.errors();

  const nlohmann::json json = report("r");
  ASSERT_TRUE(json.is_object());
  EXPECT_TRUE(json["success"]) << json["objects"];
  EXPECT_TRUE(json["objects"][0]["in_zone"]) << json["objects"];
  // After each takeover the planner continues with a search: first without an object, then with the object in the body.
  std::vector<std::string> states;
  for (const auto& state : json["states"]) states.push_back(state["state"]);
  EXPECT_GE(std::count(states.begin(), states.end(), "search line or object"), 2) << json["states"];
  EXPECT_GE(std::count(states.begin(), states.end(), "search line"), 1) << json["states"];
  EXPECT_EQ(std::count(states.begin(), states.end(), "grasp"), 1) << json["states"];
  // `status --json` in the middle of the mission listed all components.
  ASSERT_TRUE(before.is_object()) << output_;
  EXPECT_EQ(before["components"].size(), 9U) << before;
}

}  // namespace
}  // namespace constrictor::testing
