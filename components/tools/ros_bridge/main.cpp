// ros_bridge: shows the robot to ROS 2 tools on ROS 2's topics.
#include <CLI/CLI.hpp>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <string>

#include "component/data_path.hpp"
#include "ros_bridge/bridge.hpp"
#include "runtime/host.hpp"
#include "runtime/version_text.hpp"

namespace {
volatile std::sig_atomic_t g_stop = 0;
}

int main(int argc, char** argv) {
  using namespace constrictor;
  ros::BridgeOptions options;
  std::string robot = data_path("components/lib/robot/mamba.yaml");
  std::string level = "operator";
  const char* localhost = std::getenv("ROS_LOCALHOST_ONLY");
  const char* range = std::getenv("ROS_AUTOMATIC_DISCOVERY_RANGE");
  options.ros_localhost_only =
      (localhost && std::string(localhost) == "1") || (range && std::string(range) == "LOCALHOST");

  CLI::App app{"Shows the robot to ROS 2 (rt/clock, joint_states, tf, imu, odom, camera) and takes rt/cmd_vel."};
  app.set_version_flag("--version", [] { return version_text("ros_bridge"); });
  app.add_option("--domain", options.domain, "DDS domain of the run, as `constrictor run` prints it")
      ->envname("CONSTRICTOR_DOMAIN")
      ->check(CLI::Range(0, 229))
      ->required();
  app.add_option("--ros-domain", options.ros_domain, "ROS 2's domain")
      ->envname("ROS_DOMAIN_ID")
      ->check(CLI::Range(0, 229))
      ->capture_default_str();
  app.add_flag("--localhost", options.ros_localhost_only,
               "use ROS 2's domain on this host only; the same as ROS_LOCALHOST_ONLY=1 or "
               "ROS_AUTOMATIC_DISCOVERY_RANGE=LOCALHOST");
  app.add_option("--robot", robot, "robot file (YAML)")->check(CLI::ExistingFile);
  app.add_option("--level", level, "level of the requests for rt/cmd_vel")
      ->check(CLI::IsMember({"operator", "external"}))
      ->capture_default_str();
  app.add_option("--hold-after", options.hold_after_s, "[s] without rt/cmd_vel until the robot stands still")
      ->check(CLI::Range(0.05, 60.0))
      ->capture_default_str();
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? exit_status::kOk : exit_status::kUsage;
  }
  options.level = level == "operator" ? msg::kAuthorityOperator : msg::kAuthorityExternal;
  struct sigaction action {};
  action.sa_handler = [](int) { g_stop = 1; };
  ::sigaction(SIGTERM, &action, nullptr);
  ::sigaction(SIGINT, &action, nullptr);
  try {
    ros::Bridge bridge(options, load_robot(robot));
    while (!g_stop && !bridge.over()) bridge.serve(ros::Bridge::SteadyClock::now());
    if (!bridge.over() && !bridge.leave())
      std::fprintf(stderr, "ros_bridge: no answer from `input`; authority ends with this process\n");
    return exit_status::kOk;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "ros_bridge: %s\n", error.what());
    return exit_status::kSoftware;
  }
}
