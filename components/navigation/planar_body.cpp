#include "navigation/planar_body.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>

#include "robot/kinematics.hpp"
#include "robot/landmarks.hpp"

namespace constrictor {

std::vector<PlanarPose> planar_body(const RobotModel& robot, const msg::JointState& joints) {
  std::vector<PlanarPose> body;
  body.reserve(robot.module_count);
  for (const PlanarPose& pose : planar_module_poses(robot, {joints.position_rad, robot.joints.size()})) {
    body.push_back({pose.p, pose.yaw_rad});
  }
  return body;
}

std::vector<Touch> lateral_touches(const RobotModel& robot, const std::vector<PlanarPose>& body,
                                   const msg::ContactState& contacts, double min_force_n) {
  constexpr double kSteepest = 0.7;  // vertical component of the steepest lateral normal
  constexpr double kSelfTolerance_m = 0.015;
  const double half_m = 0.5 * robot.module_length_m;
  std::vector<Touch> touches;
  for (std::size_t c = 0; c < contacts.contact_count; ++c) {
    const msg::Contact& contact = contacts.contacts[c];
    if (contact.module_index >= body.size() || std::abs(contact.normal.z) > kSteepest) continue;
    const double force_n = std::hypot(contact.force_n.x, contact.force_n.y);
    if (force_n < min_force_n) continue;
    const PlanarPose& module = body[contact.module_index];
    Touch touch;
    touch.module = contact.module_index;
    touch.p_H = module.to_parent({contact.position_m.x, contact.position_m.y});
    touch.normal_H = (contact.normal.x * module.forward() + contact.normal.y * module.left()).normalized();
    touch.force_n = force_n;
    bool own = false;
    for (std::size_t m = 0; m < body.size() && !own; ++m) {
      if (m + 2 >= touch.module && m <= touch.module + 2) continue;
      Eigen::Vector2d local = body[m].to_local(touch.p_H);
      local.x() -= std::clamp(local.x(), -half_m, half_m);
      own = local.norm() < robot.module_radius_m + kSelfTolerance_m;
    }
    if (!own) touches.push_back(touch);
  }
  return touches;
}

void assign_touches(const msg::FieldMap& map, const PlanarPose& X_MH, double usual_radius_m,
                    std::vector<Touch>& touches) {
  for (Touch& touch : touches) {
    const Eigen::Vector2d p_M = X_MH.to_parent(touch.p_H);
    const msg::MapObject* object = touched_object(map, p_M.x(), p_M.y(), usual_radius_m);
    touch.handle = object ? object->handle : std::uint16_t{0};
  }
}

std::vector<Touch> touches_of(std::uint16_t handle, const std::vector<Touch>& touches) {
  std::vector<Touch> own;
  std::copy_if(touches.begin(), touches.end(), std::back_inserter(own),
               [&](const Touch& touch) { return handle == 0 || touch.handle == 0 || touch.handle == handle; });
  return own;
}

}  // namespace constrictor
