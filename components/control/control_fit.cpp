#include "control/control_fit.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

#include "robot/u_arms.hpp"

namespace constrictor {
namespace {

// Missions of 32 modules that succeeded with the amplitudes 0.45, 0.55, 0.65 and 0.8 rad: 12 of 16, 23 of 24, 4 of 8
// and 22 of 26. This power leads to 0.55 rad.
constexpr double kAmplitudePower = 1.3;

}  // namespace

ControlConfig control_fitted_to(const RobotModel& robot, ControlConfig config) {
  // The thrust of longer arms would drive the base, whose friction is the same, at twice the speed: faster than the
  // curvature of the body can follow, so that the robot swings about its course over a zone.
  config.deliver.amplitude_rad /= std::pow(std::max(1.0, length_share(robot)), kAmplitudePower);

  // A robot that does not feel which links bear its weight loses its pose with a raised base: 14 of 20 missions
  // succeeded, and 18 of the same 20 with the base on the ground, in the same time.
  if (!robot.contact_sensors) config.lift_rad = 0.0;

  const double share = link_share(robot);
  if (share == 1.0) return config;
  config.weights.rigid_bend_rad *= share;
  config.base_bend_rad *= share;
  // The weights at the same distances from the head; behind the last one they are 1.
  const std::vector<double> tuned = config.weights.head;
  const auto weight = [&](std::size_t k) { return k < tuned.size() ? tuned[k] : 1.0; };
  config.weights.head.clear();
  for (std::size_t k = 0; static_cast<double>(k) * share < static_cast<double>(tuned.size()); ++k) {
    const double at = static_cast<double>(k) * share, whole = std::floor(at);
    const auto i = static_cast<std::size_t>(whole);
    config.weights.head.push_back(weight(i) + (at - whole) * (weight(i + 1) - weight(i)));
  }
  return config;
}

}  // namespace constrictor
