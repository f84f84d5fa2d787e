// The driver of real servos in a run of real processes: DDS, pseudo-terminals and emulated servos. What really happens
// is judged by the file that the emulator writes.
#include <csignal>

#include "integration/cli_fixture.hpp"
#include "runtime/host.hpp"
#include "support/command_lines.hpp"

namespace constrictor::testing {
namespace {

using namespace std::chrono_literals;
using nlohmann::json;

class ServoBusProcesses : public CliFixture {
 protected:
  ServoBusProcesses() { write("patient.yaml", "servo: {watchdog_s: 2}\n"); }
  /// The watchdogs have more patience than usual, because a test machine may be busy.
  [[nodiscard]] Process run(std::vector<std::string> more = {}, const std::string& manifest = "emulated_servos") const {
    std::vector<std::string> arguments = {
        "run",      "--manifest",     manifest, "--config", "servo_bus=" + (dir_ / "patient.yaml").string(),
        "--report", run_dir_.string()};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return start(std::move(arguments));
  }
  /// The world as the emulator noted it last; null before the first note.
  [[nodiscard]] json world() const {
    std::ifstream file(run_dir_ / "world.jsonl");
    std::string line, last;
    while (std::getline(file, line)) {
      if (!file.eof()) last = line;  // a line without its end is not whole
    }
    json found = json::parse(last, nullptr, false);
    return found.is_object() && found.contains("head_m") ? found : json();
  }
  /// What the driver says.
  [[nodiscard]] json driver() const { return json::parse(std::ifstream(run_dir_ / "servo_bus.json"), nullptr, false); }
  /// Whether so many joints are in these states.
  [[nodiscard]] bool joints(int ready, int lost) const {
    const json now = driver();
    if (!now.is_object() || !now.contains("joints")) return false;
    for (const auto& joint : now["joints"]) {
      if (joint["state"] == "ready") --ready;
      if (joint["state"] == "lost") --lost;
    }
    return ready == 0 && lost == 0;
  }
  /// Whether the driver has a port open. Port 1 is that of the contact boards.
  [[nodiscard]] bool is_open(std::size_t port) const {
    const json now = driver();
    return now.is_object() && now.contains("ports") && now["ports"][port]["open"] == true;
  }
  /// Whether a watchdog of a servo has tripped.
  [[nodiscard]] bool tripped() const {
    const json now = driver();
    if (!now.is_object() || !now.contains("joints")) return false;
    return std::any_of(now["joints"].begin(), now["joints"].end(),
                       [](const json& one) { return one["watchdog"] == -1; });
  }
  /// Splits the emulated robot: the servos are emulated beside the run, and the contact boards by a process of their
  /// own in the folder `boards`. Writes the bus file of each emulator, that of the driver, and the manifest.
  void split_robot() const {
    std::string servos = "servo: {model: xm540_w150}\njoints:\n";
    for (int id = 1; id <= 23; ++id) servos += "  - {id: " + std::to_string(id) + "}\n";
    std::string contacts = "contacts: {port: 1, ids: [";
    for (int id = 101; id <= 124; ++id) contacts += std::to_string(id) + (id < 124 ? ", " : "]}\n");
    const auto ports = [](const std::string& first, const std::string& second) {
      return "ports: [{device: " + first + ", baud: 4000000}, {device: " + second + ", baud: 4000000}]\n";
    };
    const std::string imu = "imu: {port: 0, id: 100}\n";
    write("servos.yaml", ports("bus0", "unused") + servos + imu);
    write("boards.yaml", ports("unused", "bus1") + servos + contacts);
    write("bus.yaml", ports("bus0", (boards_dir_ / "bus1").string()) + servos + imu + contacts);
    write("patient.yaml", "servo: {watchdog_s: 2}\nbus_file: " + (dir_ / "bus.yaml").string() + "\n");
    std::ifstream original(source_path("deploy/emulated_servos.yaml"));
    std::string manifest{std::istreambuf_iterator<char>(original), {}};
    const std::string emulator = "{program: servo_emulator";
    manifest.insert(manifest.find(emulator) + emulator.size(),
                    ", arguments: [\"--bus\", \"" + (dir_ / "servos.yaml").string() + "\"]");
    write("split.yaml", manifest);
  }
  [[nodiscard]] Process emulate_boards() const {
    Process boards(
        {program("servo_emulator"), "--bus", (dir_ / "boards.yaml").string(), "--output", boards_dir_.string()});
    EXPECT_TRUE(boards.wait_for("servos answer", 20s)) << boards.errors();
    return boards;
  }
  void order(const std::string& command) const {
    std::ofstream(run_dir_ / "servo_emulator.commands") << command << std::endl;
  }
  /// [rad] by which the joint that moves most moves between two notes that are at least `seconds` apart.
  [[nodiscard]] double motion_rad(double seconds) const {
    json before, after;
    EXPECT_TRUE(eventually([&] { return (before = world()).is_object(); }));
    EXPECT_TRUE(eventually([&] {
      after = world();
      return after.is_object() && after["time_s"].get<double>() >= before["time_s"].get<double>() + seconds;
    }));
    double most = 0.0;
    for (std::size_t i = 0; i < 23; ++i)
      most = std::max(most, std::abs(after["joints_rad"][i].get<double>() - before["joints_rad"][i].get<double>()));
    return most;
  }
  [[nodiscard]] bool moves() const {
    return eventually([&] { return motion_rad(0.3) > 0.1; }, 30s);
  }
  [[nodiscard]] bool rests() const {
    return eventually([&] { return motion_rad(0.6) < 0.02; }, 30s);
  }
  [[nodiscard]] std::map<std::string, pid_t> processes() const { return processes_naming(run_dir_); }
  void end(Process& launcher) {
    EXPECT_EQ(command({"end"}), exit_status::kOk) << output_;
    EXPECT_EQ(launcher.wait(20s), 128 + SIGTERM);
    EXPECT_TRUE(eventually([&] { return processes().empty(); })) << processes().begin()->first << " is left";
    EXPECT_FALSE(std::filesystem::exists(std::filesystem::symlink_status(run_dir_ / "bus0")));
  }

  std::filesystem::path run_dir_ = dir_ / "run";
  const std::filesystem::path boards_dir_ = dir_ / "boards";
};

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

}  // namespace
}  // namespace constrictor::testing
