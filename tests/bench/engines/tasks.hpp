// The two motions for the comparison of engines: the empty robot undulates, and the robot carries an object in its
// body. Both are without feedback, so that each engine receives the same commands.
#pragma once

#include <memory>
#include <numbers>
#include <optional>

#include "bench/engines/engine.hpp"
#include "control/yaw_chain.hpp"
#include "unit/world/open_loop_gait.hpp"

namespace constrictor {

class Motion {
 public:
  virtual ~Motion() = default;
  /// The command for the tick that begins at `time_s`. Call it once for each tick, in order.
  [[nodiscard]] virtual ServoCommand command(double time_s, double period_s) = 0;
  [[nodiscard]] virtual std::optional<ScenarioObject> object() const { return {}; }
  [[nodiscard]] virtual double settled_s() const = 0;   ///< when measuring begins
  [[nodiscard]] virtual double measured_s() const = 0;  ///< how long it lasts
};

class EmptyGait : public Motion {
 public:
  explicit EmptyGait(const RobotModel& robot) : robot_(robot) {}
  [[nodiscard]] ServoCommand command(double time_s, double period_s) override {
    const std::vector<double> now = gait_.angles(robot_, time_s);
    ServoCommand command{gait_.angles(robot_, time_s + period_s), now, now};
    for (std::size_t i = 0; i < now.size(); ++i) {
      command.velocity_rad_s[i] = (command.position_rad[i] - now[i]) / period_s;
      command.torque_limit_nm[i] = robot_.joints[i].max_torque_nm;
    }
    return command;
  }
  [[nodiscard]] double settled_s() const override { return 3.0; }
  [[nodiscard]] double measured_s() const override { return 8.0 / gait_.frequency_hz; }

 private:
  RobotModel robot_;
  OpenLoopGait gait_;
};

/// Three joints bend around an object until 10 s, close further until 20 s, and hold it with a limited torque while the
/// other joints undulate.
class CarryingGait : public Motion {
 public:
  explicit CarryingGait(const RobotModel& robot) : robot_(robot), chain_(robot), before_(robot.joints.size(), 0.0) {}
  [[nodiscard]] std::optional<ScenarioObject> object() const override {
    ScenarioObject object;
    constexpr double kGap_m = 0.01;
    object.position_m = {-13.0 * robot_.module_length_m, robot_.module_radius_m + object.size_m.x() + kGap_m};
    return object;
  }
  [[nodiscard]] ServoCommand command(double time_s, double period_s) override {
    const double t = time_s + period_s;
    LinkArray shape{};
    for (std::size_t k = kFirstBent; k < kFirstBent + 3; ++k)
      shape[k] = kBend_rad * std::min(1.0, t / (kBent_s - 1.0)) + squeeze_rad_ / 3.0;
    ServoCommand command;
    command.torque_limit_nm.assign(robot_.joints.size(), robot_.joints.front().max_torque_nm);
    Wave wave;
    wave.wavelength_m = 1.07;
    wave.field = 1;
    if (t >= kBent_s) {
      wave.amplitude_rad = kQuiet_rad;
      if (t > kBent_s + 2.0 && t < kClosed_s) squeeze_rad_ = std::min(kSqueeze_rad, squeeze_rad_ + 0.1 * period_s);
      if (t < kClosed_s) shape[kFirstBent - 1] = shape[kFirstBent + 3] = -0.25 * squeeze_rad_;
      for (std::size_t k = kFirstBent; k < kFirstBent + 3; ++k)
        command.torque_limit_nm[chain_.joint_index(k)] = t < kClosed_s ? 2.5 : 1.5;
    }
    if (t >= kClosed_s) wave.amplitude_rad += (0.6 - kQuiet_rad) * std::min(1.0, t - kClosed_s);
    phase_rad_ += 2.0 * std::numbers::pi * (t < kClosed_s ? 0.4 : 1.1) * period_s;
    wave.phase_rad = phase_rad_;
    const WaveWeights weights{{0.0, 0.5, 0.8}, kBend_rad};
    const auto angles = chain_.joint_angles(shape, wave, weights);
    command.position_rad.assign(robot_.joints.size(), 0.0);
    for (std::size_t k = 0; k < chain_.joint_count(); ++k) command.position_rad[chain_.joint_index(k)] = angles[k];
    for (std::size_t i = 0; i < before_.size(); ++i)
      command.velocity_rad_s.push_back((command.position_rad[i] - before_[i]) / period_s);
    before_ = command.position_rad;
    return command;
  }
  [[nodiscard]] double settled_s() const override { return kClosed_s + 6.0; }
  [[nodiscard]] double measured_s() const override { return 20.0; }

 private:
  static constexpr std::size_t kFirstBent = 5;
  static constexpr double kBend_rad = 1.047;
  static constexpr double kSqueeze_rad = 0.35;
  static constexpr double kQuiet_rad = 0.35;  ///< amplitude while the body closes
  static constexpr double kBent_s = 10.0;
  static constexpr double kClosed_s = 20.0;

  RobotModel robot_;
  YawChain chain_;
  std::vector<double> before_;
  double squeeze_rad_ = 0.0;
  double phase_rad_ = 0.0;
};

}  // namespace constrictor
