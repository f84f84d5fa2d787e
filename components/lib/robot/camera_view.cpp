#include "robot/camera_view.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <optional>
#include <vector>

namespace constrictor {
namespace {

constexpr double kLeastAboveGround_m = 0.02;
constexpr double kLeastGround_rad = 0.05;  // angle below the horizon that must be in view
constexpr std::int64_t kLeastWidth = 32;   // [pixel] perception refuses smaller images
constexpr std::int64_t kLeastHeight = 24;  // [pixel]
constexpr std::int64_t kMostPixels = 4096;

}  // namespace

void read_camera_image(Configuration& camera, bool inherits, CameraModel& model) {
  const auto pixels = [&](const char* key, std::int64_t least, int& value) {
    const std::optional<std::int64_t> fallback = inherits ? std::optional<std::int64_t>(value) : std::nullopt;
    value = static_cast<int>(camera.integer(key, least, kMostPixels, fallback));
  };
  pixels("width", kLeastWidth, model.width);
  pixels("height", kLeastHeight, model.height);
  const std::optional<double> fov_rad = inherits ? std::optional(model.horizontal_fov_rad) : std::nullopt;
  model.horizontal_fov_rad = camera.number("horizontal_fov_rad", {0.1, 2.8}, fov_rad);
}

void read_camera_place(Configuration& camera, const RobotModel& robot, CameraModel& model) {
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

void read_camera_tilt(Configuration& camera, CameraModel& model) {
  model.tilt_rad = camera.number("tilt_rad", {-1.5, 1.5});
  const double least_tilt_rad = kLeastGround_rad - std::atan(0.5 * model.height / model.focal_pixels());
  if (model.tilt_rad < least_tilt_rad) {
    throw camera.error("tilt_rad", fmt::format("found {}, accepted {:.3f} or more: no ground would be in view",
                                               model.tilt_rad, least_tilt_rad));
  }
}

}  // namespace constrictor
