// The poses of the cameras of the robot file.
#pragma once

#include <Eigen/Geometry>

#include "robot/robot_model.hpp"

namespace constrictor {

/// X_HC: pose of the camera (z along the view, x right, y down) in the module that carries it (x forward, y left, z
/// up), which is the head for the head's camera.
[[nodiscard]] Eigen::Isometry3d camera_mount(const CameraModel& camera);

}  // namespace constrictor
