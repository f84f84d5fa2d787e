#include "guidance/body_chain.hpp"

#include <cmath>
#include <numbers>

namespace constrictor::guidance {

Eigen::Vector2d along(double heading_rad) { return {std::cos(heading_rad), std::sin(heading_rad)}; }
Eigen::Vector2d left(double heading_rad) { return {-std::sin(heading_rad), std::cos(heading_rad)}; }

Eigen::Vector2d turned(const Eigen::Vector2d& p, double angle_rad) {
  const double c = std::cos(angle_rad), s = std::sin(angle_rad);
  return {c * p.x() - s * p.y(), s * p.x() + c * p.y()};
}

double wrapped(double angle_rad) {
  const double turn = 2.0 * std::numbers::pi;
  const double rest = std::fmod(angle_rad + std::numbers::pi, turn);
  return (rest <= 0.0 ? rest + turn : rest) - std::numbers::pi;
}

BodyChain body_chain(const RobotModel& model, const double* position_rad, const double* velocity_rad_s) {
  BodyChain chain;
  chain.links.resize(model.module_count);
  const double half_m = 0.5 * model.module_length_m;
  for (std::size_t i = 0; i + 1 < model.module_count; ++i) {
    const BodyChain::Link& a = chain.links[i];
    BodyChain::Link& b = chain.links[i + 1];
    const bool yaw = model.joints[i].axis == JointAxis::kYaw;
    b.heading_rad = a.heading_rad - (yaw ? position_rad[i] : 0.0);
    b.rate_rad_s = a.rate_rad_s - (yaw ? velocity_rad_s[i] : 0.0);
    // from centre to joint and on to the next centre
    b.p_m = a.p_m - half_m * (along(a.heading_rad) + along(b.heading_rad));
    b.v_m_s = a.v_m_s - half_m * (a.rate_rad_s * left(a.heading_rad) + b.rate_rad_s * left(b.heading_rad));
  }
  return chain;
}

}  // namespace constrictor::guidance
