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

// A person stops to look at something: the planner waits, says why, and goes on by itself.
TEST_F(MidMission, TheMissionWaitsWhileAPersonHasAuthorityFor20SecondsAndThenSucceeds) {
  constexpr double kHeld_s = 20.0;  // simulated
  Process launcher = start({"run", "short", "--pace", "1x", "--report", (dir_ / "r").string()});
  ASSERT_TRUE(launcher.wait_for("simulated", std::chrono::seconds(60))) << launcher.output() << launcher.errors();
  wait_for_event("object pregrasped");
  ASSERT_EQ(command({"task", "start", "explore", "--direction", "backwards"}), exit_status::kOk) << output_;
  nlohmann::json now = status();
  const double taken_s = now["sim_time_s"];
  ASSERT_TRUE(eventually([&] { return (now = status())["sim_time_s"] > taken_s + kHeld_s; }, std::chrono::seconds(60)));
  EXPECT_EQ(now["authority"]["level"], "operator");
  EXPECT_EQ(now["mission"], "suspended");
  const std::string holder = now["authority"]["source"];
  EXPECT_NE(std::string(now["mission_reason"]).find(holder + " has authority"), std::string::npos) << now;
  ASSERT_EQ(command({"release"}), exit_status::kOk) << output_;
  ASSERT_EQ(command({"pace", "lockstep"}), exit_status::kOk) << output_;
  EXPECT_EQ(launcher.wait(std::chrono::seconds(300)), exit_status::kOk) << launcher.output() << launcher.errors();

  const nlohmann::json json = report("r");
  ASSERT_TRUE(json.is_object());
  EXPECT_TRUE(json["success"]) << json["objects"];
  double suspended_s = 0.0, from_s = -1.0;
  for (const auto& state : json["states"]) {
    if (from_s >= 0.0) suspended_s += double{state["sim_time_s"]} - from_s;
    from_s = state["state"] == "suspended" ? double{state["sim_time_s"]} : -1.0;
  }
  EXPECT_GE(suspended_s, kHeld_s) << json["states"];
  EXPECT_LE(json["recoveries"], 3) << "waiting costs no recovery";
  // What it waited for stands in the log once.
  ASSERT_EQ(command({"log", (dir_ / "r").string()}), exit_status::kOk) << output_;
  const std::string said = "the mission waits because " + holder + " has authority";
  const std::size_t at = output_.find(said);
  EXPECT_NE(at, std::string::npos) << output_;
  EXPECT_EQ(output_.find(said, at + 1), std::string::npos) << output_;
}

}  // namespace
}  // namespace constrictor::testing
