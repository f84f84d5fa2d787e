#include "servo_bus/bus_record.hpp"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "configuration/counted.hpp"

namespace constrictor {
namespace {

const char* text_of(ServoState state) {
  return state == ServoState::kReady ? "ready" : state == ServoState::kLost ? "lost" : "shut down";
}

std::string summary_of(const JointServos& servos, const BusPorts& ports) {
  std::size_t ready = 0;
  for (std::size_t i = 0; i < servos.count(); ++i) ready += servos.state(i) == ServoState::kReady ? 1 : 0;
  BusPorts::Counters sum{};
  std::string gone;
  for (std::size_t i = 0; i < ports.size(); ++i) {
    if (!ports.is_open(i))
      gone += fmt::format("port {} is gone, ", std::filesystem::path(ports.port(i).device).filename().string());
    const BusPorts::Counters counts = ports.counters(i);
    sum.timeouts += counts.timeouts;
    sum.retries += counts.retries;
    sum.crc_errors += counts.crc_errors;
  }
  return fmt::format("{}{} of {} ready, {}, {}, {}", gone, ready, counted(servos.count(), "servo"),
                     counted(sum.timeouts, "timeout"), counted(sum.retries, "retry", "retries"),
                     counted(sum.crc_errors, "CRC error"));
}

}  // namespace

void BusRecord::write(std::int64_t tick, const JointServos& servos, const BusPorts& ports) {
  replace(summary_of(servos, ports), [&] {
    nlohmann::json record = {{"tick", tick}};
    for (std::size_t i = 0; i < ports.size(); ++i) {
      const BusPorts::Counters counts = ports.counters(i);
      record["ports"].push_back({{"device", ports.port(i).device},
                                 {"open", ports.is_open(i)},
                                 {"openings", counts.openings},
                                 {"questions", counts.questions},
                                 {"timeouts", counts.timeouts},
                                 {"retries", counts.retries},
                                 {"crc_errors", counts.crc_errors},
                                 {"malformed", counts.malformed},
                                 {"late_bytes", counts.late_bytes},
                                 {"bytes_sent", counts.bytes_sent},
                                 {"bytes_received", counts.bytes_received}});
    }
    for (std::size_t i = 0; i < servos.count(); ++i) {
      const JointReading& reading = servos.reading(i);
      record["joints"].push_back({{"state", text_of(servos.state(i))},
                                  {"angle_rad", reading.angle_rad},
                                  {"torque_nm", reading.torque_nm},
                                  {"torque_on", reading.torque_on},
                                  {"temperature_c", reading.temperature_c},
                                  {"voltage_v", reading.voltage_v},
                                  {"hardware_errors", reading.hardware_errors},
                                  {"watchdog", reading.watchdog}});
    }
    return record;
  });
}

}  // namespace constrictor
