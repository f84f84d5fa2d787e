// Checks of a camera that hold for that of the head and for further ones.
#pragma once

#include "configuration/configuration.hpp"
#include "robot/robot_model.hpp"

namespace constrictor {

/// Reads the keys `width`, `height` and `horizontal_fov_rad` of a camera. `inherits`: a missing key leaves what `model`
/// has; otherwise each is required. Throws ConfigurationError.
void read_camera_image(Configuration& camera, bool inherits, CameraModel& model);

/// Reads the key `position_m` of a camera. Refuses a place below the ground, and one inside the module, which would
/// hide everything else. The modules have been read into `robot`. Throws ConfigurationError.
void read_camera_place(Configuration& camera, const RobotModel& robot, CameraModel& model);

/// Reads the key `tilt_rad` of a camera whose image size and field of view have been read. Refuses one that looks so
/// far upwards that no ground is in view. Throws ConfigurationError.
void read_camera_tilt(Configuration& camera, CameraModel& model);

}  // namespace constrictor
