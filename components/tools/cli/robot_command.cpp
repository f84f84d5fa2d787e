// `constrictor robot export`: the robot as a description for other programs.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <memory>
#include <stdexcept>

#include "cli/launch_plan.hpp"
#include "cli/standard_output.hpp"
#include "cli/subcommands.hpp"
#include "cli/usage.hpp"
#include "configuration/whole_file.hpp"
#include "robot/description.hpp"
#include "robot/module_mesh.hpp"
#include "robot/mujoco_model.hpp"
#include "robot/robot_model.hpp"
#include "runtime/host.hpp"

namespace constrictor::cli {
namespace {

struct RobotOptions {
  bool mjcf = false, urdf = false, sdf = false;
  std::string robot = "mamba";
  std::filesystem::path output;  ///< empty: standard output
  std::filesystem::path meshes;  ///< folder; empty: no mesh
  std::string mesh_uri;          ///< of that folder, for the reader of the description; empty: file://FOLDER
};

/// Whether the file is a mesh that the user has put there, which must not be overwritten.
bool is_foreign_mesh(const std::filesystem::path& file) {
  std::ifstream stream(file, std::ios::binary);
  std::string begin(kStlBegin.size(), '\0');
  stream.read(begin.data(), static_cast<std::streamsize>(begin.size()));
  return stream.gcount() > 0 && begin != kStlBegin;
}

/// Returns the URI of the mesh; empty: none was asked for.
std::string write_mesh(const RobotOptions& options, const RobotModel& robot) {
  if (options.meshes.empty()) return {};
  std::filesystem::create_directories(options.meshes);
  const auto file = options.meshes / "module.stl";
  if (is_foreign_mesh(file))
    fmt::print(stderr, "robot export: {} is kept, because it is a mesh of your own\n", file.string());
  else write_whole(file, stl_file(module_mesh(robot)));
  const std::string folder =
      options.mesh_uri.empty() ? "file://" + std::filesystem::canonical(options.meshes).string() : options.mesh_uri;
  return folder + (folder.ends_with('/') ? "" : "/") + "module.stl";
}

int export_robot(const RobotOptions& options) {
  const RobotModel robot = load_robot(find_file(options.robot, kRobots));
  const std::string mesh = write_mesh(options, robot);
  const std::string text = options.mjcf   ? mujoco_model(robot)
                           : options.urdf ? urdf_model(robot, mesh)
                                          : sdf_model(robot, mesh);
  if (options.output.empty()) {
    write_standard_output(text);
    return exit_status::kOk;
  }
  errno = 0;
  std::ofstream file(options.output);
  file << text << std::flush;  // a full disk is noticed here, and not in the destructor, which reports nothing
  if (file) return exit_status::kOk;
  throw std::runtime_error(fmt::format("robot export: cannot write {}: {}", options.output.string(),
                                       errno != 0 ? ::strerrordesc_np(errno) : "unknown error"));
}

}  // namespace

void add_robot(CLI::App& app, Action& action) {
  auto options = std::make_shared<RobotOptions>();
  auto* robot = add_group(app, "robot", "write the robot as a description for other programs");
  auto* sub = add_subcommand(*robot, "export", "write the robot as a description for other programs", action, options,
                             export_robot);
  auto* format = sub->add_option_group("format");
  format->add_flag("--mjcf", options->mjcf, "XML file for the simulator MuJoCo (tested with version 2.2.2)");
  format->add_flag("--urdf", options->urdf, "URDF file for ROS: RViz, robot_state_publisher, MoveIt");
  format->add_flag("--sdf", options->sdf, "SDF 1.9 file for the simulator Gazebo");
  format->require_option(1);
  sub->add_option("--robot", options->robot, "robot: a name (see `constrictor list robots`) or a file")
      ->capture_default_str();
  sub->add_option("--output", options->output,
                  "file to write; an existing file is replaced (default: standard output)");
  auto* meshes = sub->add_option("--meshes", options->meshes,
                                 "folder for a mesh of the module, module.stl, which the URDF or SDF file then shows;\n"
                                 "it is made if it does not exist. A mesh of your own of this name is kept")
                     ->excludes("--mjcf");
  sub->add_option(
         "--mesh-uri", options->mesh_uri,
         "the folder of --meshes as the reader of the description finds it, such as package://my_robot/meshes\n"
         "(default: file:// and its absolute path)")
      ->needs(meshes);
  const std::string about =
      "All formats contain: the modules as capsules with mass and inertia; the joints with axes, ranges, limit of the\n"
      "torque and gear friction. The angles have the signs of this project.\n"
      "MJCF also: rotor inertia; servos with both gains; series-elastic elements; a ground plane; the friction of the\n"
      "skin along and across each module. The control of a servo is: setpoint + (velocity gain / position gain) * "
      "rate\n"
      "of the setpoint [rad].\n"
      "URDF and SDF also: the limit of the joints' speed; the frame of the camera. The frames are those that "
      "ros_bridge\n"
      "publishes. SDF also: the camera as a sensor, and the friction of the skin.\n"
      "None contains: the flat undersides of the modules (a straight robot may roll), the speed-torque curve, "
      "backlash,\n"
      "the noise of the sensors, objects and walls. Capsules are exact, so that a mesh is needed only by\n"
      "programs that draw no capsules, or as the place of a mesh of your own.\n"
      "Where the models differ from this project's physics is explained in components/lib/robot/README.md.";
  const std::string footer =
      help_footer(about,
                  {"constrictor robot export --mjcf > mamba.xml", "constrictor robot export --urdf > mamba.urdf",
                   "constrictor robot export --sdf --output mamba.sdf",
                   "constrictor robot export --urdf --meshes meshes --output mamba.urdf",
                   "constrictor robot export --mjcf --robot serpens --output serpens.xml"},
                  "0 done; 64 wrong usage; 70 the file cannot be written; 78 no such robot, or "
                  "a wrong robot file",
                  kDataEnvironment);
  sub->footer(footer);
  robot->footer(footer);
}

}  // namespace constrictor::cli
