// A joint of one inertia instead of a robot, for tests of the servo.
#pragma once

#include <cmath>

#include "sim/world/servo.hpp"
#include "sim/world/solver_settings.hpp"
#include "support/usual_joint.hpp"

namespace constrictor {

inline constexpr double kStep_s = 0.005;  // the production step (SolverSettings)
inline constexpr int kSteps = 4;
inline constexpr double kTick_s = kSteps * kStep_s;

/// A body that turns about one fixed axis, moved by a servo.
struct Joint {
  explicit Joint(const JointModel& model, double inertia = 0.02) : servo(model), inertia_kg_m2(inertia) {}

  void step() {
    const ServoRow row = servo.row(angle_rad, rate_rad_s);
    // The row is implicit: I (w - w0) / h = load + row.torque_nm(w). The right side falls with w, so that halving finds
    // w.
    double low = rate_rad_s - 1e4, high = rate_rad_s + 1e4;
    for (int i = 0; i < 200 && low < high; ++i) {
      const double middle = 0.5 * (low + high);
      const double excess_nm = load_nm + row.torque_nm(middle) - inertia_kg_m2 * (middle - rate_rad_s) / kStep_s;
      (excess_nm > 0.0 ? low : high) = middle;
    }
    const double after = 0.5 * (low + high);
    torque_nm = row.torque_nm(after);
    const double before = angle_rad;
    rate_rad_s = after;
    angle_rad += kStep_s * rate_rad_s;
    servo.advance(row, before, rate_rad_s);
  }
  void tick(const JointSetpoint& setpoint) {
    servo.set(setpoint);
    servo.begin_tick(kSteps, kStep_s);
    for (int i = 0; i < kSteps; ++i) step();
  }

  Servo servo;
  double inertia_kg_m2;
  double load_nm = 0.0;
  double angle_rad = 0.0;
  double rate_rad_s = 0.0;
  double torque_nm = 0.0;
};

inline JointModel model() {
  JointModel model = testing::usual_joint();
  model.max_torque_nm = 100.0;
  model.max_speed_rad_s = 50.0;
  return model;
}

inline JointModel elastic_model() {
  JointModel elastic = model();
  elastic.stiffness_nm_rad = 60.0;
  elastic.damping_nm_s_rad = 0.5;
  return elastic;
}

}  // namespace constrictor
