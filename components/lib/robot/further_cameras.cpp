#include "robot/further_cameras.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "constrictor/messages.hpp"

namespace constrictor {
namespace {

constexpr std::size_t kMost = msg::kMaxCameras - 1;  // without the head's
constexpr std::int64_t kLeastWidth = 32;             // [pixel] perception refuses smaller images
constexpr std::int64_t kLeastHeight = 24;            // [pixel]
constexpr double kLeastAboveGround_m = 0.02;
constexpr double kLeastGround_rad = 0.05;  // angle below the horizon that must be in view

std::string read_name(Configuration& camera, const std::vector<CameraModel>& before) {
  std::string name = camera.text("name");
  const auto accepted = [](char c) { return (c >= 'a' && c <= 'z') || (c >= '0' && c <= '9') || c == '_'; };
  if (name.empty() || name.size() > 31 || !std::all_of(name.begin(), name.end(), accepted))
    throw camera.error("name", fmt::format("found '{}', accepted 1 to 31 characters of a to z, 0 to 9 and _", name));
  if (std::any_of(before.begin(), before.end(), [&](const CameraModel& other) { return other.name == name; }))
    throw camera.error("name", fmt::format("found '{}' twice, accepted names that differ", name));
  return name;
}

void read_place(Configuration& camera, const RobotModel& robot, CameraModel& model) {
  const std::vector<double> position = camera.numbers("position_m", {-1.0, 1.0}, 3, 3);
  model.p_HC = {position[0], position[1], position[2]};
  const double least_z_m = kLeastAboveGround_m - robot.module_radius_m;
  if (model.p_HC.z() < least_z_m) {
    throw camera.error("position_m",
                       fmt::format("found z = {:.3g} m, accepted {:.3g} m or more: the ground is {} m below the "
                                   "centre of the module",
                                   model.p_HC.z(), least_z_m, robot.module_radius_m));
  }
  // The module is a capsule about its x axis.
  const double half_m = 0.5 * robot.module_length_m;
  const Eigen::Vector3d on_axis(std::clamp(model.p_HC.x(), -half_m, half_m), 0.0, 0.0);
  const double from_axis_m = (model.p_HC - on_axis).norm();
  if (from_axis_m <= robot.module_radius_m) {
    throw camera.error("position_m",
                       fmt::format("found a place {:.3g} m from the axis of the module, accepted more than "
                                   "{} m (module.radius_m): the module hides everything else",
                                   from_axis_m, robot.module_radius_m));
  }
}

CameraModel read_further_camera(Configuration camera, const RobotModel& robot, const std::vector<CameraModel>& before) {
  CameraModel model = robot.camera;  // period, latency, and the defaults of the optics
  model.name = read_name(camera, before);
  const auto last_module = static_cast<std::int64_t>(robot.module_count) - 1;
  model.module = static_cast<std::size_t>(camera.integer("module", 0, last_module, 0));
  model.width = static_cast<int>(camera.integer("width", kLeastWidth, 4096, model.width));
  model.height = static_cast<int>(camera.integer("height", kLeastHeight, 4096, model.height));
  model.horizontal_fov_rad = camera.number("horizontal_fov_rad", {0.1, 2.8}, model.horizontal_fov_rad);
  read_place(camera, robot, model);
  model.yaw_rad = camera.number("yaw_rad", {-std::numbers::pi, std::numbers::pi}, 0.0);
  model.tilt_rad = camera.number("tilt_rad", {-1.5, 1.5});
  const double least_tilt_rad = kLeastGround_rad - std::atan(0.5 * model.height / model.focal_pixels());
  if (model.tilt_rad < least_tilt_rad) {
    throw camera.error("tilt_rad", fmt::format("found {}, accepted {:.3f} or more: no ground would be in view",
                                               model.tilt_rad, least_tilt_rad));
  }
  camera.finish();
  return model;
}

}  // namespace

std::vector<CameraModel> read_further_cameras(Configuration& root, const RobotModel& robot) {
  const std::vector<Configuration> list = root.list("further_cameras", false);
  if (list.size() > kMost) {
    throw root.error("further_cameras", fmt::format("found a list of {}, accepted at most {} beside the head's camera",
                                                    list.size(), kMost));
  }
  std::vector<CameraModel> cameras;
  for (const Configuration& camera : list) cameras.push_back(read_further_camera(camera, robot, cameras));
  return cameras;
}

}  // namespace constrictor
