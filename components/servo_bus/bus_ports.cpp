#include "servo_bus/bus_ports.hpp"

#include <fmt/format.h>

#include <utility>

namespace constrictor {
namespace {

constexpr int kReopenEvery = 25;

}  // namespace

BusPorts::BusPorts(std::vector<dynamixel::BusPort> ports, double answer_slack_s, OpenPort open)
    : ports_(std::move(ports)),
      answer_slack_s_(answer_slack_s),
      open_(std::move(open)),
      masters_(ports_.size()),
      before_(ports_.size()),
      waited_(ports_.size()) {}

void BusPorts::open(std::size_t index, double patience_s) {
  masters_[index] = std::make_unique<serial::BusMaster>(open_(ports_[index], patience_s), answer_slack_s_);
  ++before_[index].openings;
}

void BusPorts::open_all(double patience_s) {
  for (std::size_t i = 0; i < ports_.size(); ++i) open(i, patience_s);
}

void BusPorts::open_present(std::vector<BusNews>& news) {
  for (std::size_t i = 0; i < ports_.size(); ++i) {
    try {
      open(i, 0.0);
    } catch (const serial::PortError& error) {
      news.push_back({error.what()});
    }
  }
}

bool BusPorts::reopen(std::size_t index, std::vector<BusNews>& news) {
  if (masters_[index]) return true;
  if (++waited_[index] % kReopenEvery != 0) return false;
  try {
    open(index, 0.0);
  } catch (const serial::PortError&) {
    return false;  // the reason is known since the port was closed
  }
  masters_[index]->set_return_delay(0.0);  // the devices were set to it before the first tick
  news.push_back({fmt::format("port {} is back", ports_[index].device), true});
  return true;
}

void BusPorts::close(std::size_t index) {
  before_[index] = counters(index);
  masters_[index].reset();
  waited_[index] = 0;
}

std::int64_t BusPorts::now_ns() const {
  for (const auto& master : masters_) {
    if (master) return master->port().now_ns();
  }
  return 0;
}

BusPorts::Counters BusPorts::counters(std::size_t index) const {
  Counters sum = before_[index];
  if (!masters_[index]) return sum;
  const serial::BusCounters& now = masters_[index]->counters();
  const auto& line = masters_[index]->line();
  sum.questions += now.questions;
  sum.timeouts += now.timeouts;
  sum.retries += now.retries;
  sum.late_bytes += now.late_bytes;
  sum.bytes_sent += now.bytes_sent;
  sum.bytes_received += now.bytes_received;
  sum.crc_errors += line.crc_errors;
  sum.malformed += line.malformed;
  return sum;
}

}  // namespace constrictor
