// What the tests of the emulated servos share: a model, packets as texts, and a controller of a line.
#pragma once

#include <gtest/gtest.h>

#include <filesystem>
#include <string>
#include <vector>

#include "dynamixel/instructions.hpp"
#include "dynamixel/packet_parser.hpp"
#include "sim/servo_emulator/servo_device.hpp"
#include "sim/servo_emulator/servo_line.hpp"
#include "support/project.hpp"

namespace constrictor::servo_emulator {

using dynamixel::Bytes;
using dynamixel::ByteView;
using dynamixel::StatusError;

inline const dynamixel::ServoModel& model() {
  static const dynamixel::ServoModel loaded =
      dynamixel::load_servo_model(testing::source_path("components/lib/dynamixel/models/xm540_w150.yaml"));
  return loaded;
}

inline dynamixel::JointServo servo_with_id(std::uint8_t id) {
  dynamixel::JointServo servo;
  servo.id = id;
  servo.torque_constant_nm_a = 2.0;
  return servo;
}

inline constexpr std::uint32_t kBaud = 1'000'000;

/// A servo, addressed by the names of its registers.
class NamedServo {
 public:
  explicit NamedServo(std::uint8_t id = 1, const ServoTraits& traits = quiet())
      : device(model(), servo_with_id(id), kBaud, 1, traits) {}
  StatusError write(const std::string& name, std::int64_t value) {
    Bytes bytes;
    dynamixel::put_value(bytes, model().at(name), value);
    return device.write(model().at(name).address, bytes);
  }
  [[nodiscard]] std::int64_t read(const std::string& name) const {
    const auto& reg = model().at(name);
    Bytes bytes;
    EXPECT_EQ(device.read(reg.address, reg.bytes, bytes), StatusError::kNone);
    return dynamixel::get_number(bytes, reg.bytes, reg.is_signed);
  }
  /// Lets time pass in steps of 4 ms; the joint does not move.
  void pass(double seconds, const JointMotion& motion = {}) {
    for (double t = 0.0; t < seconds - 1e-9; t += kStep_s) {
      now_ns += 4'000'000;
      device.advance(kStep_s, now_ns, motion);
    }
  }
  static ServoTraits quiet() {
    ServoTraits traits;
    traits.current_noise_a = 0.0;
    return traits;
  }

  static constexpr double kStep_s = 0.004;
  std::int64_t now_ns = 0;
  ServoDevice device;
};

}  // namespace constrictor::servo_emulator
