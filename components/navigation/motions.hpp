// The motions that tasks and direct motions ask control for. Each function replaces the whole desired trajectory.
#pragma once

#include "navigation/steering.hpp"
#include "navigation/task.hpp"

namespace constrictor {

/// Stands still in the present posture.
void stand(const Grip& grip, TaskOutput& output);
/// A kind of motion (msg::DesiredTrajectory), and the speed along its path.
struct Pace {
  const char* motion = "travel";
  double speed_m_s = 0.0;  ///< positive
};
/// Moves along an arc of this curvature from the head, straight or in the U that holds an object. `direction`: +1
/// forwards, -1 backwards.
void move_along(const Pace& pace, double curvature_1_m, double direction, const Grip& grip, TaskOutput& output);
/// The same in a given posture: angles of the first `shape_count` yaw joints.
void move_in_shape(const Pace& pace, double curvature_1_m, double direction,
                   const std::array<double, msg::kMaxJoints>& shape_rad, std::size_t shape_count, TaskOutput& output);
/// Moves at the present pace along the straight lines between these points of M, and straight on after the last one.
/// Control steers to the path. At least two points, each at another place than the one before; what lies beyond
/// kMaxTrajectoryPoints, or far away, is left out.
void move_on_path(const TaskInput& input, const std::vector<Eigen::Vector2d>& points_M, const Grip& grip,
                  TaskOutput& output);
/// Bends the three yaw joints next to the head by `each_rad` each, positive left. The other joints are straight, or
/// hold the object.
void bend_head(double each_rad, double rate_rad_s, const Grip& grip, TaskOutput& output);
/// The same with three neighbouring yaw joints, of which `first` is the one next to the head (0: the foremost).
void bend_joints(std::size_t first, double each_rad, double rate_rad_s, const Grip& grip, TaskOutput& output);
/// Wraps the body round the object on `side` (+1 left, -1 right): the body moves at `speed_m_s`, and the arc slides
/// along it at `slide_m_s`.
void wrap_round(const GripSense& sense, double speed_m_s, double side, double slide_m_s, const Grip& grip,
                TaskOutput& output);
/// Closes the base of the wrapped body with a limited torque while the body drives on.
void squeeze_u(const NavigationConfig& config, const GripSense& sense, double side, const Grip& grip,
               TaskOutput& output);

/// [m/s2] horizontal acceleration at which an upright object tips over its edge, like a block on a cart: gravity times
/// its radius through half of its height. Infinite if its height is unknown.
double tipping_acceleration_m_s2(const Grip& grip);
/// Limits the waves of the motion so that the arms of the U do not knock over the object of `grip`.
void keep_upright(const NavigationConfig& config, const Grip& grip, TaskOutput& output);
/// The pace of a body with an object along a line or path.
Pace carrying_pace(const NavigationConfig& config);
/// The pace of a body with or without an object.
Pace present_pace(const NavigationConfig& config, const Grip& grip);
/// Moves at the present pace, and keeps an object in the U upright.
void move_on(const TaskInput& input, double curvature_1_m, double direction, const Grip& grip, TaskOutput& output);
/// The same where a robot with an object must not drift aside: while it searches, turns, and nears a zone.
void move_carefully(const TaskInput& input, double curvature_1_m, double direction, const Grip& grip,
                    TaskOutput& output);

/// [m] lateral error of the straight path in M through `p_M` with heading `yaw_rad`, seen from the head: the lateral
/// position of the path's point `lookahead_m` beyond the point beside the head. Positive left.
double path_error_m(const PlanarPose& X_MH, const Eigen::Vector2d& p_M, double yaw_rad, double lookahead_m);

/// [m] to the left of a line, at which the head of a body in a U drives so that its arms pass between the obstacles of
/// the map. `X_HL`: a point of the line ahead with the line's heading, in the head's frame.
double carrying_shift_m(const TaskInput& input, const PlanarPose& X_HL);

/// Whether the line of the map is the one that the goal names.
bool maps_wanted_line(const TaskInput& input);

/// [m] Lateral offset, positive left, at which the line of the map lies `lookahead_m` ahead of the head of a robot with
/// an object, with the shift by which its arms pass between obstacles; NaN if the map has no line there.
double mapped_offset_m(const TaskInput& input, double lookahead_m);

/// [1/m] curvature that leads the head of a robot with an object back to the line of the map, past its obstacles, so
/// that the camera sees the line; 0 without a line ahead. To be called every tick.
double back_to_line_1_m(const TaskInput& input, SteeringState& state);

/// [rad] heading in M that the body will have once it is straight: the mean heading of its modules.
double body_course_rad(const TaskInput& input);
/// [m] from a point in M to the middle line of the nearest module.
double nearest_module_m(const TaskInput& input, const Eigen::Vector2d& p_M);

}  // namespace constrictor
