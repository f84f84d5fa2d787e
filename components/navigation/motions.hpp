// The motions that tasks ask control for.
#pragma once

#include "navigation/task.hpp"

namespace constrictor {

/// Stands still in the present posture.
void stand(const Grip& grip, TaskOutput& output);
/// Undulates along a path of this curvature: straight, or in the U that holds an object. `direction` +1 forwards, -1 backwards.
void undulate(const Gait& gait, double curvature_1_m, double direction, const Grip& grip, TaskOutput& output);
/// The same on a posture given by yaw joint.
void undulate_on(const Gait& gait, double curvature_1_m, double direction, const std::array<double, msg::kMaxJoints>& shape_rad,
                 std::size_t shape_count, TaskOutput& output);
/// Bends the three yaw joints next to the head, each by `each_rad` (positive left), the rest straight or the U's.
void bend_head(double each_rad, double rate_rad_s, const Grip& grip, TaskOutput& output);
/// The gait for the body's present load.
const Gait& present_gait(const NavigationConfig& config, const Grip& grip);

/// [m] lateral error of a path in M through `p_M` with heading `yaw_rad`, seen from the head: the path's lateral position at
/// `lookahead_m` along the path beyond the head's foot point; positive left.
double path_error_m(const Pose2& X_MH, const Eigen::Vector2d& p_M, double yaw_rad, double lookahead_m);

/// [s] length of a gait period, in which the head sways once.
double gait_period_s(const Gait& gait);

/// [rad] heading in M of the body once it is straight: the mean of its modules'.
double body_course_rad(const TaskInput& input);
/// [m] from a place in M to the middle line of the nearest module.
double nearest_module_m(const TaskInput& input, const Eigen::Vector2d& p_M);

/// Difference of two angles within (-pi, pi].
double angle_between(double to_rad, double from_rad);

}  // namespace constrictor
