// The driver of a real camera in a run of real processes: DDS, HTTP, an emulated camera that is broken and mended.
#include "integration/emulated_hardware.hpp"

namespace constrictor::testing {
namespace {

using namespace std::chrono_literals;

TEST_F(EmulatedHardware, SeesReportsEachFaultOfTheCameraAndEndsInOrder) {
  Process launcher = run("line");
  ASSERT_TRUE(eventually([&] { return camera().value("published", 0) >= 3; }, 30s))
      << launcher.output() << launcher.errors();
  EXPECT_LT(camera()["age_ms"]["median"].get<double>(), 200.0);

  order("freeze");
  EXPECT_TRUE(camera_is("frozen", true));
  order("mend");
  EXPECT_TRUE(camera_is("frozen", false));
  order("black");
  EXPECT_TRUE(camera_is("black", true));
  order("off");
  EXPECT_TRUE(camera_is("connected", false));
  order("mend");
  EXPECT_TRUE(camera_says([](const json& now) { return now["connected"] == true && now["black"] == false; }));
  EXPECT_GE(camera()["openings"].get<int>(), 2);

  // The successor of a killed driver finds the camera again.
  ::kill(processes().at("video_capture"), SIGKILL);
  EXPECT_TRUE(launcher.wait_for("restarted as incarnation 2", 20s)) << launcher.output();
  const auto published = camera()["published"].get<std::uint64_t>();
  EXPECT_TRUE(camera_says([&](const json& now) { return now["published"].get<std::uint64_t>() > published; }));

  EXPECT_EQ(command({"end"}), exit_status::kOk) << output_;
  EXPECT_EQ(launcher.wait(20s), 128 + SIGTERM);
  EXPECT_TRUE(launcher.wait_for("in the emulated world", 5s)) << launcher.output();
  expect_nothing_left();
  const json report = this->report("run");
  EXPECT_EQ(report["judged_by"], "the robot");
  EXPECT_TRUE(report["state_hash"].is_null());
  EXPECT_TRUE(report["truth"]["success"].is_boolean());
  int refused_by_perception = 0;
  for (const auto& process : report["processes"])
    if (process["name"] == "perception") refused_by_perception = process["refused"];
  EXPECT_GE(refused_by_perception, 1) << "perception refuses the images of a frozen camera";
}

TEST_F(EmulatedHardware, AGroupThatAProgramCannotHostIsRefusedBeforeTheRun) {
  Process launcher = run("line", {"--in-process"});
  EXPECT_EQ(launcher.wait(30s), 78) << launcher.output();
  EXPECT_NE(launcher.errors().find("leave out --in-process"), std::string::npos) << launcher.errors();
  EXPECT_FALSE(std::filesystem::exists(run_dir_));
}

TEST_F(EmulatedHardware, AFileOfFaultsBreaksAndMendsItsDevices) {
  write("faults.yaml",
        "faults:\n"
        "  - {device: camera_emulator, kind: black, from_s: 1, until_s: 2.5}\n"
        "  - {device: servo_emulator, kind: numb, module: 3, from_s: 1}\n"
        "  - {device: servo_emulator, kind: silent, joint: 6, from_s: 3, until_s: 4}\n");
  Process launcher = run("line", {"--faults", (dir_ / "faults.yaml").string()});
  EXPECT_TRUE(launcher.wait_for("black of camera_emulator begins at 1.0 s", 40s)) << launcher.output();
  EXPECT_TRUE(camera_is("black", true));
  EXPECT_TRUE(launcher.wait_for("black of camera_emulator ends at 2.5 s", 20s)) << launcher.output();
  EXPECT_TRUE(camera_is("black", false));
  EXPECT_TRUE(launcher.wait_for("silent 6 of servo_emulator ends at 4.0 s", 20s)) << launcher.output();
  const auto bus_says = [&](const std::string& text) {
    return eventually([&] {
      std::ifstream file(run_dir_ / "servo_bus.json");
      return std::string{std::istreambuf_iterator<char>(file), {}}.find(text) != std::string::npos;
    });
  };
  EXPECT_TRUE(bus_says("servo 7 of joint 6 at bus0 does not answer"));
  EXPECT_TRUE(bus_says("servo 7 of joint 6 at bus0 is back")) << launcher.output();
  EXPECT_EQ(command({"end"}), exit_status::kOk) << output_;
  EXPECT_EQ(launcher.wait(20s), 128 + SIGTERM);
  expect_nothing_left();
  EXPECT_TRUE(std::filesystem::exists(run_dir_ / "faults.yaml"));
}

TEST_F(EmulatedHardware, AFaultOfADeviceThatTheRunDoesNotHaveIsRefusedBeforeItStarts) {
  write("faults.yaml", "faults:\n  - {device: servo_emulator, kind: stuck, joint: 6}\n");
  const std::string faults = (dir_ / "faults.yaml").string();
  EXPECT_EQ(command({"run", "line", "--faults", faults}), exit_status::kConfiguration) << output_;
  EXPECT_NE(output_.find("accepted none: the manifest has no emulated devices"), std::string::npos) << output_;
}

TEST_F(EmulatedHardware, RefusesASourceThatCannotBeReadBeforeTheRobotMoves) {
  write("camera.yaml", "source: no_such_film.mp4\n");
  Process launcher = run("line", {"--config", "camera=" + (dir_ / "camera.yaml").string()});
  EXPECT_EQ(launcher.wait(30s), exit_status::kConfiguration) << launcher.output();
  EXPECT_NE(launcher.output().find("no such file"), std::string::npos) << launcher.output();
  expect_nothing_left();
}

}  // namespace
}  // namespace constrictor::testing
