// A run with servo_bus as its plant, on the emulated robot; the test plays control.
#pragma once

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>
#include <memory>
#include <string>
#include <vector>

#include <fstream>

#include "barrier/local_run.hpp"
#include "component/plant_stop.hpp"
#include "emulated_port.hpp"
#include "servo_bus/servo_bus.hpp"
#include "sim/scenario_loader/scenario_file.hpp"
#include "support/commander.hpp"
#include "support/project.hpp"
#include "support/temporary_folder.hpp"

namespace constrictor {

inline const std::filesystem::path kProject = testing::source_path();

class DrivenRobot : public ::testing::Test {
 protected:
  DrivenRobot()
      : plan_(dynamixel::load_bus_plan(kProject / "deploy/buses/mamba_emulated.yaml",
                                       kProject / "components/lib/dynamixel/models")),
        bench_(std::make_unique<servo_emulator::EmulatedRobot>(load_robot(kProject / "components/lib/robot/mamba.yaml"),
                                                               load_scenario(kProject / "sim/scenarios/line.yaml", 1),
                                                               plan_, 1)) {}

  /// Starts the run, with these configuration lines for servo_bus.
  void start(const std::string& config = "") {
    std::ofstream(config_.path() / "servo_bus.yaml") << config << "\n";
    constrictor::Setup setup;
    log_.forward([this](const LogRecord& record) { logged_.push_back(record); });
    setup.log = log_;
    setup.robot_file = kProject / "components/lib/robot/mamba.yaml";
    const OpenPort open = [this](const dynamixel::BusPort& port, double patience_s) {
      patience_s_.push_back(patience_s);
      return std::make_unique<EmulatedPort>(bench_, port.device == "bus0" ? 0 : 1, port.baud);
    };
    const ComponentFactory control = testing::commander(
        [this](std::int64_t tick, msg::JointCommand& command) { return command_ && command_(tick, command); });
    const auto file = config.empty() ? std::filesystem::path{} : config_.path() / "servo_bus.yaml";
    std::map<std::string, std::filesystem::path> files;
    if (!file.empty()) files["servo_bus"] = file;
    run_ =
        std::make_unique<LocalRun>(std::vector<ComponentFactory>{make_servo_bus_factory(open), control}, setup, files);
  }
  /// Starts the run with the command that relaxes the servos, which stays in force.
  void start_relaxed() {
    command_ = [](std::int64_t, msg::JointCommand& command) {
      command.mode = msg::kServoRelaxed;
      return true;
    };
    start();
    ticks(20);
    EXPECT_EQ(torques_on(), 0);
  }
  void ticks(int count) {
    for (int i = 0; i < count; ++i) {
      bench_.pass_until(next_tick_ns_);
      run_->advance(1);
      next_tick_ns_ = std::max(next_tick_ns_ + 20'000'000, bench_.now_ns);
    }
  }
  [[nodiscard]] ServoBus& driver() { return dynamic_cast<ServoBus&>(run_->component("servo_bus")); }
  [[nodiscard]] GateMode mode() { return driver().gate().mode; }
  [[nodiscard]] double true_angle_rad(std::size_t joint) { return bench_.robot->world().joint_angle_rad(joint); }
  [[nodiscard]] std::vector<double> posture() {
    std::vector<double> angles;
    for (std::size_t i = 0; i < 23; ++i) angles.push_back(true_angle_rad(i));
    return angles;
  }
  /// [rad] by which the joint that moved most has moved since `before`.
  [[nodiscard]] double moved_rad(const std::vector<double>& before) {
    double most = 0.0;
    for (std::size_t i = 0; i < 23; ++i) most = std::max(most, std::abs(true_angle_rad(i) - before[i]));
    return most;
  }
  [[nodiscard]] int torques_on() {
    int count = 0;
    for (std::size_t i = 0; i < 23; ++i) count += static_cast<int>(bench_.robot->servo(i).get("torque_enable"));
    return count;
  }
  void order_stop() { run_->member("servo_bus").stop_orders()->add("somebody"); }
  [[nodiscard]] std::string last_refusal() { return run_->member("servo_bus").counters().last_refusal; }
  /// Bends the yaw joints to a zigzag, in which the body does not touch itself.
  static testing::CommandAt bend(double angle_rad) {
    return [angle_rad](std::int64_t, msg::JointCommand& command) {
      for (int i = 0; i < 23; i += 2) command.position_rad[i] = i % 4 == 0 ? angle_rad : -angle_rad;
      return true;
    };
  }

  /// The lines of the driver's log with this level that contain this text.
  [[nodiscard]] int logged(std::uint8_t level, const std::string& text) const {
    return static_cast<int>(std::count_if(logged_.begin(), logged_.end(), [&](const LogRecord& line) {
      return line.level == level && line.text.find(text) != std::string::npos;
    }));
  }

  const testing::TemporaryFolder config_;
  const Log log_{"servo_bus", config_.path() / "servo_bus.log"};
  std::vector<LogRecord> logged_;
  dynamixel::BusPlan plan_;
  Bench bench_;
  testing::CommandAt command_;
  std::vector<double> patience_s_;  ///< of each attempt to open a port
  std::unique_ptr<LocalRun> run_;
  std::int64_t next_tick_ns_ = 20'000'000;
};

}  // namespace constrictor
