#include "guidance/odometry.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

namespace constrictor::guidance {

HeadVelocity head_velocity(const BodyChain& chain, const std::vector<double>& load_n, double gyro_rad_s,
                           const HeadVelocity& guess, const OdometryConfig& config) {
  constexpr int kIterations = 8;
  Eigen::Vector3d x(guess.v_m_s.x(), guess.v_m_s.y(), gyro_rad_s);
  double total_n = 0.0;
  std::vector<double> load(chain.links.size());
  for (std::size_t i = 0; i < load.size(); ++i) {
    load[i] = i < load_n.size() && std::isfinite(load_n[i]) ? std::max(load_n[i], 0.0) : 1.0;
    total_n += load[i];
  }
  HeadVelocity result;
  result.rate_rad_s = gyro_rad_s;
  if (total_n <= 0.0) return result;  // nothing touches the ground: no constraint

  for (int iteration = 0; iteration < kIterations; ++iteration) {
    Eigen::Matrix3d A = Eigen::Matrix3d::Zero();
    Eigen::Vector3d b = Eigen::Vector3d::Zero();
    for (std::size_t i = 0; i < chain.links.size(); ++i) {
      const BodyChain::Link& link = chain.links[i];
      const auto constrain = [&](const Eigen::Vector2d& d, double friction) {
        // velocity of the module in direction d: d.v + rate (d x arm) + what its joints add
        const Eigen::Vector3d row(d.x(), d.y(), d.y() * link.p_m.x() - d.x() * link.p_m.y());
        const double own = d.dot(link.v_m_s);
        const double slip = std::abs(row.dot(x) + own);
        const double weight = friction * load[i] / total_n / std::max(slip, config.slip_scale_m_s);
        A += weight * row * row.transpose();
        b -= weight * own * row;
      };
      constrain(left(link.heading_rad), config.friction_across);
      constrain(along(link.heading_rad), config.friction_along);
    }
    // the gyro, in the units of a module that slips by lateral_sd
    const double ratio = config.lateral_sd_m_s / config.gyro_sd_rad_s;
    const double gyro_weight = config.friction_across / config.slip_scale_m_s * ratio * ratio;
    A(2, 2) += gyro_weight;
    b(2) += gyro_weight * gyro_rad_s;
    const Eigen::Vector3d next = A.ldlt().solve(b);
    if (!next.allFinite()) return result;
    const double change = (next - x).cwiseAbs().maxCoeff();
    x = next;
    if (change < 1e-5) break;
  }
  result.v_m_s = x.head<2>();
  result.rate_rad_s = x.z();
  for (std::size_t i = 0; i < chain.links.size(); ++i) {
    const BodyChain::Link& link = chain.links[i];
    const Eigen::Vector2d d = left(link.heading_rad);
    const double slip = d.dot(result.v_m_s + link.v_m_s) + x.z() * (d.y() * link.p_m.x() - d.x() * link.p_m.y());
    result.slip_m_s += load[i] / total_n * std::abs(slip);
  }
  return result;
}

}  // namespace constrictor::guidance
