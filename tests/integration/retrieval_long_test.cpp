// A whole retrieval in ten processes over DDS.
#include "mission_run.hpp"

namespace constrictor::testing {
namespace {

TEST_F(MissionRun, AnObjectIsFoundGraspedCarriedAndDroppedOnItsZone) {
  EXPECT_EQ(run("short", 300.0), exit_status::kOk) << output_;
  ASSERT_TRUE(report_.is_object()) << output_;
  EXPECT_TRUE(report_["success"]);
  double before_s = 0.0;
  for (const char* event : {"line_found", "object_reached", "object_pregrasped", "object_grasped", "dropping_done"}) {
    const double at_s = event_s(event, before_s);
    EXPECT_TRUE(std::isfinite(at_s)) << event << " after " << before_s << " s: " << report_["events"];
    before_s = at_s;
  }
  EXPECT_TRUE(report_["objects"][0]["in_zone"]) << report_["objects"];
}

}  // namespace
}  // namespace constrictor::testing
