// A robot with a second camera: a whole mission in one process and in many, and what cannot be done.
#include "integration/determinism_run.hpp"
#include "integration/run_ticks.hpp"

namespace constrictor::testing {
namespace {

using namespace std::chrono_literals;

class FurtherCameras : public DeterminismRun {
 protected:
  FurtherCameras() : DeterminismRun("short", 280s) {}
  static std::vector<std::string> with_second_camera(std::vector<std::string> more = {}) {
    more.insert(more.begin(), {"--robot", "mamba_two_cameras"});
    return more;
  }
};

TEST_F(FurtherCameras, AMissionSucceedsWithTheSameHashInOneProcessAndInMany) {
  const std::string expected = run("one", with_second_camera({"--in-process"}));
  EXPECT_EQ(report("one")["success"], true) << report("one")["reason"];
  Process process = start("many", with_second_camera());
  RunTicks ticks(process);
  for (const std::string victim : {"camera", "perception", "guidance"}) {
    const pid_t pid = running(victim);
    ASSERT_GT(pid, 0) << process.output();
    ASSERT_TRUE(ticks.pass(30)) << process.output();
    ::kill(pid, SIGKILL);
  }
  EXPECT_EQ(hash_of("many", process), expected);
  EXPECT_EQ(report("many")["success"], true) << report("many")["reason"];
}

TEST_F(FurtherCameras, WhatTheySeeChangesTheRun) {
  limit_sim_time(40.0);  // what is behind the robot counts when it has been in the map for some time
  EXPECT_NE(run("one", {"--in-process"}), run("two", with_second_camera({"--in-process"})));
}

TEST_F(FurtherCameras, AWrongEntryEndsTheRunBeforeItBegins) {
  std::ifstream original(source_path("components/lib/robot/mamba_two_cameras.yaml"));
  std::string text{std::istreambuf_iterator<char>(original), {}};
  const std::string key = "module: 0";
  const auto at = text.find(key);
  ASSERT_NE(at, std::string::npos);
  text.replace(at, key.size(), "module: 24");
  const auto file = (dir_ / "robot.yaml").string();
  std::ofstream(file) << text;
  Process process({program("constrictor"), "run", "short", "--robot", file});
  EXPECT_EQ(process.wait(60s), exit_status::kConfiguration);
  EXPECT_NE((process.output() + process.errors()).find("further_cameras[0].module: found 24, accepted"),
            std::string::npos)
      << process.output() << process.errors();
}

}  // namespace
}  // namespace constrictor::testing
