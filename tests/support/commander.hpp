// Takes the place of `control` in a run within one process: writes the commands that a test gives.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <utility>

#include "component/component.hpp"

namespace constrictor::testing {

/// Fills in the command of a tick; returns false if none is to be written.
using CommandAt = std::function<bool(std::int64_t tick, msg::JointCommand&)>;

class Commander final : public Component {
 public:
  static constexpr std::uint16_t kJoints = 23;  // of the robot `mamba`

  Commander(Wiring& wiring, CommandAt command_at)
      : command_at_(std::move(command_at)), output_(wiring.output(topics::kJointCommand)) {}
  void step(const Tick& tick) override {
    msg::JointCommand command{};
    command.joint_count = kJoints;
    for (std::size_t i = 0; i < kJoints; ++i) command.torque_limit_nm[i] = 6.0;
    if (command_at_(tick.index, command)) output_.write(command);
  }
  [[nodiscard]] std::string save() const override { return {}; }
  void load(const std::string&) override {}

 private:
  CommandAt command_at_;
  Output<msg::JointCommand> output_;
};

inline ComponentFactory commander(CommandAt command_at) {
  return {"control", [command_at = std::move(command_at)](Wiring& wiring, const constrictor::Setup&) {
            return std::make_unique<Commander>(wiring, command_at);
          }};
}

}  // namespace constrictor::testing
