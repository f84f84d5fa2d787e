#include "robot/further_cameras.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <numbers>

#include "constrictor/messages.hpp"
#include "robot/camera_view.hpp"

namespace constrictor {
namespace {

constexpr std::size_t kMost = msg::kMaxCameras - 1;  // without the head's

std::string read_name(Configuration& camera, const std::vector<CameraModel>& before) {
  std::string name = camera.text("name");
  const auto accepted = [](char c) { return (c >= 'a' && c <= 'z') || (c >= '0' && c <= '9') || c == '_'; };
  if (name.empty() || name.size() > 31 || !std::all_of(name.begin(), name.end(), accepted))
    throw camera.error("name", fmt::format("found '{}', accepted 1 to 31 characters of a to z, 0 to 9 and _", name));
  if (std::any_of(before.begin(), before.end(), [&](const CameraModel& other) { return other.name == name; }))
    throw camera.error("name", fmt::format("found '{}' twice, accepted names that differ", name));
  return name;
}

CameraModel read_further_camera(Configuration camera, const RobotModel& robot, const std::vector<CameraModel>& before) {
  CameraModel model = robot.camera;  // period, latency, and the defaults of the optics
  model.name = read_name(camera, before);
  const auto last_module = static_cast<std::int64_t>(robot.module_count) - 1;
  model.module = static_cast<std::size_t>(camera.integer("module", 0, last_module, 0));
  read_camera_image(camera, true, model);
  read_camera_place(camera, robot, model);
  model.yaw_rad = camera.number("yaw_rad", {-std::numbers::pi, std::numbers::pi}, 0.0);
  read_camera_tilt(camera, model);
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
