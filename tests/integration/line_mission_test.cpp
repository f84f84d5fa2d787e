// Line following in nine processes over DDS. The robot perceives the line only with its camera.
#include "mission_run.hpp"

namespace constrictor::testing {
namespace {

TEST_F(MissionRun, NineProcessesFollowTheLineToItsEndByCamera) {
  ASSERT_NO_FATAL_FAILURE(succeeds("line", 25.0));
  EXPECT_EQ(report_["processes"].size(), 9U);
  EXPECT_LT(event_s("line_found"), 2.0);
  EXPECT_LT(event_s("end_of_line"), 20.0);
  EXPECT_GT(event_s("end_of_line"), 5.6 / 1.0);  // the line is 5.6 m long; the robot is slower than 1 m/s
  EXPECT_FALSE(std::isfinite(event_s("line_lost")));
  EXPECT_NEAR(state_s("done"), event_s("end_of_line"), 0.05);  // the mission has no objects
  // The errors are distances of the head from the true line; they include the sway of the head.
  EXPECT_LT(report_["line"]["rms_cross_track_m"], 0.12);
  EXPECT_LT(report_["line"]["max_cross_track_m"], 0.35);
  EXPECT_LT(report_["pose_error"]["rms_m"], 0.10);
  for (const auto& process : report_["processes"]) EXPECT_EQ(process["restarts"], 0) << process;
}

// The bend is sharper than the snake can follow: 115 degrees with a radius of 0.2 m.
TEST_F(MissionRun, FindsTheLineAgainAfterLosingItBehindASharpBend) {
  const std::string bend = scenario(
      "name: sharp_bend\nmission: {sequence: [], line_colour: blue}\nline:\n  colour: blue\n  width_m: 0.05\n  "
      "begin_m: [0.3, 0.0]\n  segments:\n    - {length_m: "
      "2.0}\n"
      "    - {length_m: 0.4, curvature_1_m: 5.0}\n    - {length_m: 3.0}\n"
      "start: {frame: line_begin, position_m: [-0.3, 0.0], yaw_rad: 0.0}\nnoise: {sensors: true, camera_sd: 0.01}\n");
  ASSERT_NO_FATAL_FAILURE(succeeds(bend, 40.0));
  const double lost_s = event_s("line_lost");
  ASSERT_NO_FATAL_FAILURE(expect_state_at("search line or object", lost_s));
  const double found_s = event_s("line_found", lost_s);
  EXPECT_LT(found_s, lost_s + 20.0) << report_["events"];
  // The rest of the line is 3 m long: the robot did not follow the line back.
  const double ended_s = event_s("end_of_line", found_s);
  EXPECT_GT(ended_s, found_s + 2.5) << report_["events"];
  EXPECT_LT(report_["pose_error"]["rms_m"], 0.10);
}

}  // namespace
}  // namespace constrictor::testing
