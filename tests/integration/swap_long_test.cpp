// The simulated camera is replaced by the driver of a real one, on an emulated camera's stream of the same world, while
// the robot follows the line.
#include "integration/cli_fixture.hpp"
#include "runtime/host.hpp"
#include "support/project.hpp"

namespace constrictor::testing {
namespace {

using namespace std::chrono_literals;

class SwapTest : public CliFixture {
 protected:
  [[nodiscard]] Process run(const std::string& pace) const {
    return start({"run", "line", "--pace", pace, "--max-sim-time", "60", "--report", run_dir_.string()});
  }
  const std::filesystem::path run_dir_ = dir_ / "run";
};

TEST_F(SwapTest, TheCameraIsReplacedWhileTheRobotFollowsTheLine) {
  Process launcher = run("realtime");
  const unsigned number = domain_of(launcher);
  ASSERT_GT(number, 0U);
  Process camera({program("camera_emulator"), "--run", std::to_string(number), "--scenario",
                  testing::source_path("sim/scenarios/line.yaml"), "--output", dir_.string()});
  ASSERT_TRUE(camera.wait_for("sees the world", 20s)) << camera.errors();
  write("camera.yaml", "source: " + (dir_ / "camera_emulator.url").string() + "\n");
  ASSERT_TRUE(launcher.wait_for("follow line (follow)", 30s)) << launcher.output();
  EXPECT_EQ(command({"swap", "camera", "--program", "video_capture", "--config", (dir_ / "camera.yaml").string()}),
            exit_status::kOk)
      << output_;
  EXPECT_NE(output_.find("camera is now video_capture (incarnation 2"), std::string::npos) << output_;
  EXPECT_EQ(launcher.wait(90s), exit_status::kOk) << launcher.output();
  const auto report = this->report("run");
  EXPECT_EQ(report["judged_by"], "ground truth");
  EXPECT_EQ(report["success"], true);
  const auto record = nlohmann::json::parse(std::ifstream(run_dir_ / "camera.json"), nullptr, false);
  EXPECT_GE(record.value("published", 0), 20) << "the mission was carried out with the images of the stream";
  camera.signal(SIGTERM);
  EXPECT_EQ(camera.wait(10s), 0);
}

TEST_F(SwapTest, RefusesWhatWouldEndTheRun) {
  Process launcher = run("realtime");
  ASSERT_GT(domain_of(launcher), 0U);
  ASSERT_TRUE(launcher.wait_for("simulated", 30s)) << launcher.output();
  write("wrong.yaml", "source: ftp://nobody\n");
  const std::string wrong = (dir_ / "wrong.yaml").string();
  EXPECT_EQ(command({"swap", "camera", "--program", "video_capture", "--config", wrong}), exit_status::kConfiguration);
  EXPECT_NE(output_.find("accepted /dev/videoN"), std::string::npos) << output_;
  EXPECT_EQ(command({"swap", "camera", "--program", "no_such_program"}), exit_status::kConfiguration) << output_;
  EXPECT_EQ(command({"swap", "camera", "--program", "servo_bus"}), exit_status::kConfiguration) << output_;
  EXPECT_NE(output_.find("servo_bus: found the component camera, accepted servo_bus"), std::string::npos) << output_;
  EXPECT_EQ(command({"swap", "physics", "--program", "video_capture"}), exit_status::kUsage) << output_;
  EXPECT_EQ(command({"swap", "nobody", "--program", "video_capture"}), exit_status::kUsage) << output_;
  EXPECT_EQ(command({"swap", "camra", "--program", "video_capture"}), exit_status::kUsage) << output_;
  EXPECT_NE(output_.find(", did you mean 'camera'?"), std::string::npos) << output_;
  EXPECT_EQ(command({"end"}), exit_status::kOk) << output_;
  for (const auto& process : report("run")["processes"]) EXPECT_EQ(process["restarts"], 0) << process["name"];
}

TEST_F(SwapTest, RefusesRunsInLockStep) {
  Process launcher = run("1x");
  ASSERT_GT(domain_of(launcher), 0U);
  EXPECT_EQ(command({"swap", "camera", "--program", "video_capture"}), exit_status::kUsage);
  EXPECT_NE(output_.find("accepted realtime"), std::string::npos) << output_;
  EXPECT_EQ(command({"end"}), exit_status::kOk) << output_;
}

}  // namespace
}  // namespace constrictor::testing
