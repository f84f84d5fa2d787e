// The motions that tasks and direct motions ask control for. Each function replaces the whole desired trajectory.
#pragma once

#include "navigation/task.hpp"

namespace constrictor {

/// Stands still in the present posture.
void stand(const Grip& grip, TaskOutput& output);
/// Undulates along a path of this curvature, straight or in the U that holds an object. `direction`: +1 forwards, -1
/// backwards.
void undulate(const Gait& gait, double curvature_1_m, double direction, const Grip& grip, TaskOutput& output);
/// The same in a given posture: angles of the first `shape_count` yaw joints.
void undulate_on(const Gait& gait, double curvature_1_m, double direction,
                 const std::array<double, msg::kMaxJoints>& shape_rad, std::size_t shape_count, TaskOutput& output);
/// Bends the three yaw joints next to the head by `each_rad` each, positive left. The other joints are straight, or
/// hold the object.
void bend_head(double each_rad, double rate_rad_s, const Grip& grip, TaskOutput& output);
/// The same with three neighbouring yaw joints, of which `first` is the one next to the head (0: the foremost).
void bend_joints(std::size_t first, double each_rad, double rate_rad_s, const Grip& grip, TaskOutput& output);
/// Wraps the body round the object on `side` (+1 left, -1 right): the arc slides along the body at `speed_m_s`.
void wrap_round(const GripSense& sense, const Gait& gait, double side, double speed_m_s, const Grip& grip,
                TaskOutput& output);
/// Closes the base of the wrapped body with a limited torque while the body drives on.
void squeeze_u(const NavigationConfig& config, const GripSense& sense, double side, const Grip& grip,
               TaskOutput& output);

/// [m/s2] horizontal acceleration at which an upright object tips over its edge, like a block on a cart: gravity times
/// its radius through half of its height. Infinite if its height is unknown.
double tipping_acceleration_m_s2(const Grip& grip);
/// [m/s2] largest lateral acceleration of a body that undulates with this gait: the body moves sideways by
/// amplitude x wavelength / 2 pi.
double lateral_acceleration_m_s2(const Gait& gait);
/// The gait with an amplitude, and if necessary a frequency, at which the arms of the U do not knock the object over.
Gait gentle(const Gait& gait, const NavigationConfig& config, const Grip& grip);
/// The gait for a body with or without an object.
Gait present_gait(const NavigationConfig& config, const Grip& grip);

/// [m] lateral error of the straight path in M through `p_M` with heading `yaw_rad`, seen from the head: the lateral
/// position of the path's point `lookahead_m` beyond the point beside the head. Positive left.
double path_error_m(const PlanarPose& X_MH, const Eigen::Vector2d& p_M, double yaw_rad, double lookahead_m);

/// [s] one period of the gait, in which the head sways once.
double gait_period_s(const Gait& gait);

/// [rad] heading in M that the body will have once it is straight: the mean heading of its modules.
double body_course_rad(const TaskInput& input);
/// [m] from a point in M to the middle line of the nearest module.
double nearest_module_m(const TaskInput& input, const Eigen::Vector2d& p_M);

/// Difference of two angles, from -pi to pi.
double angle_between(double to_rad, double from_rad);

}  // namespace constrictor
