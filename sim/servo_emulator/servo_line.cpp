#include "sim/servo_emulator/servo_line.hpp"

#include <algorithm>

#include "dynamixel/crc16.hpp"
#include "dynamixel/instructions.hpp"

namespace constrictor::servo_emulator {

using dynamixel::Bytes;
using dynamixel::ByteView;
using dynamixel::Instruction;
using dynamixel::PacketView;
using dynamixel::StatusError;

namespace {

constexpr std::int64_t kBitsOfAByte = 10;  // with start and stop bit

std::int64_t time_ns(std::size_t bytes, std::uint32_t baud) {
  return static_cast<std::int64_t>(bytes) * kBitsOfAByte * 1'000'000'000 / baud;
}

std::uint16_t word(ByteView at) { return static_cast<std::uint16_t>(dynamixel::get_number(at, 2, false)); }

std::uint8_t error_field(const BusDevice& device, StatusError error) {
  return static_cast<std::uint8_t>(static_cast<std::uint8_t>(error) | (device.alert() ? dynamixel::kAlert : 0));
}

}  // namespace

std::vector<BusDevice*> ServoLine::hearing() const {
  std::vector<BusDevice*> list;
  for (std::size_t i = 0; i < devices_.size(); ++i) {
    if (faults.cable_broken_behind && i > *faults.cable_broken_behind) break;
    if (std::find(faults.silent.begin(), faults.silent.end(), i) != faults.silent.end()) continue;
    if (devices_[i]->baud() == baud_) list.push_back(devices_[i]);
  }
  return list;
}

BusDevice* ServoLine::find(std::uint8_t id) const {
  const auto list = hearing();
  const auto found = std::find_if(list.begin(), list.end(), [&](const BusDevice* one) { return one->id() == id; });
  return found == list.end() ? nullptr : *found;
}

void ServoLine::receive(ByteView bytes, std::uint32_t baud, std::int64_t now_ns) {
  if (baud == 0) return;
  if (baud != baud_) parser_.clear();
  baud_ = baud;
  free_ns_ = std::max(free_ns_, now_ns) + time_ns(bytes.size(), baud);
  parser_.add(bytes);
  while (const auto packet = parser_.next()) {
    for (BusDevice* device : hearing()) device->heard(free_ns_);
    obey(*packet);
  }
}

void ServoLine::obey(const PacketView& packet) {
  const bool broadcast = packet.id == dynamixel::kBroadcast;
  switch (packet.instruction) {
    case Instruction::kStatus:
      return;
    case Instruction::kSyncRead:
      if (broadcast) answer_sync_read(packet);
      return;
    case Instruction::kFastSyncRead:
      if (broadcast) answer_fast_sync_read(packet);
      return;
    case Instruction::kSyncWrite:
      if (broadcast) sync_write(packet);
      return;
    default:
      break;
  }
  const std::size_t before = outgoing_.size();
  for (BusDevice* device : hearing()) {
    if (broadcast && packet.instruction == Instruction::kPing) answer_ping(*device);
    else if (broadcast || device->id() == packet.id) answer_one(*device, packet);
    // Two devices with one id pull the line low at the same time: the controller sees the logical AND of their bits.
    if (!broadcast && outgoing_.size() > before + 1) {
      Bytes& first = outgoing_[before].bytes;
      const Bytes& second = outgoing_.back().bytes;
      for (std::size_t i = 0; i < std::min(first.size(), second.size()); ++i) first[i] &= second[i];
      outgoing_.pop_back();
    }
  }
}

void ServoLine::answer_ping(BusDevice& device) {
  Bytes data;
  dynamixel::put_number(data, device.model_number(), 2);
  data.push_back(device.firmware());
  Bytes status;
  dynamixel::put_status(status, device.id(), error_field(device, StatusError::kNone), data);
  send(device.return_delay_ns(), status);
}

void ServoLine::answer_one(BusDevice& device, const PacketView& packet) {
  const std::uint8_t id = device.id();  // a write may change it; the answer still has the old one
  const std::int64_t delay_ns = device.return_delay_ns();
  const bool broadcast = packet.id == dynamixel::kBroadcast;
  const ByteView parameters = packet.parameters;
  StatusError error = StatusError::kNone;
  Bytes data;
  int level = 2;
  switch (packet.instruction) {
    case Instruction::kPing:
      if (parameters.empty()) return answer_ping(device);
      error = StatusError::kDataLength;
      break;
    case Instruction::kRead:
      level = 1;
      if (broadcast) return;
      if (parameters.size() != 4) error = StatusError::kDataLength;
      else error = device.read(word(parameters), word(parameters.subspan(2)), data);
      if (error != StatusError::kNone) data.clear();
      break;
    case Instruction::kWrite:
      error = parameters.size() < 3 ? StatusError::kDataLength : device.write(word(parameters), parameters.subspan(2));
      break;
    case Instruction::kReboot:
      if (!parameters.empty()) error = StatusError::kDataLength;
      else device.reboot();
      break;
    case Instruction::kClear: {
      Bytes clear;
      dynamixel::put_clear_turns(clear, 0);
      const ByteView option = ByteView(clear).subspan(8, 5);
      const bool right = std::equal(parameters.begin(), parameters.end(), option.begin(), option.end());
      error = right ? device.clear_turns() : StatusError::kDataRange;
      break;
    }
    default:
      error = StatusError::kInstruction;
      break;
  }
  if (broadcast || device.status_return_level() < level) return;
  Bytes status;
  dynamixel::put_status(status, id, error_field(device, error), data);
  send(delay_ns, status);
}

void ServoLine::answer_sync_read(const PacketView& packet) {
  if (packet.parameters.size() < 5) return;
  for (const std::uint8_t id : packet.parameters.subspan(4)) {
    BusDevice* device = find(id);
    // A device answers when it has received the answer of the device before it.
    if (!device || device->status_return_level() < 1) return;
    Bytes data;
    const StatusError error = device->read(word(packet.parameters), word(packet.parameters.subspan(2)), data);
    if (error != StatusError::kNone) data.clear();
    Bytes status;
    dynamixel::put_status(status, id, error_field(*device, error), data);
    send(device->return_delay_ns(), status);
  }
}

void ServoLine::answer_fast_sync_read(const PacketView& packet) {
  if (packet.parameters.size() < 5) return;
  const std::uint16_t count = word(packet.parameters.subspan(2));
  const ByteView ids = packet.parameters.subspan(4);
  const std::size_t length = 1 + ids.size() * (count + 4u);
  if (length > dynamixel::kLargestLength) return;
  Bytes answer(dynamixel::kHeader.begin(), dynamixel::kHeader.end());
  answer.push_back(dynamixel::kBroadcast);
  dynamixel::put_number(answer, static_cast<std::int64_t>(length), 2);
  answer.push_back(static_cast<std::uint8_t>(Instruction::kStatus));
  const std::size_t head = answer.size();
  std::int64_t delay_ns = 0;
  for (const std::uint8_t id : ids) {
    const BusDevice* device = find(id);
    if (!device || device->status_return_level() < 1 || !device->knows_fast_sync_read()) break;
    Bytes data;
    const StatusError error = device->read(word(packet.parameters), count, data);
    data.resize(count);
    answer.insert(answer.end(), {error_field(*device, error), id});
    answer.insert(answer.end(), data.begin(), data.end());
    dynamixel::put_number(answer, dynamixel::crc16(answer), 2);
    delay_ns += device->return_delay_ns();
  }
  if (answer.size() > head) send(delay_ns, answer);
}

void ServoLine::sync_write(const PacketView& packet) {
  if (packet.parameters.size() < 4) return;
  const std::uint16_t address = word(packet.parameters);
  const std::size_t count = word(packet.parameters.subspan(2));
  const ByteView rest = packet.parameters.subspan(4);
  if (count == 0 || rest.size() % (count + 1) != 0) return;
  const auto list = hearing();
  for (std::size_t at = 0; at < rest.size(); at += count + 1) {
    for (BusDevice* device : list) {
      if (device->id() == rest[at]) static_cast<void>(device->write(address, rest.subspan(at + 1, count)));
    }
  }
}

void ServoLine::send(std::int64_t delay_ns, const Bytes& bytes) {
  Bytes sent = bytes;
  spoil(sent);
  free_ns_ += delay_ns + time_ns(sent.size(), baud_);
  outgoing_.push_back({free_ns_, std::move(sent)});
}

void ServoLine::spoil(Bytes& bytes) {
  if (faults.damaged_bytes > 0.0) {
    for (auto& byte : bytes) {
      if (random_.uniform() < faults.damaged_bytes) byte ^= static_cast<std::uint8_t>(1u << (random_.next() % 8));
    }
  }
  if (faults.cut_answers > 0.0 && random_.uniform() < faults.cut_answers) bytes.resize(random_.next() % bytes.size());
  if (faults.noise_answers > 0.0 && random_.uniform() < faults.noise_answers) {
    const std::size_t count = 1 + random_.next() % 12;
    for (std::size_t i = 0; i < count; ++i) bytes.insert(bytes.begin(), static_cast<std::uint8_t>(random_.next()));
  }
}

}  // namespace constrictor::servo_emulator
