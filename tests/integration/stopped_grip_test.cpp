// An emergency stop while the robot carries an object.
#include <fstream>
#include <nlohmann/json.hpp>

#include "integration/cli_fixture.hpp"
#include "runtime/host.hpp"

namespace constrictor::testing {
namespace {

constexpr int kStop_tick = 1400;

class StoppedGrip : public CliFixture {};

// In the stop the joints hold the measured posture, so that the base of the U no longer presses the object.
TEST_F(StoppedGrip, IsNotReportedAsLost) {
  write("physics.yaml", "stop_at_ticks: [" + std::to_string(kStop_tick) + "]\n");
  const auto report = dir_ / "r";
  EXPECT_EQ(command({"run", "short", "--seed", "4", "--in-process", "--report", report.string(), "--config",
                     "physics=" + (dir_ / "physics.yaml").string(), "--max-sim-time", "35"}),
            exit_status::kFailed)
      << output_;
  std::ifstream file(report / "report.json");
  const auto json = nlohmann::json::parse(file);
  double grasped_s = 1e9;
  for (const auto& event : json.at("events")) {
    if (event.at("event") == "object_grasped") grasped_s = event.at("sim_time_s");
    EXPECT_NE(event.at("event"), "object_grasp_lost") << event;
    EXPECT_NE(event.at("event"), "dropping_done") << event;
  }
  EXPECT_LT(grasped_s, 0.02 * kStop_tick) << "the robot carries the object when it is stopped";
}

}  // namespace
}  // namespace constrictor::testing
