// The whole emulated robot: the simulated world, a servo at each joint, boards with sensors, and the serial lines.
// Pure: equal bytes at equal times give equal worlds, bit for bit.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "dynamixel/bus_plan.hpp"
#include "sim/physics/sensors.hpp"
#include "sim/servo_emulator/board_device.hpp"
#include "sim/servo_emulator/servo_device.hpp"
#include "sim/servo_emulator/servo_line.hpp"
#include "sim/world/world.hpp"

namespace constrictor::servo_emulator {

class EmulatedRobot {
 public:
  /// Throws ConfigurationError if the bus file has another number of joints than the robot.
  EmulatedRobot(const RobotModel& robot, const Scenario& scenario, const dynamixel::BusPlan& plan, std::uint64_t seed,
                const SolverSettings& settings = {});

  /// Lets the world move until `now_ns` [ns since the beginning], in whole steps of the solver. If it is more than
  /// kMostLag_ns behind, it leaves out the rest: the world then runs slower than the clock. Returns the steps made.
  int advance_to(std::int64_t now_ns);
  static constexpr std::int64_t kMostLag_ns = 200'000'000;
  /// When the next step is due.
  [[nodiscard]] std::int64_t next_step_ns() const { return time_ns_ + step_ns_; }

  [[nodiscard]] ServoLine& line(std::size_t port) { return *lines_[port]; }
  [[nodiscard]] ServoDevice& servo(std::size_t joint) { return *servos_[joint]; }
  [[nodiscard]] const World& world() const { return world_; }
  /// [ns] that were left out because the host was too slow.
  [[nodiscard]] std::int64_t left_out_ns() const { return left_out_ns_; }

  /// Obeys a line such as "cable 0 7". README.md lists the commands. Returns why it refuses the line; empty: obeyed.
  [[nodiscard]] std::string command(const std::string& line);

 private:
  void step();
  void break_cable(std::size_t port, std::size_t behind);
  /// `how`: the name of a command of a port, or of a joint.
  void break_line(std::size_t port, std::string_view how, double value);
  void break_servo(std::size_t joint, std::string_view how, double value);

  dynamixel::BusPlan plan_;
  World world_;
  Sensors sensors_;
  std::vector<std::unique_ptr<ServoDevice>> servos_;
  std::unique_ptr<BoardDevice> imu_;
  std::vector<std::unique_ptr<BoardDevice>> contacts_;
  std::vector<std::vector<ServoDevice*>> chains_;  ///< the servos of each port
  std::vector<std::unique_ptr<ServoLine>> lines_;
  std::vector<JointSetpoint> orders_;  ///< of the servos to their joints, in this step
  std::int64_t step_ns_;
  std::int64_t time_ns_ = 0;  ///< of the clock, up to which the world has moved
  std::int64_t left_out_ns_ = 0;
};

}  // namespace constrictor::servo_emulator
