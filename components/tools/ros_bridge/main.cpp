// ros_bridge: shows the robot to ROS 2 tools on ROS 2's topics.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>

#include "client/run_registry.hpp"
#include "component/data_path.hpp"
#include "configuration/command_line.hpp"
#include "configuration/configuration.hpp"
#include "log/log.hpp"
#include "ros_bridge/bridge.hpp"
#include "runtime/git_revision.hpp"
#include "runtime/host.hpp"
#include "runtime/report_exception.hpp"
#include "runtime/version_text.hpp"

namespace {

using namespace constrictor;

volatile std::sig_atomic_t g_stop = 0;

void print_bridge(const ros_bridge::BridgeOptions& options, const std::string& robot, const ros_bridge::Node& node) {
  const RunNote& run = options.run;
  fmt::print("run {} ({}, seed {}, robot {}) is node /{} in ROS_DOMAIN_ID {}{}; Ctrl-C ends the bridge, not the run\n",
             run.domain, run.scenario, run.seed, robot, node.name(), options.ros_domain,
             options.ros_localhost_only ? ", on this host only" : "");
  for (const bool written : {true, false}) {
    fmt::print("{}:\n", written ? "written" : "read");
    for (const auto& topic : node.topics()) {
      if (topic.written == written) fmt::print("  {:<26} {}\n", topic.name, topic.type);
    }
  }
  std::fflush(stdout);
}

/// The robot file with which the launcher on this host has started the run; else the default one.
std::string robot_of(const RunNote& run) {
  const auto record =
      nlohmann::json::parse(std::ifstream(run.report_dir / "run.json"), nullptr, /*allow_exceptions=*/false);
  const auto robot = record.find("robot");
  if (run.on_this_host && robot != record.end() && robot->is_string()) return robot->get<std::string>();
  return default_robot_file();
}

int bridge_run(std::optional<std::uint32_t> domain, ros_bridge::BridgeOptions options, std::string robot) {
  options.run = join_run(domain);
  if (robot.empty()) robot = robot_of(options.run);
  const RobotModel model = load_robot(robot);
  const constrictor::Log log("ros_bridge");
  ros_bridge::Bridge bridge(options, model, log);
  print_bridge(options, model.name, bridge.node());
  while (!g_stop && bridge.over().empty()) bridge.serve(ros_bridge::Bridge::SteadyClock::now());
  if (!bridge.over().empty()) fmt::print("{}\n", bridge.over());
  else if (!bridge.leave()) log.warning("no answer from `input`; authority ends with this process");
  return exit_status::kOk;
}

}  // namespace

int main(int argc, char** argv) {
  ros_bridge::BridgeOptions options;
  std::optional<std::uint32_t> domain;
  std::string robot;
  std::string level = "operator";
  std::string distribution = "jazzy";
  const char* localhost = std::getenv("ROS_LOCALHOST_ONLY");
  const char* range = std::getenv("ROS_AUTOMATIC_DISCOVERY_RANGE");
  options.ros_localhost_only =
      (localhost && std::string(localhost) == "1") || (range && std::string(range) == "LOCALHOST");

  CLI::App app{
      "Shows a run to ROS 2 (joints, tf, odometry, images, map, diagnostics, logs), and takes velocities, tasks and\n"
      "emergency stops from ROS 2. Without options it bridges the only run on this host to ROS_DOMAIN_ID.",
      "ros_bridge"};
  app.footer(
      "EXAMPLES\n  ros_bridge\n  ros_bridge --run 3 --ros-domain 7 --localhost\n"
      "  ros2 topic echo /joint_states        # in another terminal, where ROS 2 is installed\n\n"
      "EXIT STATUS\n  0 the run has ended, or SIGTERM, or Ctrl-C; 64 wrong usage; 70 no run, several and none chosen, "
      "or\n"
      "  DDS fails; 78 wrong robot file");
  app.set_version_flag("--version", [] { return version_text("ros_bridge", kGitRevision); });
  app.add_option("--run,--domain", domain,
                 "DDS domain of the run, as `constrictor run` prints it (default: the only run here)")
      ->envname("CONSTRICTOR_DOMAIN")
      ->check(whole_number(0, 229));
  app.add_option("--ros-domain", options.ros_domain, "ROS 2's domain")
      ->envname("ROS_DOMAIN_ID")
      ->check(whole_number(0, 229))
      ->capture_default_str();
  app.add_option("--ros-distro", distribution,
                 "release of ROS 2; ids of nodes are longer in humble than in all later releases")
      ->envname("ROS_DISTRO")
      ->check(one_of({"humble", "iron", "jazzy", "kilted", "lyrical", "rolling"}))
      ->capture_default_str();
  app.add_flag("--localhost", options.ros_localhost_only,
               "use ROS 2's domain on this host only; the same as ROS_LOCALHOST_ONLY=1 or "
               "ROS_AUTOMATIC_DISCOVERY_RANGE=LOCALHOST");
  app.add_option("--robot", robot, "robot file (default: that of the run if it was started on this host, else mamba)")
      ->check(existing_file());
  app.add_option("--level", level, "level of the requests for velocities and tasks")
      ->check(one_of({"operator", "external"}))
      ->capture_default_str();
  app.add_option("--hold-after", options.hold_after_s, "[s] without /cmd_vel until the robot stands still")
      ->check(number(0.05, 60.0, "s"))
      ->capture_default_str();
  if (const auto status = parse_command_line(app, argc, argv)) return *status;
  options.level = level == "operator" ? msg::kAuthorityOperator : msg::kAuthorityExternal;
  options.release = distribution == "humble" ? ros_bridge::Release::kHumble : ros_bridge::Release::kIron;
  struct sigaction action {};
  action.sa_handler = [](int) { g_stop = 1; };
  ::sigaction(SIGTERM, &action, nullptr);
  ::sigaction(SIGINT, &action, nullptr);
  try {
    return bridge_run(domain, options, robot);
  } catch (...) {
    return report_exception("ros_bridge");
  }
}
