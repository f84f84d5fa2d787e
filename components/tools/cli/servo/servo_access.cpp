#include "cli/servo/servo_access.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <filesystem>
#include <set>
#include <stdexcept>
#include <thread>

#include "component/data_path.hpp"
#include "configuration/configuration.hpp"
#include "dynamixel/sensor_board.hpp"
#include "serial/serial_port.hpp"

namespace constrictor::cli {
namespace {

constexpr double kSlack_s = 0.1;                               // no control loop waits for these commands
constexpr auto kBetweenOrders = std::chrono::milliseconds(5);  // noise may damage one, and not the next one

std::map<std::uint16_t, dynamixel::ServoModel> load_models() {
  std::map<std::uint16_t, dynamixel::ServoModel> models;
  for (const auto& entry : std::filesystem::directory_iterator(data_path("components/lib/dynamixel/models"))) {
    if (entry.path().extension() != ".yaml" || !Configuration::load(entry.path()).has("number")) continue;  // a table
    dynamixel::ServoModel model = dynamixel::load_servo_model(entry.path());
    const std::uint16_t number = model.number;
    models.emplace(number, std::move(model));
  }
  return models;
}

}  // namespace

std::string two_devices(std::uint8_t id) {
  return fmt::format("two devices answer with id {}: disconnect one of them, and give the other one another id", id);
}

std::string FoundServo::model_name() const {
  if (model) return model->name;
  if (number == dynamixel::sensor_board::kImuModel) return "inertial unit";
  if (number == dynamixel::sensor_board::kContactModel) return "contact sensors";
  return fmt::format("unknown model {}", number);
}

ServoAccess::ServoAccess(const std::string& port, std::uint32_t baud)
    : port_(port), models_(load_models()), bus_(std::make_unique<serial::SerialPort>(port, baud), kSlack_s) {}

FoundServo ServoAccess::describe(std::uint8_t id, const serial::Answer& answer) const {
  FoundServo found;
  found.id = id;
  if (answer.data.size() < 3) return found;
  found.number = static_cast<std::uint16_t>(dynamixel::get_number(answer.data, 2, false));
  found.firmware = answer.data[2];
  const auto known = models_.find(found.number);
  if (known != models_.end()) found.model = &known->second;
  return found;
}

std::vector<FoundServo> ServoAccess::scan() {
  std::map<std::uint8_t, FoundServo> found;
  const auto damages = [this] { return bus_.line().crc_errors + bus_.line().malformed; };
  for (int i = 0; i < kTries; ++i) {
    const std::uint64_t before = damages();
    std::map<std::uint8_t, int> answers;  // of this round
    for (const auto& [id, answer] : bus_.ping_all()) {
      FoundServo& device = found.try_emplace(id, describe(id, answer)).first->second;
      device.devices = std::max(device.devices, ++answers[id]);
    }
    if (damages() == before) break;
  }
  std::vector<FoundServo> devices;
  for (const auto& [id, device] : found) devices.push_back(device);
  return devices;
}

namespace {

void require_single(const FoundServo& device, const std::string& port) {
  if (device.devices == 1) return;
  throw std::runtime_error(fmt::format("{}: {}", port, two_devices(device.id)));
}

}  // namespace

std::vector<FoundServo> ServoAccess::single_servos() {
  std::vector<FoundServo> servos = scan();
  for (const FoundServo& device : servos) require_single(device, port_);
  std::erase_if(servos, [](const FoundServo& one) { return one.model == nullptr; });
  if (servos.empty()) throw std::runtime_error(fmt::format("no servo answers at {}", port_));
  return servos;
}

FoundServo ServoAccess::find_single(std::uint8_t id) {
  for (const FoundServo& device : scan()) {
    if (device.id == id) require_single(device, port_);
  }
  return find(id);
}

void ServoAccess::order_torque_off(std::optional<std::uint8_t> id) {
  std::set<std::uint16_t> addresses;
  for (const auto& [number, model] : models_) addresses.insert(model.at("torque_enable").address);
  const dynamixel::Bytes off = {0};
  for (int i = 0; i < kTries; ++i) {
    for (const std::uint16_t address : addresses) {
      if (id) bus_.sync_write(address, 1, dynamixel::Bytes{*id}, off);
      else bus_.write_all(address, off);
    }
    std::this_thread::sleep_for(kBetweenOrders);
  }
}

FoundServo ServoAccess::find(std::uint8_t id) {
  const serial::Answer answer = bus_.ping(id, kTries);
  if (!answer.good())
    throw std::runtime_error(
        fmt::format("servo {} at {}: {}; `constrictor servo scan --port {}` shows which servos answer", id, port_,
                    answer.text(), port_));
  FoundServo found = describe(id, answer);
  if (!found.model)
    throw std::runtime_error(
        fmt::format("device {} at {}: found {}, accepted a servo with a file in "
                    "components/lib/dynamixel/models",
                    id, port_, found.model_name()));
  return found;
}

std::int64_t ServoAccess::read(const FoundServo& servo, const std::string& name) {
  const auto& reg = servo.model->at(name);
  const serial::Answer answer = bus_.read(servo.id, reg.address, reg.bytes, kTries);
  if (!answer.good())
    throw std::runtime_error(fmt::format("servo {} at {}: cannot read {}: {}", servo.id, port_, name, answer.text()));
  return dynamixel::get_number(answer.data, reg.bytes, reg.is_signed);
}

void ServoAccess::write(const FoundServo& servo, const std::string& name, std::int64_t value) {
  dynamixel::Bytes bytes;
  dynamixel::put_value(bytes, servo.model->at(name), value);
  const serial::Answer answer = bus_.write(servo.id, servo.model->at(name).address, bytes, kTries);
  if (!answer.good())
    throw std::runtime_error(
        fmt::format("servo {} at {}: cannot write {} to {}: {}", servo.id, port_, value, name, answer.text()));
}

}  // namespace constrictor::cli
