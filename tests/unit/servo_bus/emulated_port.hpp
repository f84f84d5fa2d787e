// Ports that lead to an emulated robot, with a clock that advances only while the driver waits.
#pragma once

#include <algorithm>
#include <functional>
#include <memory>

#include "serial/port.hpp"
#include "sim/servo_emulator/emulated_robot.hpp"

namespace constrictor {

/// The robot and its time.
struct Bench {
  explicit Bench(std::unique_ptr<servo_emulator::EmulatedRobot> made) : robot(std::move(made)) {}
  void pass_until(std::int64_t when_ns) {
    now_ns = std::max(now_ns, when_ns);
    robot->advance_to(now_ns);
    if (on_time) on_time();
  }
  std::unique_ptr<servo_emulator::EmulatedRobot> robot;
  std::int64_t now_ns = 1;
  std::function<void()> on_time;  ///< called after time has passed; may be empty
  bool unplugged = false;         ///< the adapters are gone
  std::uint64_t bytes_sent = 0;   ///< by the driver
};

class EmulatedPort final : public serial::Port {
 public:
  EmulatedPort(Bench& bench, std::size_t index, std::uint32_t baud) : bench_(bench), index_(index), baud_(baud) {
    require();
  }
  void write(dynamixel::ByteView bytes) override {
    require();
    bench_.bytes_sent += bytes.size();
    line().receive(bytes, baud_, bench_.now_ns);
  }
  [[nodiscard]] bool read(dynamixel::Bytes& to, std::int64_t deadline_ns) override {
    require();
    auto& outgoing = line().outgoing();
    if (outgoing.empty() || outgoing.front().at_ns > std::max(deadline_ns, bench_.now_ns)) {
      bench_.pass_until(deadline_ns);
      return false;
    }
    bench_.pass_until(outgoing.front().at_ns);
    to.insert(to.end(), outgoing.front().bytes.begin(), outgoing.front().bytes.end());
    outgoing.pop_front();
    return true;
  }
  void drop_input() override { line().outgoing().clear(); }
  [[nodiscard]] std::int64_t now_ns() const override { return bench_.now_ns; }
  [[nodiscard]] std::uint32_t baud() const override { return baud_; }

 private:
  [[nodiscard]] servo_emulator::ServoLine& line() { return bench_.robot->line(index_); }
  void require() const {
    if (bench_.unplugged) throw serial::PortError("the port is gone");
  }
  Bench& bench_;
  std::size_t index_;
  std::uint32_t baud_;
};

}  // namespace constrictor
