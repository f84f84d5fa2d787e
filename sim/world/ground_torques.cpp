#include "sim/world/ground_torques.hpp"

#include <algorithm>
#include <cmath>

namespace constrictor {

using Eigen::Vector3d;

// A flat underside of half-width w resists rolling with a torque of at most weight times w. The torque grows linearly
// over a small angle, because a step would excite the solver. A module that is tipped further than kTipped_rad rests on
// its round side and feels no such torque.
void stand_on_bellies(const RobotModel& robot, const Scenario& scenario, Dynamics& dynamics) {
  constexpr double kSoft_rad = 0.05;
  constexpr double kTipped_rad = 0.8;
  constexpr double kDamping_s = 0.01;
  constexpr double kNear_m = 0.01;
  const double most_nm = robot.module_mass_kg * -scenario.gravity_m_s2.z() * robot.module_belly_half_width_m;
  if (most_nm <= 0.0) return;
  for (std::size_t i = 0; i < robot.module_count; ++i) {
    const BodyMotion& body = dynamics.body(i);
    const Vector3d axis = body.R_WB.col(0);
    const double roll_rad = std::atan2(body.R_WB(2, 1), body.R_WB(2, 2));
    if (std::abs(roll_rad) > kTipped_rad || body.position_m.z() > robot.module_radius_m + kNear_m) continue;
    const double rate_rad_s = body.angular_velocity_rad_s.dot(axis);
    const double share = std::clamp((roll_rad + kDamping_s * rate_rad_s) / kSoft_rad, -1.0, 1.0);
    dynamics.add_torque(i, axis * (-most_nm * share));
  }
}

// Without this torque, a cylinder that was knocked over would roll on for ever. The torque of an object that rolls
// slowly is proportional to its rate. One step removes at most half of the rate, so that the object cannot oscillate.
void resist_rolling(const Scenario& scenario, std::size_t module_count, double step_s, Dynamics& dynamics) {
  constexpr double kSoft_rad_s = 0.05;
  constexpr double kMostOfRate = 0.5;
  for (std::size_t i = 0; i < scenario.objects.size(); ++i) {
    const ScenarioObject& object = scenario.objects[i];
    const Vector3d& rate = dynamics.body(module_count + i).angular_velocity_rad_s;
    const double rolling_rad_s = std::hypot(rate.x(), rate.y());
    if (rolling_rad_s < 1e-9) continue;
    const double lever_m = object.shape == BodyShape::kCylinder ? object.size_m.x() : 0.5 * object.size_m.minCoeff();
    const double weight_n = object.mass_kg * -scenario.gravity_m_s2.z();
    const double most_nm = kRollingResistance * weight_n * lever_m * std::min(1.0, rolling_rad_s / kSoft_rad_s);
    const double inertia_kg_m2 = 0.4 * object.mass_kg * lever_m * lever_m;  // at least
    const double torque_nm = std::min(most_nm, kMostOfRate * inertia_kg_m2 * rolling_rad_s / step_s);
    dynamics.add_torque(module_count + i,
                        {-torque_nm * rate.x() / rolling_rad_s, -torque_nm * rate.y() / rolling_rad_s, 0.0});
  }
}

}  // namespace constrictor
