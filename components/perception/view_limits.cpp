#include "perception/view_limits.hpp"

#include <fmt/format.h>

#include <cmath>

namespace constrictor::perception {

CheckVerdict judge_view(const RobotModel& robot) {
  const CameraModel& camera = robot.camera;
  const double most_rad = std::atan(0.5 * camera.height / camera.focal_pixels());  // half of the vertical field of view
  if (camera.tilt_rad < most_rad) return {};
  return {
      {},
      {fmt::format("the robot {}: camera.tilt_rad: found {}, accepted less than {:.3f} with this field of view: the "
                   "horizon lies above the image, and objects that are higher than the camera are not recognised",
                   robot.name, camera.tilt_rad, most_rad)}};
}

}  // namespace constrictor::perception
