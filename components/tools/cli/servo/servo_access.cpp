#include "cli/servo/servo_access.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <stdexcept>

#include "component/data_path.hpp"
#include "configuration/configuration.hpp"
#include "dynamixel/sensor_board.hpp"
#include "serial/serial_port.hpp"

namespace constrictor::cli {
namespace {

constexpr double kSlack_s = 0.02;  // no control loop waits for these commands

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
  std::vector<FoundServo> found;
  for (const auto& [id, answer] : bus_.ping_all()) found.push_back(describe(id, answer));
  std::sort(found.begin(), found.end(), [](const auto& a, const auto& b) { return a.id < b.id; });
  return found;
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
