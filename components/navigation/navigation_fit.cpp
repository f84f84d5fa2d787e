#include "navigation/navigation_fit.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

#include "navigation/grip.hpp"
#include "robot/u_arms.hpp"

namespace constrictor {
namespace {

// The base of a body that is longer by a third holds an object with this share of a joint's torque: with less (2.7 Nm,
// as the weight of an arm times its length demands) the U of 32 modules opened while it turned, and lost the object.
constexpr double kFirmHold = 2.0 / 3.0;
constexpr double kFirmFrom = 4.0 / 3.0;

bool carries_on_ground(const RobotModel& robot, const GripConfig& config) {
  const int first = first_base_joint(robot, config);
  const std::vector<std::size_t> yaw_joints = robot.yaw_joints();
  const auto last = static_cast<std::size_t>(first + config.base_joints - 1);
  if (last >= yaw_joints.size()) return false;  // GripSense refuses this base
  return !base_hinges(robot, yaw_joints[static_cast<std::size_t>(first)], yaw_joints[last]);
}

}  // namespace

NavigationConfig navigation_fitted_to(const RobotModel& robot, NavigationConfig config) {
  const double length = length_share(robot);
  const double longer = std::max(1.0, length);
  const double shorter = std::min(1.0, length);

  // A turn on the spot bends the whole body. By the same angle a longer body does not close to a ring, and the friction
  // of the ground, which its joints must overcome, grows less.
  for (double* curvature_1_m :
       {&config.rotate.curvature_1_m, &config.search.turn_curvature_1_m, &config.track.turn_curvature_1_m})
    *curvature_1_m /= longer;
  config.track.turn_radius_m *= longer;

  // With an object the two arms of the U bend. Shorter arms need a larger curvature for the same angle.
  for (double* curvature_1_m :
       {&config.rotate.carry_curvature_1_m, &config.follow_line.carry_limit_1_m, &config.drop.steering.limit})
    *curvature_1_m /= shorter;

  // The friction of the ground on longer arms opens the base.
  double firm_nm = config.grip.hold_torque_nm;
  for (const JointModel& joint : robot.joints) firm_nm = std::max(firm_nm, kFirmHold * joint.max_torque_nm);
  const double share = std::min(1.0, (longer - 1.0) / (kFirmFrom - 1.0));
  config.grip.hold_torque_nm += share * (firm_nm - config.grip.hold_torque_nm);

  // A longer U follows its head later: it looks farther ahead and steers more gently, and its arms leave the object
  // only after a longer way.
  config.drop.steering.kp /= longer;
  config.drop.steering.ki /= longer;
  config.drop.lookahead_m *= longer;
  config.drop.pivot_m *= longer;
  config.drop.back_m *= longer;
  // It needs more time to straighten and more room, or its turns reach the object.
  config.drop.straighten_rate_rad_s /= longer * longer;
  config.drop.clear_m *= longer * longer;

  // With shorter links, of which a body without pitch joints has two in place of one, the base of the same length has
  // more joints, and each of them bends less.
  constexpr int kMostBaseJoints = 8;
  const int base_joints = config.grip.base_joints;
  config.grip.base_joints =
      std::clamp(static_cast<int>(std::lround(base_joints / link_share(robot))), base_joints, kMostBaseJoints);
  const double bend = static_cast<double>(base_joints) / config.grip.base_joints;
  for (double* angle_rad : {&config.grip.base_angle_rad, &config.grip.widest_angle_rad, &config.grip.closing_rad,
                            &config.drop.open_angle_rad})
    *angle_rad *= bend;

  config.carries_on_ground = carries_on_ground(robot, config.grip);
  return config;
}

}  // namespace constrictor
