#include "sim/servo_emulator/board_device.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>

#include "dynamixel/sensor_board.hpp"

namespace constrictor::servo_emulator {

using dynamixel::StatusError;
namespace map = dynamixel::sensor_board;

BoardDevice::BoardDevice(std::uint16_t model_number, std::uint8_t id, std::uint32_t baud)
    : model_number_(model_number), memory_(std::max(map::imu::kEnd, map::contact::kEnd), 0) {
  memory_[0] = static_cast<std::uint8_t>(model_number & 0xFF);
  memory_[1] = static_cast<std::uint8_t>(model_number >> 8);
  memory_[6] = firmware();
  memory_[kId] = id;
  const auto rate = std::find(std::begin(dynamixel::kBaudRates), std::end(dynamixel::kBaudRates), baud);
  memory_[kBaud] = static_cast<std::uint8_t>(rate - std::begin(dynamixel::kBaudRates));
}

StatusError BoardDevice::read(std::uint16_t address, std::uint16_t count, dynamixel::Bytes& to) const {
  if (address + count > memory_.size()) return StatusError::kDataRange;
  to.insert(to.end(), memory_.begin() + address, memory_.begin() + address + count);
  return StatusError::kNone;
}

StatusError BoardDevice::write(std::uint16_t address, dynamixel::ByteView data) {
  if (data.size() != 1 || address < kId || address > kDelay) return StatusError::kAccess;
  const int most = address == kId ? dynamixel::kLargestId : address == kBaud ? 7 : 254;
  if (data[0] > most) return StatusError::kDataRange;
  memory_[address] = data[0];
  return StatusError::kNone;
}

void BoardDevice::put(std::size_t address, double value, double unit) {
  const auto number =
      static_cast<std::uint16_t>(static_cast<std::int16_t>(std::lround(std::clamp(value / unit, -32767.0, 32767.0))));
  memory_[address] = static_cast<std::uint8_t>(number & 0xFF);
  memory_[address + 1] = static_cast<std::uint8_t>(number >> 8);
}

void BoardDevice::put(std::size_t address, const msg::Vector3& value, double unit) {
  put(address, value.x, unit);
  put(address + 2, value.y, unit);
  put(address + 4, value.z, unit);
}

void BoardDevice::count() {
  if (++memory_[map::kBegin] == 0) ++memory_[map::kBegin + 1];
}

void BoardDevice::measure(const msg::ImuState& imu) {
  count();
  const msg::Quaternion& q = imu.orientation;
  put(map::imu::kOrientation, q.w, map::kUnitVector);
  put(map::imu::kOrientation + 2, msg::Vector3{q.x, q.y, q.z}, map::kUnitVector);
  put(map::imu::kAngularVelocity, imu.angular_velocity_rad_s, map::kRate_rad_s);
  put(map::imu::kLinearAcceleration, imu.linear_acceleration_m_s2, map::kAcceleration_m_s2);
}

void BoardDevice::measure(std::uint8_t module, const msg::ContactState& felt) {
  count();
  std::fill(memory_.begin() + map::contact::kForce, memory_.begin() + map::contact::kEnd, std::uint8_t{0});
  if (numb_) return;
  put(map::contact::kForce, felt.force_n[module], map::kForce_n);
  put(map::contact::kMoment, felt.torque_nm[module], map::kMoment_nm);
  std::uint8_t& known = memory_[map::contact::kContacts];
  for (std::size_t i = 0; i < felt.contact_count && known < map::contact::kMost; ++i) {
    const msg::Contact& one = felt.contacts[i];
    if (one.module_index != module) continue;
    const std::size_t at = map::contact::kFirst + std::size_t{known} * map::contact::kBytesOfOne;
    ++known;
    put(at, one.position_m, map::kPosition_m);
    put(at + 6, one.normal, map::kUnitVector);
    put(at + 12, one.force_n, map::kForce_n);
  }
}

}  // namespace constrictor::servo_emulator
