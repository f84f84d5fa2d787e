// The driver of real servos in a run of real processes: DDS, pseudo-terminals and emulated servos. What really happens
// is judged by the file that the emulator writes.
#include <csignal>

#include "integration/servo_bus_processes.hpp"

namespace constrictor::testing {
namespace {

using namespace std::chrono_literals;

TEST_F(ServoBusProcesses, IsDrivenSurvivesAPulledCableAndAKillAndStops) {
  Process launcher = run();
  ASSERT_TRUE(eventually([&] { return joints(23, 0); }, 30s)) << launcher.output() << launcher.errors();
  Process teleop = start({"teleop", "--drive", "0.4,0"});
  ASSERT_TRUE(teleop.wait_for("driving", 20s)) << teleop.errors();
  EXPECT_TRUE(moves());

  order("cable 0 9");  // the servos of joints 10 to 22 lose their power
  EXPECT_TRUE(eventually([&] { return joints(10, 13); }));
  order("mend 0");
  EXPECT_TRUE(eventually([&] { return joints(23, 0); }));
  EXPECT_TRUE(moves()) << "the operator still drives";

  // The successor comes within the time of the watchdogs, finds the joints where they are, and goes on.
  ::kill(processes().at("servo_bus"), SIGKILL);
  EXPECT_TRUE(launcher.wait_for("restarted as incarnation 2", 20s)) << launcher.output();
  EXPECT_TRUE(moves());

  ::kill(processes().at("input"), SIGSTOP);  // the driver obeys a stop by itself
  EXPECT_EQ(command({"stop"}), exit_status::kOk) << output_;
  EXPECT_TRUE(rests());
  ::kill(processes().at("input"), SIGCONT);
  const json record = driver();
  std::printf("time on the buses in a tick: median %.2f ms, 99 %% below %.2f ms, longest %.2f ms\n",
              record["round_ms"]["median"].get<double>(), record["round_ms"]["p99"].get<double>(),
              record["round_ms"]["longest"].get<double>());
  teleop.signal(SIGINT);
  teleop.wait(10s);
  end(launcher);
}

TEST_F(ServoBusProcesses, AFrozenDriverLeavesTheServosLockedUntilAnOperatorClearsTheStop) {
  Process launcher = run();
  ASSERT_TRUE(eventually([&] { return joints(23, 0); }, 30s)) << launcher.output() << launcher.errors();
  Process teleop = start({"teleop", "--drive", "0.4,0"});
  ASSERT_TRUE(teleop.wait_for("driving", 20s)) << teleop.errors();
  ASSERT_TRUE(moves());
  ::kill(processes().at("servo_bus"), SIGSTOP);
  static_cast<void>(motion_rad(2.5));  // the watchdogs of the servos trip
  EXPECT_TRUE(rests());
  ::kill(processes().at("servo_bus"), SIGCONT);
  const auto locked = [this] {
    const json now = driver();
    return now.is_object() && now["joints"][0]["watchdog"] == -1 && now["joints"][0]["torque_on"] == true;
  };
  EXPECT_TRUE(eventually(locked));
  EXPECT_TRUE(rests()) << "it waits for an operator";
  teleop.signal(SIGINT);
  teleop.wait(10s);
  EXPECT_EQ(command({"clear-stop"}), exit_status::kOk) << output_;
  EXPECT_TRUE(eventually([&] { return !locked(); }));
  EXPECT_TRUE(rests()) << "clearing a stop starts no motion";
  Process again = start({"teleop", "--drive", "0.4,0"});
  EXPECT_TRUE(moves()) << again.errors();
  again.signal(SIGINT);
  again.wait(10s);
  end(launcher);
}

// An adapter of the contact boards disappears with its pseudo-terminal. The driver tries to open it again within ticks,
// and those must not wait for it: the servos at the other port would stop.
TEST_F(ServoBusProcesses, GoesOnWithoutAnAdapterAndTakesItBack) {
  split_robot();
  std::optional<Process> boards = emulate_boards();
  Process launcher = run({}, (dir_ / "split.yaml").string());
  ASSERT_TRUE(eventually([&] { return joints(23, 0) && is_open(1); }, 30s)) << launcher.output() << launcher.errors();
  Process teleop = start({"teleop", "--drive", "0.4,0"});
  ASSERT_TRUE(teleop.wait_for("driving", 20s)) << teleop.errors();
  EXPECT_TRUE(moves());

  // In order, so that the name of the port disappears as that of a real adapter does. A stale name might soon be that
  // of another program's terminal.
  boards->signal(SIGTERM);
  EXPECT_EQ(boards->wait(20s), 0) << boards->errors();
  ASSERT_TRUE(eventually([&] { return !is_open(1); }));
  const std::int64_t gone_at = driver()["tick"].get<std::int64_t>();
  const double gone_at_s = world()["time_s"].get<double>();
  // Eight attempts to open the port fall into 200 ticks.
  EXPECT_TRUE(eventually([&] { return driver().value("tick", std::int64_t{0}) >= gone_at + 200; }, 12s));
  EXPECT_LT(world()["time_s"].get<double>() - gone_at_s, 10.0) << "200 ticks are 4 s";
  EXPECT_FALSE(tripped());
  EXPECT_TRUE(joints(23, 0)) << "the servos at the other port";
  EXPECT_TRUE(moves()) << "the operator still drives";
  EXPECT_EQ(command({"status"}), exit_status::kOk);
  EXPECT_NE(output_.find("port bus1 is gone"), std::string::npos) << output_;

  boards = emulate_boards();
  EXPECT_TRUE(eventually([&] { return is_open(1); }));
  EXPECT_TRUE(eventually([&] { return driver()["news"].dump().find("answers again") != std::string::npos; }));
  EXPECT_TRUE(moves());
  EXPECT_FALSE(tripped());
  EXPECT_EQ(command({"status"}), exit_status::kOk);
  EXPECT_EQ(output_.find("is gone,"), std::string::npos) << output_;
  teleop.signal(SIGINT);
  teleop.wait(10s);
  end(launcher);
}

}  // namespace
}  // namespace constrictor::testing
