#include "control/body_fit.hpp"

#include <cmath>
#include <cstddef>
#include <vector>

#include "robot/u_arms.hpp"

namespace constrictor {

ControlConfig fitted_to(const RobotModel& robot, ControlConfig config) {
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
