// servo_emulator: answers on pseudo-terminals as the servos and boards of a robot would, and moves the robot in the
// simulated world in real time.
#include <fmt/format.h>
#include <poll.h>

#include <CLI/CLI.hpp>
#include <chrono>
#include <fstream>

#include "component/data_path.hpp"
#include "configuration/command_line.hpp"
#include "configuration/configuration.hpp"
#include "robot/robot_model.hpp"
#include "scheduling/scheduling.hpp"
#include "sim/emulation/emulator_process.hpp"
#include "sim/emulation/shared_world.hpp"
#include "sim/emulation/verdict.hpp"
#include "sim/scenario_loader/scenario_file.hpp"
#include "sim/servo_emulator/emulated_robot.hpp"
#include "sim/servo_emulator/pseudo_terminal.hpp"
#include "sim/servo_emulator/world_file.hpp"

namespace {

using namespace constrictor;
using namespace constrictor::servo_emulator;
namespace fs = std::filesystem;
using Clock = std::chrono::steady_clock;

constexpr int kPriority = 10;  // above all usual processes, below interrupts

struct Options {
  fs::path robot = default_robot_file();
  fs::path scenario = default_scenario_file();
  fs::path bus = data_path("deploy/buses/mamba_emulated.yaml");
  fs::path output = ".";
  std::uint64_t seed = 1;
  double note_every_s = 0.2;  ///< of world.jsonl
};

void emulate(const Options& options, const Log& log) {
  const dynamixel::BusPlan plan = dynamixel::load_bus_plan(options.bus, data_path("components/lib/dynamixel/models"));
  fs::create_directories(options.output);
  // Before any other file: the folder may belong to an emulator that runs.
  emulation::CommandPipe commands(options.output / "servo_emulator.commands");
  const RobotModel model = load_robot(options.robot);
  const double body_m = static_cast<double>(model.module_count) * model.module_length_m;
  EmulatedRobot robot(model, load_scenario(options.scenario, options.seed, body_m, model.module_radius_m), plan,
                      options.seed);
  WorldFile world(options.output / "world.jsonl", robot.world(), options.note_every_s);
  emulation::SharedWorldWriter shared(options.output / "world.state");
  const auto sequence = emulation::mission_sequence(options.scenario);
  std::vector<std::unique_ptr<PseudoTerminal>> terminals;
  for (const auto& port : plan.ports) {
    if (fs::path(port.device).is_absolute())
      throw ConfigurationError(
          fmt::format("{}: found the device {}, accepted a relative path: the emulator makes its "
                      "ports in the output folder and replaces no real one",
                      options.bus.string(), port.device));
    terminals.push_back(std::make_unique<PseudoTerminal>(options.output / port.device));
  }
  log.info("{} servos answer at {} ports in {}", plan.joints.size(), terminals.size(), options.output.string());

  // Real servos answer in time however busy the computer is.
  for (const auto& refusal : apply(Scheduling{kPriority, false, {}}))
    log.warning("the emulated servos may answer late when the computer is busy: {}", refusal);
  const auto start = Clock::now();
  const auto now_ns = [&] { return std::chrono::nanoseconds(Clock::now() - start).count(); };
  std::vector<pollfd> waits;
  for (const auto& terminal : terminals) waits.push_back({terminal->descriptor(), POLLIN, 0});
  waits.push_back({commands.descriptor(), POLLIN, 0});
  dynamixel::Bytes received;
  while (emulation::runs_on()) {
    std::int64_t due_ns = robot.next_step_ns();
    for (std::size_t i = 0; i < terminals.size(); ++i) {
      if (const auto& outgoing = robot.line(i).outgoing(); !outgoing.empty())
        due_ns = std::min(due_ns, outgoing.front().at_ns);
    }
    const std::int64_t wait_ns = std::max<std::int64_t>(0, due_ns - now_ns());
    const timespec wait = {wait_ns / 1'000'000'000, wait_ns % 1'000'000'000};
    ::ppoll(waits.data(), waits.size(), &wait, nullptr);
    for (std::size_t i = 0; i < terminals.size(); ++i) {
      terminals[i]->plug(!robot.line(i).faults.unplugged);
      waits[i].fd = terminals[i]->descriptor();
      received.clear();
      terminals[i]->read(received);
      if (!received.empty()) robot.line(i).receive(received, terminals[i]->baud(), now_ns());
    }
    emulation::obey_commands(commands, log, [&](const std::string& line) { return robot.command(line); });
    if (robot.advance_to(now_ns()) > 0) {
      shared.write(robot.world());
      world.note(robot.world(), robot.left_out_ns());
    }
    for (std::size_t i = 0; i < terminals.size(); ++i) {
      auto& outgoing = robot.line(i).outgoing();
      for (; !outgoing.empty() && outgoing.front().at_ns <= now_ns(); outgoing.pop_front())
        terminals[i]->write(outgoing.front().bytes);
    }
  }
  std::ofstream(options.output / "truth.json") << emulation::verdict_json(robot.world(), sequence, robot.left_out_ns());
  log.info("ends after {:.1f} s", robot.world().time_s());
}

}  // namespace

int main(int argc, char** argv) {
  Options options;
  CLI::App app{
      "servo_emulator: answers as the servos and sensor boards of a robot, on pseudo-terminals, in real time."};
  app.add_option("--robot", options.robot, "robot file (YAML)")->check(existing_file());
  app.add_option("--scenario", options.scenario, "scenario file (YAML)")->check(existing_file());
  app.add_option("--bus", options.bus, "bus file (YAML): the servos, their ids and ports")->check(existing_file());
  app.add_option("--seed", options.seed, "seed of the scenario and of the noise")->check(whole_number());
  app.add_option("--output", options.output,
                 "folder in which the ports, the pipe servo_emulator.commands, and the files world.jsonl,\nworld.state "
                 "and truth.json are made")
      ->capture_default_str();
  app.add_option("--note-every", options.note_every_s, "[s] time between two lines of world.jsonl")
      ->capture_default_str()
      ->check(number(0.005, 3600.0, "s"));
  app.footer(
      "It ends on SIGTERM, SIGINT, or when the process that started it has ended.\n\n"
      "EXAMPLES\n  servo_emulator --output /tmp/robot\n  echo 'cable 0 7' > /tmp/robot/servo_emulator.commands\n\n"
      "EXIT STATUS\n  0 it was ended; 64 wrong usage; 70 it failed; 78 wrong configuration");
  return emulation::run_emulator("servo_emulator", app, argc, argv, [&](const Log& log) { emulate(options, log); });
}
