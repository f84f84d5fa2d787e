#include "sim/servo_emulator/emulated_robot.hpp"

#include <fmt/format.h>

#include <cmath>

#include "configuration/configuration.hpp"
#include "dynamixel/sensor_board.hpp"

namespace constrictor::servo_emulator {

EmulatedRobot::EmulatedRobot(const RobotModel& robot, const Scenario& scenario, const dynamixel::BusPlan& plan,
                             std::uint64_t seed, const SolverSettings& settings)
    : plan_(plan),
      world_(robot, scenario, settings),
      sensors_(robot, seed, scenario.sensor_noise),
      chains_(plan.ports.size()),
      orders_(robot.joints.size()),
      step_ns_(std::llround(settings.step_s * 1e9)) {
  if (plan.joints.size() != robot.joints.size())
    throw ConfigurationError(fmt::format("bus file: found {} joints, accepted {}, as robot {} has", plan.joints.size(),
                                         robot.joints.size(), robot.name));
  std::vector<std::vector<BusDevice*>> devices(plan.ports.size());
  for (const auto& joint : plan.joints) {
    servos_.push_back(std::make_unique<ServoDevice>(plan.model, joint, plan.ports[joint.port].baud, seed));
    chains_[joint.port].push_back(servos_.back().get());
    devices[joint.port].push_back(servos_.back().get());
  }
  const auto board = [&](std::uint16_t model, const dynamixel::SensorBoard& at) {
    auto made = std::make_unique<BoardDevice>(model, at.id, plan.ports[at.port].baud);
    devices[at.port].push_back(made.get());
    return made;
  };
  if (plan.imu) imu_ = board(dynamixel::sensor_board::kImuModel, *plan.imu);
  for (const auto& at : plan.contact_boards) contacts_.push_back(board(dynamixel::sensor_board::kContactModel, at));
  for (std::size_t port = 0; port < devices.size(); ++port)
    lines_.push_back(std::make_unique<ServoLine>(std::move(devices[port]), seed + port));
}

int EmulatedRobot::advance_to(std::int64_t now_ns) {
  if (now_ns - time_ns_ > kMostLag_ns) {
    const std::int64_t left_out = (now_ns - time_ns_ - kMostLag_ns) / step_ns_ * step_ns_;
    left_out_ns_ += left_out;
    time_ns_ += left_out;
  }
  int steps = 0;
  for (; next_step_ns() <= now_ns; ++steps) {
    time_ns_ += step_ns_;
    step();
  }
  return steps;
}

void EmulatedRobot::step() {
  const double step_s = static_cast<double>(step_ns_) * 1e-9;
  for (std::size_t i = 0; i < servos_.size(); ++i) orders_[i] = servos_[i]->order(step_s);
  world_.set_servo(orders_);
  world_.advance(step_s);
  for (std::size_t i = 0; i < servos_.size(); ++i) {
    // A servo measures its unfiltered current; its driver filters the values, as the robot file says.
    servos_[i]->advance(step_s, time_ns_,
                        {world_.joint_angle_rad(i), world_.joint_rate_rad_s(i), world_.joint(i).step_torque_nm()});
  }
  if (imu_) imu_->measure(sensors_.imu(world_, step_s));
  if (contacts_.empty()) return;
  msg::ContactState felt{};
  msg::TouchedState touched{};
  sensors_.contacts(world_, felt, touched);
  for (std::size_t i = 0; i < contacts_.size(); ++i) contacts_[i]->measure(static_cast<std::uint8_t>(i), felt);
}

void EmulatedRobot::break_cable(std::size_t port, std::size_t behind) {
  lines_[port]->faults.cable_broken_behind = behind;
  // The cable also carries the power: a servo behind the break stops, and starts anew when it is plugged in again.
  for (std::size_t i = behind + 1; i < chains_[port].size(); ++i) chains_[port][i]->reboot();
}

}  // namespace constrictor::servo_emulator
