// Line following in ten processes over DDS: what the camera sees is all that the robot is told.
#include "mission_run.hpp"

namespace constrictor::testing {
namespace {

TEST_F(MissionRun, TenProcessesFollowTheLineToItsEndByTheirCamera) {
  EXPECT_EQ(run("line", 25.0), exit_status::kMissionFailed) << output_;  // there is no object to fetch
  ASSERT_TRUE(report_.is_object()) << output_;
  EXPECT_EQ(report_["processes"].size(), 10U);
  EXPECT_LT(event_s("line_found"), 2.0);
  EXPECT_LT(event_s("end_of_line"), 20.0);  // 5.6 m
  EXPECT_GT(event_s("end_of_line"), 5.6 / 1.0);
  EXPECT_FALSE(std::isfinite(event_s("line_lost")));
  EXPECT_NEAR(state_s("search object"), event_s("end_of_line"), 0.05);
  // Against the line's true geometry, the head's sway of the gait included.
  EXPECT_LT(report_["line"]["rms_cross_track_m"], 0.12);
  EXPECT_LT(report_["line"]["max_cross_track_m"], 0.35);
  EXPECT_LT(report_["pose_error"]["rms_m"], 0.25);
  for (const auto& process : report_["processes"]) EXPECT_EQ(process["restarts"], 0) << process;
}

}  // namespace
}  // namespace constrictor::testing
