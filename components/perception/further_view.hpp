// Where a further camera looks: the frame V of its view.
#pragma once

#include <span>

#include "perception/ground_camera.hpp"
#include "robot/planar.hpp"
#include "robot/robot_model.hpp"

namespace constrictor::perception {

struct FurtherView {
  PlanarPose X_GV;  ///< V: origin on the ground below the camera, x along the direction in which it looks
  GroundCamera camera;
};

/// The view of a further camera at its exposure. `attitude`: of the head relative to the ground; its yaw is ignored.
/// `angles_rad`: of the joints, which relate the module that carries the camera to the head. The head's centre is one
/// module radius above the ground. A module that the robot does not have counts as its last one.
[[nodiscard]] FurtherView further_view(const msg::CameraInfo& info, const RobotModel& robot,
                                       const msg::Quaternion& attitude, std::span<const double> angles_rad);

}  // namespace constrictor::perception
