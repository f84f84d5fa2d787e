#include "sim/world/dynamics.hpp"

#include <fmt/format.h>

#include <stdexcept>

#include "sim/world/chain_dynamics.hpp"
#include "sim/world/ode_dynamics.hpp"

namespace constrictor {

Eigen::Isometry3d BodyMotion::pose() const {
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  pose.linear() = R_WB;
  pose.translation() = position_m;
  return pose;
}

Eigen::Vector3d BodyMotion::velocity_at(const Eigen::Vector3d& p_W) const {
  return velocity_m_s + angular_velocity_rad_s.cross(p_W - position_m);
}

Dynamics::Dynamics(const Mechanism& mechanism, const SolverSettings& settings)
    : settings_(settings),
      bodies_(mechanism.modules.size() + mechanism.objects.size()),
      angles_rad_(mechanism.joints.size(), 0.0),
      rates_rad_s_(mechanism.joints.size(), 0.0),
      torques_nm_(mechanism.joints.size(), 0.0),
      external_(bodies_.size()),
      module_count_(mechanism.modules.size()) {}

void Dynamics::check_size(std::size_t found, std::size_t accepted) {
  if (found != accepted)
    throw std::runtime_error(
        fmt::format("checkpoint of the world: found {} numbers for its bodies, accepted {}", found, accepted));
}

std::unique_ptr<Dynamics> make_dynamics(const Mechanism& mechanism, const SolverSettings& settings) {
  if (settings.engine == kEngineChain) return std::make_unique<ChainDynamics>(mechanism, settings);
  if (settings.engine == kEngineOde) return std::make_unique<OdeDynamics>(mechanism, settings);
  throw std::invalid_argument(
      fmt::format("engine of the physics: found \"{}\", accepted {} or {}", settings.engine, kEngineOde, kEngineChain));
}

}  // namespace constrictor
