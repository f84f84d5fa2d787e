// A gate of two joints that advances tick by tick.
#pragma once

#include <gtest/gtest.h>

#include <limits>
#include <string>
#include <vector>

#include "robot/safety_gate.hpp"
#include "support/usual_joint.hpp"

namespace constrictor {

inline constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
inline constexpr double kInfinity = std::numeric_limits<double>::infinity();
inline constexpr double kDt_s = 0.02;
inline constexpr double kFastest_rad = 4.0 * kDt_s;  // greatest step of the usual joint in a tick

class SafetyGateTest : public ::testing::Test {
 protected:
  static RobotModel two_joints() {
    RobotModel robot;
    robot.module_count = 3;
    robot.joints.assign(2, testing::usual_joint());
    return robot;
  }
  /// A command that came `age` ticks after it was written.
  GateRefusal offer(std::vector<double> position, std::vector<double> torque = {5.0, 5.0}, std::int64_t age = 1,
                    std::uint8_t mode = 0) {
    const std::vector<double> velocity(position.size(), velocity_);
    return gate_.offer({7, run_epoch_, now_.tick - age, ++sequence_, mode, position, velocity, torque}, now_, state_);
  }
  const std::vector<JointSetpoint>& tick(GateOrder order = GateOrder::kObey) {
    ++now_.tick;
    return gate_.setpoints({measured_, rates_}, order, kDt_s, state_);
  }
  /// Obeys until both joints' setpoints are there.
  void drive_to(double a, double b) {
    for (int i = 0; i < 100; ++i) {
      offer({a, b});
      tick();
    }
    measured_ = {a, b};
  }
  GateOrder authority(std::uint8_t level, const std::string& source = "somebody", bool stop = false) {
    return SafetyGate::order_of(stop, level, source, state_);
  }
  [[nodiscard]] std::uint64_t refused(GateRefusal reason) const { return SafetyGate::refused(state_, reason); }

  SafetyGate gate_{two_joints(), {3, 10}};
  GateState state_;
  GateInstant now_{7, 2, 100};
  std::uint32_t run_epoch_ = 2;
  std::uint64_t sequence_ = 0;
  double velocity_ = 0.0;
  std::vector<double> measured_{0.25, -0.25};
  std::vector<double> rates_{0.0, 0.0};
};

}  // namespace constrictor
