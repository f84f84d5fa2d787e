// The serial ports of the robot: they may disappear and come back while the robot runs.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "dynamixel/bus_plan.hpp"
#include "serial/bus_master.hpp"

namespace constrictor {

/// Opens a port. Throws serial::PortError.
using OpenPort = std::function<std::unique_ptr<serial::Port>(const dynamixel::BusPort& port)>;

class BusPorts {
 public:
  BusPorts(std::vector<dynamixel::BusPort> ports, double answer_slack_s, OpenPort open);

  /// Opens all ports. Throws serial::PortError.
  void open_all();
  [[nodiscard]] std::size_t size() const { return ports_.size(); }
  [[nodiscard]] const dynamixel::BusPort& port(std::size_t index) const { return ports_[index]; }
  [[nodiscard]] bool is_open(std::size_t index) const { return masters_[index] != nullptr; }
  /// Tries to open a port that is gone, at most at every 25th call. Returns whether it is open now.
  bool reopen(std::size_t index);
  /// Calls `use(BusMaster&)` if the port is open. If the port disappears meanwhile, closes it, and notes the reason in
  /// `news`.
  template <class Use>
  void with(std::size_t index, std::vector<std::string>& news, Use&& use) {
    if (!masters_[index]) return;
    try {
      use(*masters_[index]);
    } catch (const serial::PortError& error) {
      news.emplace_back(error.what());
      close(index);
    }
  }
  /// [ns] on the clock of the ports; 0 if none is open.
  [[nodiscard]] std::int64_t now_ns() const;
  /// The counts of a port since the start, also of its earlier openings.
  struct Counters : serial::BusCounters {
    std::uint64_t crc_errors = 0;
    std::uint64_t malformed = 0;
    std::uint64_t openings = 0;
  };
  [[nodiscard]] Counters counters(std::size_t index) const;

 private:
  void close(std::size_t index);
  std::vector<dynamixel::BusPort> ports_;
  double answer_slack_s_;
  OpenPort open_;
  std::vector<std::unique_ptr<serial::BusMaster>> masters_;  ///< null: closed
  std::vector<Counters> before_;                             ///< of earlier openings
  std::vector<int> waited_;                                  ///< calls of reopen() since the last attempt
};

}  // namespace constrictor
