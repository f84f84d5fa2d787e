// The further cameras of a robot file.
#pragma once

#include <vector>

#include "configuration/configuration.hpp"
#include "robot/robot_model.hpp"

namespace constrictor {

/// Reads and checks the list `further_cameras` of a robot file whose modules and camera have been read into `robot`.
/// What is left out is as in the head's camera; period and latency always are. Refuses cameras that could not be of any
/// use: inside their module, below the ground, or looking so far upwards that no ground is in view. Throws
/// ConfigurationError.
[[nodiscard]] std::vector<CameraModel> read_further_cameras(Configuration& root, const RobotModel& robot);

}  // namespace constrictor
