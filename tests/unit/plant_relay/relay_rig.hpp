// A run with plant_relay as its plant; the test plays control and the hardware.
#pragma once

#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "barrier/local_run.hpp"
#include "component/hardware_link.hpp"
#include "component/plant_stop.hpp"
#include "configuration/configuration.hpp"
#include "constrictor/text.hpp"
#include "plant_relay/plant_relay.hpp"
#include "support/commander.hpp"
#include "support/project.hpp"
#include "support/temporary_folder.hpp"

namespace constrictor {

inline constexpr std::size_t kJoints = testing::Commander::kJoints;
inline constexpr std::int64_t kPeriod_ns = 20'000'000;

class Relay : public ::testing::Test {
 protected:
  explicit Relay(const std::string& config = "hardware: {patience_s: 1}\n") {
    std::ofstream(folder_.path() / "relay.yaml") << config;
    constrictor::Setup setup;
    setup.robot_file = testing::robot_path("mamba");
    const ComponentFactory control = testing::commander(
        [this](std::int64_t tick, msg::JointCommand& command) { return command_ && command_(tick, command); });
    run_ = std::make_unique<LocalRun>(
        std::vector<ComponentFactory>{make_plant_relay_factory(), control}, setup,
        std::map<std::string, std::filesystem::path>{{"plant_relay", folder_.path() / "relay.yaml"}});
    link().connect([this](const msg::HardwareJointCommand& command) { sent_.push_back(command); }, {});
    angles_rad_.resize(kJoints);
  }

  HardwareLink& link() { return *run_->member("plant_relay").hardware_link(); }
  PlantRelay& relay() { return dynamic_cast<PlantRelay&>(run_->component("plant_relay")); }
  [[nodiscard]] std::string last_refusal() { return run_->member("plant_relay").counters().last_refusal; }
  [[nodiscard]] GateMode mode() { return relay().gate().mode; }

  /// What the hardware would write now. It obeys the newest command at once.
  msg::HardwareJointState measured() {
    if (!sent_.empty() && follows_) {
      for (std::size_t i = 0; i < kJoints; ++i) angles_rad_[i] = sent_.back().position_rad[i];
    }
    msg::HardwareJointState state{};
    state.session = session_;
    state.sequence_number = ++number_;
    state.time_ns = time_ns_;
    if (!sent_.empty() && hears_) {
      confirmed_session_ = sent_.back().session;
      confirmed_number_ = sent_.back().sequence_number;
    }
    state.command_session = confirmed_session_;
    state.command_number = confirmed_number_;
    state.joint_count = kJoints;
    std::copy(angles_rad_.begin(), angles_rad_.end(), state.position_rad);
    return state;
  }
  void ticks(int count) {
    for (int i = 0; i < count; ++i) {
      time_ns_ += kPeriod_ns;
      if (alive_) {
        msg::HardwareJointState state = measured();
        if (damage_) damage_(state);
        link().add(state);
      }
      run_->advance(1);
    }
  }
  static testing::CommandAt bend(double angle_rad) {
    return [angle_rad](std::int64_t, msg::JointCommand& command) {
      command.position_rad[4] = angle_rad;
      return true;
    };
  }

  const testing::TemporaryFolder folder_;
  testing::CommandAt command_;
  std::unique_ptr<LocalRun> run_;
  std::vector<msg::HardwareJointCommand> sent_;
  std::vector<double> angles_rad_;
  std::function<void(msg::HardwareJointState&)> damage_;
  bool alive_ = true, follows_ = true, hears_ = true;
  std::uint64_t session_ = 77, number_ = 0, confirmed_session_ = 0, confirmed_number_ = 0;
  std::int64_t time_ns_ = 5;
};

}  // namespace constrictor
