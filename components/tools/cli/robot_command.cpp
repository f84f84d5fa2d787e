// `constrictor robot export`: the robot as a model of another simulator.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <memory>
#include <stdexcept>

#include "cli/launch_plan.hpp"
#include "cli/subcommands.hpp"
#include "cli/usage.hpp"
#include "robot/mujoco_model.hpp"
#include "robot/robot_model.hpp"
#include "runtime/host.hpp"

namespace constrictor::cli {
namespace {

struct Options {
  bool mjcf = false;
  std::string robot = "mamba";
  std::filesystem::path output;  ///< empty: standard output
};

int export_robot(const Options& options) {
  const std::string text = mujoco_model(load_robot(find_file(options.robot, kRobots)));
  const bool to_file = !options.output.empty();
  errno = 0;
  std::ofstream file;
  if (to_file) file.open(options.output);
  std::ostream& stream = to_file ? file : std::cout;
  stream << text << std::flush;  // a full disk is noticed here, and not in the destructor, which reports nothing
  if (stream) return exit_status::kOk;
  throw std::runtime_error(fmt::format("robot export: cannot write {}: {}",
                                       to_file ? options.output.string() : "the standard output",
                                       errno != 0 ? ::strerrordesc_np(errno) : "unknown error"));
}

}  // namespace

void add_robot(CLI::App& app, Action& action) {
  auto options = std::make_shared<Options>();
  auto* robot = add_group(app, "robot", "write the robot as a model of another simulator");
  auto* sub = add_subcommand(*robot, "export", "write the robot as a model of another simulator", action, options,
                             export_robot);
  sub->add_flag("--mjcf", options->mjcf, "XML file for the simulator MuJoCo (tested with version 2.2.2)")->required();
  sub->add_option("--robot", options->robot, "robot: a name (see `constrictor list robots`) or a file")
      ->capture_default_str();
  sub->add_option("--output", options->output,
                  "file to write; an existing file is replaced (default: standard output)");
  const std::string about =
      "The model contains: the modules as capsules with mass and inertia; the joints with axes, ranges, rotor inertia\n"
      "and gear friction; the servos with both gains and the limit of their torque; series-elastic elements; a ground\n"
      "plane; the friction of the skin along and across each module.\n"
      "It does not contain: the flat undersides of the modules (a straight robot may roll), the limit of the joints'\n"
      "speed, the speed-torque curve, the camera, the noise of the sensors, objects and walls.\n"
      "The control of a servo is: setpoint + (velocity gain / position gain) * rate of the setpoint [rad].\n"
      "Where the model differs from this project's physics is explained in components/lib/robot/README.md.";
  const std::string footer = help_footer(about,
                                         {"constrictor robot export --mjcf > mamba.xml",
                                          "constrictor robot export --mjcf --robot serpens --output serpens.xml"},
                                         "0 done; 64 wrong usage; 70 the file cannot be written; 78 no such robot, or "
                                         "a wrong robot file",
                                         kDataEnvironment);
  sub->footer(footer);
  robot->footer(footer);
}

}  // namespace constrictor::cli
