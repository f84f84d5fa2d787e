// A fixture for tests of runs with the driver of servos, on emulated servos.
#pragma once

#include <algorithm>
#include <cmath>

#include "integration/cli_fixture.hpp"
#include "runtime/host.hpp"
#include "support/command_lines.hpp"

namespace constrictor::testing {

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

}  // namespace constrictor::testing
