// camera_emulator: serves what the camera of the emulated robot sees, as multipart JPEG over HTTP, in real time.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <chrono>
#include <csignal>
#include <deque>
#include <optional>

#include "component/data_path.hpp"
#include "configuration/command_line.hpp"
#include "configuration/whole_file.hpp"
#include "sim/camera_emulator/emulated_camera.hpp"
#include "sim/camera_emulator/run_world.hpp"
#include "sim/camera_emulator/stream_server.hpp"
#include "sim/emulation/emulator_process.hpp"
#include "sim/emulation/shared_world.hpp"
#include "sim/physics/scene_description.hpp"
#include "sim/scenario_loader/scenario_file.hpp"

namespace {

using namespace constrictor;
using namespace constrictor::camera_emulator;
namespace fs = std::filesystem;
using Clock = std::chrono::steady_clock;

constexpr double kTick_s = 0.02;  // in which the robot file counts the camera's period
constexpr auto kLongestWait = std::chrono::milliseconds(20);

struct Options {
  fs::path robot = default_robot_file();
  fs::path scenario = default_scenario_file();
  fs::path output = ".";
  fs::path world;
  std::optional<std::uint32_t> run;
  std::uint64_t seed = 1;
  std::string address = "127.0.0.1";
  std::uint16_t port = 0;
  double frame_rate_hz = 0.0;
  CameraSettings settings{1, 90, {false, false, false, false, 0.0, 0.02, 0.0, 0.0}};
};

void emulate(const Options& options, const Log& log) {
  ::signal(SIGPIPE, SIG_IGN);  // a viewer may leave while it is sent a frame
  const RobotModel robot = load_robot(options.robot);
  const Scenario scenario = load_scenario(options.scenario, options.seed);
  fs::create_directories(options.output);
  EmulatedCamera camera(robot, scenario, options.seed, options.settings);
  emulation::SharedWorldReader world(options.world.empty() ? options.output / "world.state" : options.world,
                                     robot.module_count, scenario.objects.size());
  std::optional<RunWorld> run;
  if (options.run) run.emplace(*options.run);
  const msg::SceneDescription scene = scene_description(scenario, robot);
  const auto look = [&]() -> std::optional<msg::WorldState> {
    if (run) return run->read(scene);
    if (const auto snapshot = world.read()) return snapshot->world;
    return {};
  };
  StreamServer server(options.address, options.port);
  emulation::CommandPipe commands(options.output / "camera_emulator.commands");
  const fs::path url = options.output / "camera_emulator.url";
  const std::string address = fmt::format("http://{}:{}/stream", options.address, server.port());
  write_whole(url, address + "\n");
  log.info("serves {} x {} pixels at {}", robot.camera.width * options.settings.scale,
           robot.camera.height * options.settings.scale, address);

  const double rate_hz =
      options.frame_rate_hz > 0.0 ? options.frame_rate_hz : 1.0 / (kTick_s * robot.camera.period_ticks);
  const auto period = std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(1.0 / rate_hz));
  struct Waiting {
    Clock::time_point at;
    Jpeg jpeg;
  };
  std::deque<Waiting> waiting;
  Clock::time_point next_exposure = Clock::now();
  bool seen = false;
  while (emulation::runs_on()) {
    emulation::obey_commands(commands, log, [&](const std::string& line) {
      std::string refusal = camera.command(line);
      server.switch_on(!camera.faults().off);
      return refusal;
    });
    const auto now = Clock::now();
    if (now >= next_exposure) {
      next_exposure += period;
      if (next_exposure < now) next_exposure = now + period;  // a slow host leaves frames out
      if (const auto now_there = look()) {
        if (!std::exchange(seen, true)) log.info("sees the world");
        const EmulatedFrame frame = camera.expose(*now_there);
        // A later frame never overtakes an earlier one.
        auto at = now + std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(frame.delay_s));
        if (!waiting.empty()) at = std::max(at, waiting.back().at);
        if (frame.jpeg) waiting.push_back({at, frame.jpeg});
      }
    }
    for (; !waiting.empty() && waiting.front().at <= Clock::now(); waiting.pop_front()) {
      if (!camera.faults().silent && !camera.faults().off) server.send(waiting.front().jpeg);
    }
    auto end = std::min(next_exposure, Clock::now() + kLongestWait);
    if (!waiting.empty()) end = std::min(end, waiting.front().at);
    server.serve_until(end);
  }
  std::error_code ignored;
  fs::remove(url, ignored);
  log.info("ends");
}

}  // namespace

int main(int argc, char** argv) {
  Options options;
  CLI::App app{"camera_emulator: serves what the camera of the emulated robot sees, as multipart JPEG over HTTP."};
  app.add_option("--robot", options.robot, "robot file (YAML)")->check(existing_file());
  app.add_option("--scenario", options.scenario, "scenario file (YAML)")->check(existing_file());
  app.add_option("--seed", options.seed, "seed of the scenario and of the noise")->check(whole_number());
  app.add_option("--output", options.output,
                 "folder in which camera_emulator.url and the pipe camera_emulator.commands are made")
      ->capture_default_str();
  app.add_option("--world", options.world,
                 "file in which servo_emulator keeps its world (default: world.state in --output)");
  app.add_option("--run", options.run, "DDS domain of a simulated run, whose world is drawn instead of --world")
      ->check(whole_number(0, 229));
  app.add_option("--address", options.address, "IP address to listen on")->capture_default_str();
  app.add_option("--port", options.port, "TCP port; 0: a free one")
      ->check(whole_number(0, 65535))
      ->capture_default_str();
  app.add_option("--rate", options.frame_rate_hz, "[Hz] frames in a second; 0: as in the robot file")
      ->capture_default_str()
      ->check(number(0.0, 120.0, "Hz"));
  app.add_option("--scale", options.settings.scale, "times the width and height of the robot file")
      ->capture_default_str()
      ->check(whole_number(1, 4));
  app.add_option("--quality", options.settings.jpeg_quality, "of the JPEG pictures")
      ->capture_default_str()
      ->check(whole_number(1, 100));
  app.add_option("--delay", options.settings.usual.delay_s, "[s] from the exposure until a frame is sent")
      ->capture_default_str()
      ->check(number(0.0, 10.0, "s"));
  app.add_option("--jitter", options.settings.usual.jitter_s, "[s] up to so much is added to the delay of each frame")
      ->capture_default_str()
      ->check(number(0.0, 10.0, "s"));
  app.add_option("--drop", options.settings.usual.drop, "probability that a frame is never sent")
      ->capture_default_str()
      ->check(number(0.0, 1.0, ""));
  app.footer(
      "It draws the world of a servo_emulator with the same robot, scenario and seed, and sends no frame before that\n"
      "runs. It ends on SIGTERM, SIGINT, or when the process that started it has ended.\n\n"
      "EXAMPLES\n  servo_emulator --output /tmp/robot &\n  camera_emulator --output /tmp/robot --port 8080\n"
      "  ffplay http://127.0.0.1:8080/stream\n  echo 'blur 3' > /tmp/robot/camera_emulator.commands\n\n"
      "EXIT STATUS\n  0 it was ended; 64 wrong usage; 70 it failed; 78 wrong configuration");
  return emulation::run_emulator("camera_emulator", app, argc, argv, [&](const Log& log) { emulate(options, log); });
}
