// A whole retrieval in nine processes over DDS: the robot finds, grasps, carries and drops an object.
#include "mission_run.hpp"
#include "support/project.hpp"

namespace constrictor::testing {
namespace {

TEST_F(MissionRun, FindsGraspsAndCarriesAnObjectAndDropsItInItsZone) {
  ASSERT_NO_FATAL_FAILURE(succeeds("short", 300.0));
  EXPECT_TRUE(report_["success"]);
  double before_s = 0.0;
  for (const char* event : {"line_found", "object_reached", "object_pregrasped", "object_grasped", "dropping_done"}) {
    const double at_s = event_s(event, before_s);
    EXPECT_TRUE(std::isfinite(at_s)) << event << " after " << before_s << " s: " << report_["events"];
    before_s = at_s;
  }
  EXPECT_TRUE(report_["objects"][0]["in_zone"]) << report_["objects"];
}

// When the robot has carried the object for a metre, a force pulls it out of the U. The object is a box, because a
// cylinder that falls over rolls away.
TEST_F(MissionRun, GraspsAnObjectAgainAfterItWasPulledOutOfTheBody) {
  const std::string pulled = scenario(
      "name: pulled\nmission: {sequence: [green], line_colour: blue}\nline:\n  colour: blue\n  width_m: 0.05\n  "
      "begin_m: [0.3, 0.0]\n  segments:\n    - {length_m: "
      "2.0}\n"
      "    - {length_m: 1.0, curvature_1_m: 0.3}\n"
      "objects:\n  - {colour: green, frame: line_end, position_m: [0.45, 0.15], shape: box, size_m: [0.15, 0.15, "
      "0.15], "
      "mass_kg: 0.4}\n"
      "zones:\n  - {colour: green, frame: line_begin, position_m: [-1.1, 0.5], radius_m: 0.35}\n"
      "start: {frame: line_begin, position_m: [-0.3, 0.0], yaw_rad: 0.0}\nnoise: {sensors: true, camera_sd: 0.01}\n"
      "perturbations:\n  - {object: 0, when_displaced_m: 1.0, duration_s: 0.4, force_n: [0, 2, 8]}\n");
  ASSERT_NO_FATAL_FAILURE(succeeds(pulled, 600.0));
  const double grasped_s = event_s("object_grasped");
  const double lost_s = event_s("object_grasp_lost", grasped_s);
  ASSERT_NO_FATAL_FAILURE(expect_state_at("search object", lost_s));
  EXPECT_TRUE(std::isfinite(event_s("object_grasped", lost_s))) << report_["events"];
  EXPECT_TRUE(report_["objects"][0]["in_zone"]) << report_["objects"];
}

// A person takes the object when the robot has just begun to approach it, and puts it down out of view. The map gives
// the empty place up, so that the robot does not grasp there, and the robot finds the object at its new place.
TEST_F(MissionRun, FindsAnObjectAgainThatAPersonHasMovedOutOfView) {
  std::ifstream file(source_path("sim/scenarios/short.yaml"));
  std::string text{std::istreambuf_iterator<char>(file), {}};
  const std::size_t noise = text.find("\nnoise:");
  ASSERT_NE(noise, std::string::npos);
  text.insert(noise, "\nperturbations:\n  - {object: 0, at_s: 3.1, moved_m: [-0.7, 1.2]}\n");
  ASSERT_NO_FATAL_FAILURE(succeeds(scenario(text), 400.0));
  EXPECT_TRUE(report_["objects"][0]["in_zone"]) << report_["objects"];
  EXPECT_TRUE(std::isfinite(event_s("object_lost"))) << report_["events"];
  int grasps = 0;
  for (const auto& state : report_["states"]) grasps += state["state"] == "grasp" ? 1 : 0;
  EXPECT_EQ(grasps, 1) << report_["states"];
  for (const auto& event : report_["events"]) {
    if (event["event"] != "object_grasped") continue;
    EXPECT_GT(event["parameters"]["object_handle"], 1) << "a new landmark";
  }
}

}  // namespace
}  // namespace constrictor::testing
