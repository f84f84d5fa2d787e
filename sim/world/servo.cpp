#include "sim/world/servo.hpp"

#include <algorithm>
#include <cmath>

namespace constrictor {

namespace {

/// Below this rate the friction of a gear falls with the rate, so that a joint creeps instead of sticking.
constexpr double kCreep_rad_s = 0.005;
/// A torque is a row only with some inertia: so little that it does not show.
constexpr double kLeastInertia_kg_m2 = 1e-9;

}  // namespace

double ServoRow::torque_nm(double rate_rad_s) const {
  return std::clamp((velocity_rad_s - rate_rad_s) / softness, -torque_limit_nm, torque_limit_nm) +
         inertia_nm_s_rad * (free_velocity_rad_s - rate_rad_s);
}

double ServoRow::slope_nm_s_rad(double rate_rad_s) const {
  const bool limited = std::abs(velocity_rad_s - rate_rad_s) >= torque_limit_nm * softness;
  return limited ? inertia_nm_s_rad : inertia_nm_s_rad + 1.0 / softness;
}

double ServoRow::torque_free_rate_rad_s() const {
  if (inertia_nm_s_rad == 0.0) return velocity_rad_s;
  const double rate =
      (inertia_nm_s_rad * free_velocity_rad_s + velocity_rad_s / softness) / (inertia_nm_s_rad + 1.0 / softness);
  const double wanted_nm = (velocity_rad_s - rate) / softness;
  if (std::abs(wanted_nm) <= torque_limit_nm) return rate;
  return free_velocity_rad_s + std::copysign(torque_limit_nm, wanted_nm) / inertia_nm_s_rad;
}

void Servo::set(const JointSetpoint& setpoint) { to_ = clamp_to_limits(model_, setpoint); }

void Servo::begin_tick(int steps, double step_s) {
  step_ = 0;
  steps_ = steps;
  step_s_ = step_s;
}

double Servo::torque_limit_nm(double rate_rad_s, double driving) const {
  double limit = to_.torque_limit_nm;
  const double speed = std::abs(rate_rad_s);
  // A motor that drives loses torque with speed; a motor that brakes does not.
  if (driving * rate_rad_s > 0.0 && model_.no_load_speed_rad_s > 0.0)
    limit = std::min(limit, model_.max_torque_nm * std::max(0.0, 1.0 - speed / model_.no_load_speed_rad_s));
  return limit;
}

double Servo::stretch_rad(double angle_rad) const {
  const double apart_rad = motor_angle_rad_ - angle_rad;
  if (play_rad_ == 0.0) return apart_rad;
  const double beyond_rad = apart_rad - play_rad_;
  return beyond_rad * play_rad_ > 0.0 ? beyond_rad : 0.0;
}

double Servo::spring_damping_nm_s_rad() const {
  return std::max(model_.damping_nm_s_rad, step_s_ * model_.stiffness_nm_rad);
}

ServoRow Servo::row(double angle_rad, double rate_rad_s) {
  const double h = step_s_;
  const double duration = h * steps_;
  // After torque mode the curve begins where the joint is, with its rate.
  if (++step_ == 1 && from_.torque_mode && !to_.torque_mode)
    from_ = clamp_to_limits(model_, {angle_rad, rate_rad_s, 0.0});
  // Cubic Hermite curve from from_ to to_.
  const double d = to_.position_rad - from_.position_rad;
  const double a = from_.velocity_rad_s * duration;
  const double b = to_.velocity_rad_s * duration;
  const auto curve = [&](double u) {
    return from_.position_rad + u * (a + u * (3.0 * d - 2.0 * a - b + u * (a + b - 2.0 * d)));
  };
  const double u = static_cast<double>(step_) / steps_;
  const double begin_rad = curve(static_cast<double>(step_ - 1) / steps_);
  reference_rad_ = curve(u);
  reference_rate_rad_s_ = (a + u * (2.0 * (3.0 * d - 2.0 * a - b) + u * 3.0 * (a + b - 2.0 * d))) / duration;
  if (step_ == steps_) from_ = to_;

  if (to_.torque_limit_nm <= 0.0) return relaxed_row(angle_rad, rate_rad_s);
  if (to_.torque_mode) {
    reference_rad_ = angle_rad;
    return torque_row(angle_rad, rate_rad_s);
  }
  return position_row(begin_rad, reference_rate_rad_s_, angle_rad, rate_rad_s);
}

double Servo::friction_nm_s_rad(double rate_rad_s) const {
  return model_.gear_friction_nm / std::max(std::abs(rate_rad_s), kCreep_rad_s);
}

ServoRow Servo::friction_row() const {
  ServoRow row;
  if (model_.gear_friction_nm > 0.0) {
    row.softness = kCreep_rad_s / model_.gear_friction_nm;
    row.torque_limit_nm = model_.gear_friction_nm;
  }
  return row;
}

ServoRow Servo::relaxed_row(double angle_rad, double rate_rad_s) {
  const double rate = elastic() ? motor_rate_rad_s_ : rate_rad_s;
  ServoRow motor = friction_row();
  motor.free_velocity_rad_s = rate;
  motor.inertia_nm_s_rad = model_.rotor_inertia_kg_m2 / step_s_;
  return attached(motor, angle_rad, rate_rad_s);
}

ServoRow Servo::position_row(double reference_rad, double reference_rate_rad_s, double angle_rad, double rate_rad_s) {
  const double h = step_s_;
  const double kp = model_.position_gain_nm_rad;
  const double kd = model_.velocity_gain_nm_s_rad;
  const double inertia = model_.rotor_inertia_kg_m2 / h;
  const double angle = model_.measured_rad(elastic() ? motor_angle_rad_ : angle_rad);
  const double rate = elastic() ? motor_rate_rad_s_ : rate_rad_s;
  // The spring kp pulls from the angle at the beginning of the step. That is stable if the damping is at least
  // h kp / 2, and the damping of usual servos is far larger. From the angle at the end of the step, the spring would
  // add a damping of h kp, which no servo has.
  const double sum = inertia + std::max(kd, 0.5 * h * kp) + friction_nm_s_rad(rate);
  const double wanted_rate = std::clamp(reference_rate_rad_s, -model_.max_speed_rad_s, model_.max_speed_rad_s);
  ServoRow motor;
  motor.softness = 1.0 / sum;
  motor.velocity_rad_s = (inertia * rate + kp * (reference_rad - angle) + kd * wanted_rate) / sum;
  motor.torque_limit_nm = torque_limit_nm(rate, motor.velocity_rad_s - rate);
  return attached(motor, angle_rad, rate_rad_s);
}

// With the motor's rate m and the joint's rate w at the end of the step, the torque of the spring is s + d (m - w),
// with s = k e at its beginning. The torque t of the motor's row is equal to it, which gives m and t by w: again a sum
// of a limited and of an unlimited part, since t has one slope while the motor is at its limit and one while it is not.
ServoRow Servo::attached(const ServoRow& motor, double angle_rad, double rate_rad_s) {
  if (!elastic()) return motor;
  const double h = step_s_;
  loose_motor_rad_s_ = motor.torque_free_rate_rad_s();
  const double apart_rad = motor_angle_rad_ - angle_rad + h * (loose_motor_rad_s_ - rate_rad_s);
  play_rad_ = std::copysign(0.5 * model_.backlash_rad, apart_rad);
  loose_ = std::abs(apart_rad) < std::abs(play_rad_);
  if (loose_) return {};
  const double d = spring_damping_nm_s_rad();
  const double spring_rad_s = model_.stiffness_nm_rad * stretch_rad(angle_rad) / d;
  const double g = motor.inertia_nm_s_rad;
  const double both = g + 1.0 / motor.softness;
  const double between = both * d / (both + d);  // slope while the motor is not at its limit
  ServoRow row;
  row.inertia_nm_s_rad = g * d / (g + d);
  row.free_velocity_rad_s = motor.free_velocity_rad_s + spring_rad_s;
  row.softness = motor.softness * (both + d) * (g + d) / (d * d);
  const double unlimited_rad_s =
      (g * motor.free_velocity_rad_s + motor.velocity_rad_s / motor.softness) / both + spring_rad_s;
  row.velocity_rad_s = row.softness * (between * unlimited_rad_s - row.inertia_nm_s_rad * row.free_velocity_rad_s);
  row.torque_limit_nm = motor.torque_limit_nm * d / (g + d);
  return row;
}

double Servo::motor_torque_nm(double motor_rate_rad_s) const {
  const double inertia = model_.rotor_inertia_kg_m2 / step_s_;
  const double limit = torque_limit_nm(motor_rate_rad_s, to_.torque_nm);
  double torque = std::clamp(to_.torque_nm, -limit, limit);
  const double fastest = model_.max_speed_rad_s;
  if (inertia > 0.0) {
    // The rotor alone would reach the maximum speed in this step; whatever turns with it makes it slower.
    torque = std::clamp(torque, std::min(0.0, inertia * (-fastest - motor_rate_rad_s)),
                        std::max(0.0, inertia * (fastest - motor_rate_rad_s)));
  } else if (torque * motor_rate_rad_s > 0.0 && std::abs(motor_rate_rad_s) >= fastest) {
    torque = 0.0;
  }
  // Coulomb friction at most stops the rotor: more would turn it round within the step.
  const double friction = inertia > 0.0 ? model_.gear_friction_nm : 0.0;
  return torque - std::clamp(torque + inertia * motor_rate_rad_s, -friction, friction);
}

ServoRow Servo::torque_row(double angle_rad, double rate_rad_s) {
  const double rate = elastic() ? motor_rate_rad_s_ : rate_rad_s;
  const double torque = motor_torque_nm(rate);
  // Near a limit of the position the servo's own position loop stops the joint.
  const double angle = elastic() ? motor_angle_rad_ : angle_rad;
  const auto to_stop_at = [&](double end_rad) {
    return model_.position_gain_nm_rad * (end_rad - angle) - model_.velocity_gain_nm_s_rad * rate;
  };
  if (to_stop_at(model_.max_rad) < torque) return position_row(model_.max_rad, 0.0, angle_rad, rate_rad_s);
  if (to_stop_at(model_.min_rad) > torque) return position_row(model_.min_rad, 0.0, angle_rad, rate_rad_s);
  // Without a rotor, only the joint shows how fast the gear turns after the step.
  ServoRow motor = model_.rotor_inertia_kg_m2 > 0.0 ? ServoRow{} : friction_row();
  motor.inertia_nm_s_rad = std::max(model_.rotor_inertia_kg_m2, kLeastInertia_kg_m2) / step_s_;
  motor.free_velocity_rad_s = rate + torque / motor.inertia_nm_s_rad;
  return attached(motor, angle_rad, rate_rad_s);
}

void Servo::advance(const ServoRow& row, double angle_before_rad, double rate_rad_s) {
  if (!elastic()) return;
  // The law of the spring gives the rate of the motor, also while the motor is at its limit.
  const double damping_torque_nm = row.torque_nm(rate_rad_s) - model_.stiffness_nm_rad * stretch_rad(angle_before_rad);
  motor_rate_rad_s_ = loose_ ? loose_motor_rad_s_ : rate_rad_s + damping_torque_nm / spring_damping_nm_s_rad();
  motor_angle_rad_ += step_s_ * motor_rate_rad_s_;
}

}  // namespace constrictor
