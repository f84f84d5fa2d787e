// The gait of Liljebäck's book, as a function of time: for the planar model, which needs accelerations, and for the
// simulated robot.
#pragma once

#include <Eigen/Core>
#include <cmath>
#include <cstddef>
#include <numbers>

namespace constrictor::validation {

/// Angles of the yaw joints, head to tail, with their first and second derivative.
struct JointMotion {
  Eigen::VectorXd angle_rad;
  Eigen::VectorXd rate_rad_s;
  Eigen::VectorXd acceleration_rad_s2;
};

/// Joint k, counted from the head, has the angle a(t) sin(2 pi f t - k delta). The amplitude a(t) grows from 0 within
/// one second, with continuous second derivative, so that neither model starts with a jerk.
/// Source: Liljebäck et al., Snake Robots, Springer 2013, section 4.6 ("lateral undulation"). The book counts from the
/// tail, which changes the sign of delta.
struct LateralUndulation {
  double amplitude_rad = 0.5;
  double frequency_hz = 1.0 / 1.4;
  double phase_offset_rad = std::numbers::pi / 3.0;

  [[nodiscard]] double period_s() const { return 1.0 / frequency_hz; }

  [[nodiscard]] JointMotion at(double time_s, std::size_t joints) const {
    const double u = std::min(1.0, time_s);
    // 6 u^5 - 15 u^4 + 10 u^3 and its derivatives.
    const double a = amplitude_rad * u * u * u * (10.0 + u * (-15.0 + 6.0 * u));
    const double a1 = amplitude_rad * 30.0 * u * u * (1.0 + u * (-2.0 + u));
    const double a2 = amplitude_rad * 60.0 * u * (1.0 + u * (-3.0 + 2.0 * u));
    const double w = 2.0 * std::numbers::pi * frequency_hz;
    const auto n = static_cast<Eigen::Index>(joints);
    JointMotion motion{Eigen::VectorXd(n), Eigen::VectorXd(n), Eigen::VectorXd(n)};
    for (Eigen::Index k = 0; k < n; ++k) {
      const double phase = w * time_s - static_cast<double>(k) * phase_offset_rad;
      const double s = std::sin(phase);
      const double c = std::cos(phase);
      motion.angle_rad[k] = a * s;
      motion.rate_rad_s[k] = a1 * s + a * w * c;
      motion.acceleration_rad_s2[k] = a2 * s + 2.0 * a1 * w * c - a * w * w * s;
    }
    return motion;
  }
};

}  // namespace constrictor::validation
