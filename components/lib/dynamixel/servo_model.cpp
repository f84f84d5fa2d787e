#include "dynamixel/servo_model.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <stdexcept>

#include "configuration/configuration.hpp"

namespace constrictor::dynamixel {
namespace {

constexpr std::int64_t kLargestAddress = 1023;

/// The numbers that a register of this size can hold.
std::pair<std::int64_t, std::int64_t> numbers_of(const Register& reg) {
  const std::int64_t count = std::int64_t{1} << (8 * reg.bytes);
  if (reg.is_signed) return {-count / 2, count / 2 - 1};
  return {0, count - 1};
}

void read_limits(Configuration& row, Register& reg) {
  const auto [least, most] = numbers_of(reg);
  reg.min = row.integer("min", least, most, reg.min);
  reg.max = row.integer("max", reg.min, most, reg.max);
  reg.initial = row.integer("initial", least, most, reg.initial);
  if (reg.writable && (reg.initial < reg.min || reg.initial > reg.max))
    throw row.error("initial", fmt::format("found {}, accepted {} to {}", reg.initial, reg.min, reg.max));
}

Register read_register(Configuration& row) {
  Register reg;
  reg.name = row.text("name");
  reg.address = static_cast<std::uint16_t>(row.integer("address", 0, kLargestAddress));
  reg.bytes = static_cast<std::uint8_t>(row.integer("bytes", 1, 4));
  if (reg.bytes == 3) throw row.error("bytes", "found 3, accepted 1, 2 or 4");
  reg.writable = row.text("access", {"read", "write"}) == "write";
  reg.is_signed = row.flag("signed", false);
  std::tie(reg.min, reg.max) = numbers_of(reg);
  read_limits(row, reg);
  row.finish();
  return reg;
}

std::vector<Register> read_table(const std::filesystem::path& file) {
  Configuration root = Configuration::load(file);
  std::vector<Register> registers;
  for (Configuration& row : root.list("registers")) {
    registers.push_back(read_register(row));
    if (registers.size() < 2) continue;
    const Register& before = registers[registers.size() - 2];
    if (registers.back().address < before.address + before.bytes)
      throw row.error("address", fmt::format("found {}, accepted {} or more: registers are listed by rising address "
                                             "and do not overlap",
                                             registers.back().address, before.address + before.bytes));
  }
  root.finish();
  if (registers.empty()) throw root.error("registers", "found none, accepted at least one register");
  return registers;
}

}  // namespace

std::string hardware_error_text(std::uint8_t bits) {
  static constexpr std::pair<std::uint8_t, const char*> kTexts[] = {
      {hardware_error::kInputVoltage, "input voltage"},
      {hardware_error::kOverheating, "overheating"},
      {hardware_error::kEncoder, "motor encoder"},
      {hardware_error::kElectricalShock, "electrical shock or too little power"},
      {hardware_error::kOverload, "overload"}};
  std::string text;
  for (const auto& [bit, words] : kTexts) {
    if ((bits & bit) != 0) text += (text.empty() ? "" : ", ") + std::string(words);
  }
  return text.empty() ? "none" : text;
}

const Register& ServoModel::at(std::string_view wanted) const {
  const auto found =
      std::find_if(registers.begin(), registers.end(), [&](const Register& reg) { return reg.name == wanted; });
  if (found == registers.end()) throw std::out_of_range(fmt::format("servo {} has no register {}", name, wanted));
  return *found;
}

const Register* ServoModel::containing(std::uint16_t address) const {
  const auto after = std::upper_bound(registers.begin(), registers.end(), address,
                                      [](std::uint16_t at, const Register& reg) { return at < reg.address; });
  if (after == registers.begin()) return nullptr;
  const Register& reg = *std::prev(after);
  return address < reg.address + reg.bytes ? &reg : nullptr;
}

std::uint16_t ServoModel::end() const {
  return static_cast<std::uint16_t>(registers.back().address + registers.back().bytes);
}

void put_value(Bytes& to, const Register& reg, std::int64_t value) { put_number(to, value, reg.bytes); }

ServoModel load_servo_model(const std::filesystem::path& file) {
  Configuration root = Configuration::load(file);
  ServoModel model;
  model.name = root.text("name");
  model.number = static_cast<std::uint16_t>(root.integer("number", 0, 65535));
  model.steps_per_turn = root.number("steps_per_turn", {2.0, 1e6});
  model.current_unit_a = root.number("current_unit_a", {1e-6, 1.0});
  model.velocity_unit_rad_s = root.number("velocity_unit_rad_s", {1e-6, 1.0});
  model.voltage_unit_v = root.number("voltage_unit_v", {1e-6, 1.0});
  model.stall_torque_nm = root.number("stall_torque_nm", {0.01, 1000.0});
  model.stall_current_a = root.number("stall_current_a", {0.01, 1000.0});
  model.no_load_speed_rad_s = root.number("no_load_speed_rad_s", {0.01, 100.0});
  model.fast_sync_read_from = static_cast<int>(root.integer("fast_sync_read_from", 0, 255, model.fast_sync_read_from));
  model.registers = read_table(file.parent_path() / (root.text("table") + ".yaml"));
  for (Configuration& row : root.list("limits", false)) {
    const std::string name = row.text("register");
    const auto found = std::find_if(model.registers.begin(), model.registers.end(),
                                    [&](const Register& reg) { return reg.name == name; });
    if (found == model.registers.end())
      throw row.error("register", fmt::format("found {}, accepted a register of the table", name));
    read_limits(row, *found);
    row.finish();
  }
  root.finish();
  for (Register& reg : model.registers) {
    if (reg.name == "model_number") reg.initial = model.number;
  }
  for (const char* needed : {"model_number",        "id",
                             "baud_rate",           "return_delay_time",
                             "drive_mode",          "operating_mode",
                             "current_limit",       "torque_enable",
                             "status_return_level", "hardware_error_status",
                             "bus_watchdog",        "goal_current",
                             "goal_position",       "profile_velocity",
                             "present_current",     "present_velocity",
                             "present_position",    "present_input_voltage",
                             "present_temperature", "indirect_address_1",
                             "indirect_data_1"}) {
    if (std::none_of(model.registers.begin(), model.registers.end(),
                     [&](const Register& reg) { return reg.name == needed; }))
      throw root.error("table", fmt::format("found no register {}, accepted a table that has it", needed));
  }
  return model;
}

}  // namespace constrictor::dynamixel
