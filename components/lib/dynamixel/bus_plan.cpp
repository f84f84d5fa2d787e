#include "dynamixel/bus_plan.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <set>

#include "configuration/configuration.hpp"

namespace constrictor::dynamixel {
namespace {

constexpr std::int64_t kMostJoints = 64;
constexpr double kLeastBaud = 9600.0;
constexpr double kMostBaud = 4'500'000.0;

JointServo read_joint(Configuration& row, const JointServo& usual, std::size_t ports, bool needs_id) {
  JointServo servo;
  servo.port = static_cast<std::size_t>(
      row.integer("port", 0, static_cast<std::int64_t>(ports) - 1, static_cast<std::int64_t>(usual.port)));
  if (needs_id) servo.id = static_cast<std::uint8_t>(row.integer("id", 0, kLargestId));
  servo.direction = static_cast<int>(row.integer("direction", -1, 1, usual.direction));
  if (servo.direction == 0) throw row.error("direction", "found 0, accepted 1 or -1");
  servo.gear = row.number("gear", {0.01, 1000.0}, usual.gear);
  servo.zero_steps = row.integer("zero_steps", -1'000'000, 1'000'000, usual.zero_steps);
  servo.torque_constant_nm_a = row.number("torque_constant_nm_a", {0.001, 1000.0}, usual.torque_constant_nm_a);
  return servo;
}

/// Adds the id of a device at a port, which must be free.
void claim(std::vector<std::set<int>>& used, Configuration& row, const std::string& key, std::size_t port, int id) {
  if (!used[port].insert(id).second)
    throw row.error(key, fmt::format("found id {} twice at port {}, accepted each id once: two devices with one id "
                                     "answer at the same time, and neither is understood",
                                     id, port));
}

std::vector<BusPort> read_ports(Configuration& root) {
  std::vector<BusPort> ports;
  for (Configuration& row : root.list("ports")) {
    BusPort port{row.text("device"), 0};
    port.baud = static_cast<std::uint32_t>(row.number("baud", {kLeastBaud, kMostBaud}));
    if (std::find(std::begin(kBaudRates), std::end(kBaudRates), port.baud) == std::end(kBaudRates))
      throw row.error("baud", fmt::format("found {}, accepted one of {}", port.baud, fmt::join(kBaudRates, ", ")));
    row.finish();
    if (std::any_of(ports.begin(), ports.end(), [&](const BusPort& other) { return other.device == port.device; }))
      throw row.error("device", fmt::format("found {} twice, accepted each device once", port.device));
    ports.push_back(port);
  }
  if (ports.empty()) throw root.error("ports", "found none, accepted at least one serial port");
  return ports;
}

void read_boards(Configuration& root, BusPlan& plan, std::vector<std::set<int>>& used) {
  const auto last_port = static_cast<std::int64_t>(plan.ports.size()) - 1;
  if (root.has("imu")) {
    Configuration imu = root.section("imu");
    plan.imu = SensorBoard{static_cast<std::size_t>(imu.integer("port", 0, last_port, 0)),
                           static_cast<std::uint8_t>(imu.integer("id", 0, kLargestId))};
    imu.finish();
    claim(used, imu, "id", plan.imu->port, plan.imu->id);
  }
  if (!root.has("contacts")) return;
  Configuration contacts = root.section("contacts");
  const auto port = static_cast<std::size_t>(contacts.integer("port", 0, last_port, 0));
  const std::size_t modules = plan.joints.size() + 1;
  for (const double id : contacts.numbers("ids", {0.0, kLargestId}, modules, modules)) {
    if (id != std::floor(id)) throw contacts.error("ids", fmt::format("found {}, accepted whole numbers", id));
    plan.contact_boards.push_back({port, static_cast<std::uint8_t>(id)});
    claim(used, contacts, "ids", port, plan.contact_boards.back().id);
  }
  contacts.finish();
}

}  // namespace

std::int64_t JointServo::steps(const ServoModel& model, double angle_rad) const {
  return zero_steps + std::llround(angle_rad * steps_per_rad(model));
}

std::int64_t JointServo::current_units(const ServoModel& model, double torque_nm, std::int64_t limit) const {
  const double units = std::abs(torque_nm / nm_per_unit(model));
  return std::llround(std::min(units, static_cast<double>(limit)));
}

Bytes BusPlan::servo_ids(std::size_t port) const {
  Bytes ids;
  for (const JointServo& joint : joints) {
    if (joint.port == port) ids.push_back(joint.id);
  }
  return ids;
}

BusPlan load_bus_plan(const std::filesystem::path& file, const std::filesystem::path& models_folder) {
  Configuration root = Configuration::load(file);
  BusPlan plan;
  plan.ports = read_ports(root);
  Configuration usual_row = root.section("servo");
  plan.model = load_servo_model(models_folder / (usual_row.text("model") + ".yaml"));
  JointServo usual;
  usual.torque_constant_nm_a = plan.model.torque_constant_nm_a();
  usual = read_joint(usual_row, usual, plan.ports.size(), false);
  usual_row.finish();
  std::vector<std::set<int>> used(plan.ports.size());
  for (Configuration& row : root.list("joints")) {
    plan.joints.push_back(read_joint(row, usual, plan.ports.size(), true));
    row.finish();
    claim(used, row, "id", plan.joints.back().port, plan.joints.back().id);
  }
  if (plan.joints.empty() || plan.joints.size() > kMostJoints)
    throw root.error("joints", fmt::format("found {}, accepted 1 to {} joints", plan.joints.size(), kMostJoints));
  read_boards(root, plan, used);
  if (root.has("fast_sync_read")) plan.fast_sync_read = root.flag("fast_sync_read", true);
  root.finish();
  return plan;
}

}  // namespace constrictor::dynamixel
