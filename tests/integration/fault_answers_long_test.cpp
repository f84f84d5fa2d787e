// What a mission does when a part of the robot fails: the rows of the table in components/lib/faults/README.md.
#include "integration/mission_run.hpp"

namespace constrictor::testing {
namespace {

struct Row {
  const char* name;
  const char* fault;
  bool succeeds;
  double from_s, to_s;  ///< [s] simulated time at which the mission ends
  const char* reason = "time limit of 60 s (max_sim_time_s of report)";  ///< of a failure
};

class FaultAnswer : public MissionRun, public ::testing::WithParamInterface<Row> {};

TEST_P(FaultAnswer, IsThatOfTheTable) {
  const Row& row = GetParam();
  write("faults.yaml", std::string("faults:\n  - {") + row.fault + "}\n");
  const int status = run("line", 60, {"--in-process", "--faults", (dir_ / "faults.yaml").string()});
  ASSERT_TRUE(report_.is_object()) << output_;
  EXPECT_EQ(status, row.succeeds ? exit_status::kOk : exit_status::kFailed) << output_;
  EXPECT_EQ(report_["success"], row.succeeds) << report_["reason"];
  EXPECT_EQ(report_.value("error", ""), "");
  EXPECT_GE(report_["sim_time_s"], row.from_s);
  EXPECT_LE(report_["sim_time_s"], row.to_s);
  EXPECT_EQ(report_["reason"], row.succeeds ? "" : row.reason);
}

constexpr const char* kNoPercepts = "the planner gave up: no percepts for 30 s: are the camera and perception running?";

constexpr Row kRows[] = {
    {"CameraFrozen", "topic: camera/image, kind: freeze, from_s: 4, until_s: 8", true, 14, 50},
    {"CameraGone", "topic: camera/image, kind: drop, from_s: 4", false, 33, 40, kNoPercepts},
    {"ImagesDamaged", "topic: camera/image, kind: corrupt, probability: 0.3", true, 12, 16},
    {"LineLate", "topic: perception/line, kind: delay, delay_ticks: 15", false, 59, 61},
    {"LineBiased", "topic: perception/line, kind: bias, field: offset_m, amount: 0.05", true, 12, 16},
    {"ImuGone", "topic: imu_state, kind: drop, from_s: 3", true, 12, 16},
    {"JointsGone", "topic: joint_state, kind: drop, from_s: 5, until_s: 6", true, 13, 20},
    {"JointsLate", "topic: joint_state, kind: delay, delay_ticks: 5", true, 13, 20},
    {"CommandsLost", "topic: joint_command, kind: drop, probability: 0.2", true, 13, 20},
    {"CommandsGone", "topic: joint_command, kind: drop, from_s: 5, until_s: 8", true, 15, 22},
    {"CommandsDamaged", "topic: joint_command, kind: corrupt, probability: 0.1", true, 12, 20},
    {"PoseGone", "topic: guidance/pose, kind: drop, from_s: 5, until_s: 8", true, 15, 22},
    {"TrajectoryGone", "topic: desired_trajectory, kind: drop, from_s: 5, until_s: 8", true, 15, 22},
    {"ContactsGone", "topic: contact_state, kind: drop, from_s: 3", false, 59, 61},
    {"RequestsLost", "topic: planner/request/v2, kind: drop, probability: 0.5", true, 12, 30},
    {"RequestsTwice", "topic: planner/request/v2, kind: duplicate", true, 12, 16},
    {"AuthorityUnknown", "topic: authority, kind: drop, from_s: 3, until_s: 6", true, 13, 20},
    {"EventsLost", "topic: task/event, kind: drop, probability: 0.3", true, 12, 16},
    {"EventsGone", "topic: task/event, kind: drop", true, 12, 16},
};
INSTANTIATE_TEST_SUITE_P(Line, FaultAnswer, ::testing::ValuesIn(kRows), [](const auto& row) { return row.param.name; });

}  // namespace
}  // namespace constrictor::testing
