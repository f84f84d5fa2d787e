// Whole missions on emulated hardware, at real-time pace: success as the robot believes it, and as the emulated world
// has it.
#include <gtest/gtest.h>

#include "integration/emulated_hardware.hpp"

namespace constrictor::testing {
namespace {

using namespace std::chrono_literals;

class EmulatedMission : public EmulatedHardware {
 protected:
  void expect_success(Process& launcher, std::chrono::seconds bound) {
    EXPECT_EQ(launcher.wait(bound), exit_status::kOk) << launcher.output();
    const json report = this->report("run");
    EXPECT_EQ(report["success"], true) << report["reason"];
    EXPECT_EQ(report["truth"]["success"], true) << report["truth"]["reason"];
    std::printf("mission of %.1f s, %d recoveries\n", report["sim_time_s"].get<double>(),
                report["recoveries"].get<int>());
    expect_nothing_left();
  }
};

TEST_F(EmulatedMission, TheCaseStudySucceeds) {
  Process launcher = run("case_study", {"--seed", "1", "--max-sim-time", "600"});
  expect_success(launcher, 640s);
}

struct Fault {
  std::string name, command;
};

class CameraFault : public EmulatedMission, public ::testing::WithParamInterface<Fault> {};

TEST_P(CameraFault, OfFourSecondsDoesNotEndTheMission) {
  // Which frames are lost differs from run to run, and so does how long the robot looks for the line afterwards.
  Process launcher = run("line", {"--max-sim-time", "300"});
  ASSERT_TRUE(eventually([&] { return camera().value("tick", 0) >= 200; }, 60s)) << launcher.output();
  order(GetParam().command);
  const int begin = camera()["tick"];
  EXPECT_TRUE(camera_says([&](const json& now) { return now["tick"].get<int>() >= begin + 200; }));
  order("mend");
  expect_success(launcher, 340s);
}

INSTANTIATE_TEST_SUITE_P(Of, CameraFault,
                         ::testing::Values(Fault{"None", "mend"}, Fault{"Off", "off"}, Fault{"Silent", "silent"},
                                           Fault{"Black", "black"}, Fault{"Frozen", "freeze"},
                                           Fault{"Blurred", "blur 4"}, Fault{"Late", "delay 0.4"},
                                           Fault{"Dropped", "drop 0.5"}),
                         [](const auto& test) { return test.param.name; });

}  // namespace
}  // namespace constrictor::testing
