#include "servo_bus/bus_record.hpp"

#include <algorithm>
#include <fstream>
#include <nlohmann/json.hpp>

namespace constrictor {
namespace {

constexpr std::size_t kMostNews = 50;

/// [ms] the value below which `share` of the sorted durations are.
double quantile_ms(const std::vector<std::int64_t>& sorted, double share) {
  const auto index = static_cast<std::size_t>(share * static_cast<double>(sorted.size() - 1));
  return static_cast<double>(sorted[index]) * 1e-6;
}

const char* text_of(ServoState state) {
  return state == ServoState::kReady ? "ready" : state == ServoState::kLost ? "lost" : "shut down";
}

}  // namespace

BusRecord::BusRecord(const std::filesystem::path& folder) {
  if (!folder.empty()) file_ = folder / "servo_bus.json";
}

void BusRecord::add_news(const std::string& line) {
  if (news_.size() == kMostNews) news_.erase(news_.begin());
  news_.push_back(line);
}

void BusRecord::write(std::int64_t tick, const JointServos& servos, const BusPorts& ports) {
  std::vector<std::int64_t> rounds_ns = std::exchange(rounds_ns_, {});
  if (file_.empty()) return;
  nlohmann::json record = {{"tick", tick}, {"news", news_}};
  if (!rounds_ns.empty()) {
    std::sort(rounds_ns.begin(), rounds_ns.end());
    record["round_ms"] = {{"median", quantile_ms(rounds_ns, 0.5)},
                          {"p99", quantile_ms(rounds_ns, 0.99)},
                          {"longest", quantile_ms(rounds_ns, 1.0)}};
  }
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
  std::filesystem::path next = file_;
  next += ".new";
  std::ofstream stream(next, std::ios::trunc);
  stream << record.dump(1) << "\n";
  stream.close();
  std::error_code ignored;
  if (stream) std::filesystem::rename(next, file_, ignored);
}

}  // namespace constrictor
