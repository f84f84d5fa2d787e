// The undulation of the preceding study, without feedback.
#pragma once

#include <cmath>
#include <numbers>
#include <vector>

#include "sim/world/world.hpp"

namespace constrictor {

/// The heading of yaw link k is H_k = kappa X_k + A w_k cos(2 pi X_k / lambda + Phi), and joint k has the angle
/// q_k = H_k - H_{k+1}. X_k is the coordinate of the link along the path before kappa bends the body.
struct OpenLoopGait {
  double amplitude_rad = 0.5;
  double frequency_hz = 0.7;  ///< [Hz] negative: backwards
  double wavelength_m = 1.07;
  double curvature_1_m = 0.0;

  /// [rad] angles of all joints at a time since the wave began.
  [[nodiscard]] std::vector<double> angles(const RobotModel& robot, double time_s) const {
    const std::vector<std::size_t> yaw = robot.yaw_joints();
    const double link_m = 2.0 * robot.module_length_m;
    const double phase = 2.0 * std::numbers::pi * frequency_hz * time_s;
    const double ramp = std::min(1.0, time_s / 1.0);
    std::vector<double> angles(robot.joints.size(), 0.0);
    const auto wave = [&](std::size_t k, double x_m) {
      const double weight = k == 0 ? 0.0 : k == 1 ? 0.5 : k == 2 ? 0.8 : 1.0;
      return ramp * amplitude_rad * weight * std::cos(2.0 * std::numbers::pi * x_m / wavelength_m + phase);
    };
    double x_m = 0.0;
    for (std::size_t k = 0; k < yaw.size(); ++k) {
      const double ahead = wave(k, x_m);
      const double step_m = link_m * std::cos(ahead);
      x_m -= step_m;
      angles[yaw[k]] = ahead - wave(k + 1, x_m) + ramp * curvature_1_m * step_m;
    }
    return angles;
  }

  /// Commands the world for the control period that begins at `time_s`.
  void command(World& world, double time_s, double period_s) const {
    const std::vector<double> now = angles(world.robot(), time_s);
    const std::vector<double> next = angles(world.robot(), time_s + period_s);
    std::vector<double> rates(now.size());
    std::vector<double> torques(now.size());
    for (std::size_t i = 0; i < now.size(); ++i) {
      rates[i] = (next[i] - now[i]) / period_s;
      torques[i] = world.robot().joints[i].max_torque_nm;
    }
    world.set_servo(next, rates, torques);
  }

  /// Drives the world for one control period. `after_step` is called after each step of the solver.
  void drive(World& world, double time_s, double period_s, const std::function<void()>& after_step = {}) const {
    command(world, time_s, period_s);
    world.advance(period_s, after_step);
  }
};

}  // namespace constrictor
