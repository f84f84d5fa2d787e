// The servo of one joint as the world drives and measures it. The engine turns the joint.
#pragma once

#include "robot/joint_limits.hpp"
#include "robot/robot_model.hpp"
#include "sim/world/servo.hpp"

namespace constrictor {

class JointDrive {
 public:
  explicit JointDrive(const JointModel& model) : servo_(model) {}

  void set(const JointSetpoint& setpoint) { servo_.set(setpoint); }
  void begin_tick(int steps, double step_s) { servo_.begin_tick(steps, step_s); }
  /// The servo's row for the next step.
  [[nodiscard]] ServoRow drive() {
    row_ = servo_.row(angle_rad_, rate_rad_s_);
    return row_;
  }
  /// Call after each step, with the angle, the rate and the torque that the engine reports. `filter_s` is the time
  /// constant of the low pass of the torque.
  void measure(double angle_rad, double rate_rad_s, double torque_nm, double step_s, double filter_s) {
    servo_.advance(row_, angle_rad_, rate_rad_s);
    place(angle_rad, rate_rad_s);
    step_torque_nm_ = torque_nm;
    torque_nm_ += (torque_nm - torque_nm_) * step_s / (filter_s + step_s);
  }
  /// Sets angle and rate without a step: at the start, and after the engine has loaded a checkpoint.
  void place(double angle_rad, double rate_rad_s) {
    angle_rad_ = angle_rad;
    rate_rad_s_ = rate_rad_s;
  }

  [[nodiscard]] double angle_rad() const { return angle_rad_; }
  [[nodiscard]] double rate_rad_s() const { return rate_rad_s_; }
  [[nodiscard]] double torque_nm() const { return torque_nm_; }            ///< low-pass filtered
  [[nodiscard]] double step_torque_nm() const { return step_torque_nm_; }  ///< of the last step
  /// Differs from the joint's angle if the joint is elastic.
  [[nodiscard]] double motor_angle_rad() const { return servo_.elastic() ? servo_.motor_angle_rad() : angle_rad(); }
  [[nodiscard]] const Servo& servo() const { return servo_; }

  /// The memory of the drive between two ticks. The engine's memory, with angle and rate, is not part of it.
  template <class Archive>
  void serialize(Archive& archive) {
    archive(servo_, torque_nm_, step_torque_nm_);
  }

 private:
  Servo servo_;
  ServoRow row_;
  double angle_rad_ = 0.0;
  double rate_rad_s_ = 0.0;
  double torque_nm_ = 0.0;
  double step_torque_nm_ = 0.0;
};

}  // namespace constrictor
