// Begin and end of runs with the driver of servos: what a run leaves to the next one, and which runs are refused.
#include <csignal>

#include "integration/servo_bus_processes.hpp"

namespace constrictor::testing {
namespace {

// The servos stay powered between the runs: their emulator is no part of them.
TEST_F(ServoBusProcesses, AnOrderlyEndLeavesNoTrippedWatchdogAndAKillDoes) {
  Process servos({program("servo_emulator"), "--output", boards_dir_.string()});
  ASSERT_TRUE(servos.wait_for("servos answer", 20s)) << servos.errors();
  const auto text_of = [](const std::filesystem::path& file) {
    std::ifstream stream(file);
    return std::string{std::istreambuf_iterator<char>(stream), {}};
  };
  std::string bus = text_of(source_path("deploy/buses/mamba_emulated.yaml"));
  for (const std::string name : {"bus0", "bus1"})
    bus.replace(bus.find("device: " + name) + 8, 4, (boards_dir_ / name).string());
  write("bus.yaml", bus);
  const auto configure = [this](const std::string& watchdog_s) {
    write("patient.yaml", "servo: {watchdog_s: " + watchdog_s + "}\nbus_file: " + (dir_ / "bus.yaml").string() + "\n");
  };
  std::string manifest = text_of(source_path("deploy/emulated_servos.yaml"));
  const auto beside = manifest.find("\nbeside:") + 1;
  manifest.erase(beside, manifest.find("processes:") - beside);
  write("alone.yaml", manifest);
  const auto begin = [&](const std::string& name) {
    run_dir_ = dir_ / name;
    return run({}, (dir_ / "alone.yaml").string());
  };
  const auto scan = [&] {
    EXPECT_EQ(command({"servo", "scan", "--port", (boards_dir_ / "bus0").string()}), exit_status::kOk) << output_;
    return output_;
  };

  configure("0.1");  // as by default
  Process first = begin("first");
  ASSERT_TRUE(eventually([&] { return joints(23, 0); }, 30s)) << first.output() << first.errors();
  end(first);
  EXPECT_EQ(scan().find("torque on"), std::string::npos) << output_;
  EXPECT_EQ(output_.find("watchdog tripped"), std::string::npos) << output_;

  configure("2");
  Process second = begin("second");
  ASSERT_TRUE(eventually([&] { return joints(23, 0); }, 30s)) << second.output() << second.errors();
  EXPECT_FALSE(tripped());
  second.signal(SIGKILL);
  second.wait(20s);
  ASSERT_TRUE(eventually([&] { return processes().empty(); }));
  run_dir_ = boards_dir_;            // the notes of the emulator
  EXPECT_LT(motion_rad(2.5), 0.02);  // the time of the watchdogs, in which nobody asks the servos
  EXPECT_NE(scan().find("torque on, error: none, watchdog tripped"), std::string::npos) << output_;

  Process third = begin("third");
  ASSERT_TRUE(eventually([&] { return joints(23, 0); }, 30s)) << third.output() << third.errors();
  EXPECT_TRUE(tripped()) << "the start does not clear it";
  EXPECT_EQ(command({"doctor"}), exit_status::kFailed) << output_;
  EXPECT_NE(output_.find("emergency stop of bus_watchdog"), std::string::npos) << output_;
  EXPECT_EQ(command({"log", run_dir_.string(), "--component", "servo_bus", "--level", "warning"}), exit_status::kOk);
  EXPECT_NE(output_.find("has stopped: its bus was silent"), std::string::npos) << output_;
  EXPECT_EQ(command({"clear-stop"}), exit_status::kOk) << output_;
  EXPECT_TRUE(eventually([&] { return !tripped(); }));
  end(third);
  EXPECT_EQ(scan().find("watchdog tripped"), std::string::npos) << output_;
}

TEST_F(ServoBusProcesses, RefusesAPaceThatServosCannotFollow) {
  Process launcher = run({"--pace", "4x"});
  EXPECT_EQ(launcher.wait(20s), exit_status::kUsage);
  EXPECT_NE(launcher.errors().find("accepted realtime"), std::string::npos) << launcher.errors();
}

TEST_F(ServoBusProcesses, RefusesARunWithoutRealTimeBeforeAServoHasTorque) {
  std::ifstream original(source_path("deploy/emulated_servos.yaml"));
  std::string manifest{std::istreambuf_iterator<char>(original), {}};
  manifest.erase(manifest.find("real_time: true"), 15);
  write("fast.yaml", manifest);
  Process launcher = run({}, (dir_ / "fast.yaml").string());
  EXPECT_EQ(launcher.wait(20s), exit_status::kConfiguration);
  EXPECT_NE(launcher.errors().find("accepted `real_time: true` in the manifest"), std::string::npos)
      << launcher.errors();
  EXPECT_FALSE(std::filesystem::exists(run_dir_));
  // The driver refuses it also where no launcher has checked the run.
  Process driver({program("servo_bus"), "--plant", "servo_bus", "--domain", "100", "--output", dir_.string()});
  EXPECT_EQ(driver.wait(20s), exit_status::kConfiguration);
  EXPECT_NE(driver.errors().find("servo_bus drives a device that cannot be faster than the clock"), std::string::npos)
      << driver.errors();
}

TEST_F(ServoBusProcesses, AnEmulatedRunIsNotResumed) {
  Process launcher = run();
  ASSERT_TRUE(eventually([&] { return joints(23, 0); }, 30s)) << launcher.output() << launcher.errors();
  launcher.signal(SIGKILL);
  launcher.wait(20s);
  ASSERT_TRUE(eventually([&] { return processes().empty(); }));
  EXPECT_EQ(command({"run", "--resume", run_dir_.string()}), exit_status::kConfiguration) << output_;
  EXPECT_NE(output_.find("found a run with servo_emulator beside it"), std::string::npos) << output_;
}

TEST_F(ServoBusProcesses, AStartWithAWrongConfigurationIsNotOfferedToBeResumed) {
  std::ifstream original(source_path("deploy/emulated_servos.yaml"));
  std::string manifest{std::istreambuf_iterator<char>(original), {}};
  const auto beside = manifest.find("\nbeside:") + 1;
  manifest.erase(beside, manifest.find("processes:") - beside);
  write("alone.yaml", manifest);
  write("patient.yaml", "port: {patience_s: 0}\n");  // the ports are in another folder
  Process launcher = run({}, (dir_ / "alone.yaml").string());
  EXPECT_EQ(launcher.wait(30s), exit_status::kConfiguration) << launcher.output();
  EXPECT_EQ((launcher.output() + launcher.errors()).find("--resume"), std::string::npos)
      << launcher.output() << launcher.errors();
}

}  // namespace
}  // namespace constrictor::testing
