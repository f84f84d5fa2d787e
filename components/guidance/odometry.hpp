// How fast the head moves, from how the body deforms on a skin that slides along but not across.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "guidance/body_chain.hpp"

namespace constrictor::guidance {

struct OdometryConfig {
  double friction_along = 0.05;
  double friction_across = 0.5;
  double slip_scale_m_s = 0.03;   ///< sliding speed from which friction counts as fully developed
  double gyro_sd_rad_s = 0.01;    ///< how far the measured yaw rate is trusted
  double lateral_sd_m_s = 0.05;   ///< typical lateral slip of a module, sets the gyro's weight
};

/// Velocity of the head in its own frame.
struct HeadVelocity {
  Eigen::Vector2d v_m_s{0.0, 0.0};
  double rate_rad_s = 0.0;
  double slip_m_s = 0.0;  ///< weighted mean of the lateral slip that remains: how well the body fits its track
};

/// Least dissipation: a body that is slow against its friction moves such that the power lost to Coulomb friction,
/// sum of N_i (mu_across |v_across| + mu_along |v_along|), is smallest for the given shape change. That is a robust
/// regression on the no-lateral-slip constraint of all modules, solved by iteratively reweighted least squares; with little slip
/// it is the constraint's weighted least-squares solution. `load_n`: normal force on each module (0: it does not touch the
/// ground). `guess`: the solution of the previous tick. Non-finite loads count as 1.
HeadVelocity head_velocity(const BodyChain& chain, const std::vector<double>& load_n, double gyro_rad_s,
                           const HeadVelocity& guess, const OdometryConfig& config);

}  // namespace constrictor::guidance
