// Which objects the body can grasp, by their sizes.
#pragma once

#include "component/object_bounds.hpp"
#include "navigation/grip.hpp"

namespace constrictor {

/// Whether the U of this robot can take and hold an object that stands upright: a cylinder that fits into the U; a box
/// whose diagonal is not much larger, because the robot sees it from all sides; one that does not tip over when the
/// body meets it.
[[nodiscard]] CheckVerdict judge_object(const GripSense& sense, const RobotModel& robot, const DemandedObject& object);

}  // namespace constrictor
