// The serial ports of the robot: they may disappear and come back while the robot runs.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "dynamixel/bus_plan.hpp"
#include "serial/bus_master.hpp"
#include "servo_bus/bus_news.hpp"

namespace constrictor {

/// Opens a port; waits for at most `patience_s` until it is there. Throws serial::PortError.
using OpenPort = std::function<std::unique_ptr<serial::Port>(const dynamixel::BusPort& port, double patience_s)>;

class BusPorts {
 public:
  BusPorts(std::vector<dynamixel::BusPort> ports, double answer_slack_s, OpenPort open);

  /// Opens all ports, and waits for each for at most `patience_s`. Throws serial::PortError.
  void open_all(double patience_s);
  /// Opens the ports that are there now, and waits for none. Notes in `news` which ports are not.
  void open_present(std::vector<BusNews>& news);
  [[nodiscard]] std::size_t size() const { return ports_.size(); }
  [[nodiscard]] const dynamixel::BusPort& port(std::size_t index) const { return ports_[index]; }
  [[nodiscard]] bool is_open(std::size_t index) const { return masters_[index] != nullptr; }
  /// Tries to open a port that is gone, at most at every 25th call, and never waits for it: a tick must not, because
  /// the watchdogs of the devices at the other ports run. Returns whether it is open now. Notes in `news` when it is
  /// back.
  bool reopen(std::size_t index, std::vector<BusNews>& news);
  /// Calls `use(BusMaster&)` if the port is open. If the port disappears meanwhile, closes it, and notes the reason in
  /// `news`.
  template <class Use>
  void with(std::size_t index, std::vector<BusNews>& news, Use&& use) {
    if (!masters_[index]) return;
    try {
      use(*masters_[index]);
    } catch (const serial::PortError& error) {
      news.push_back({error.what()});
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
  void open(std::size_t index, double patience_s);
  void close(std::size_t index);
  std::vector<dynamixel::BusPort> ports_;
  double answer_slack_s_;
  OpenPort open_;
  std::vector<std::unique_ptr<serial::BusMaster>> masters_;  ///< null: closed
  std::vector<Counters> before_;                             ///< of earlier openings
  std::vector<int> waited_;                                  ///< calls of reopen() since the last attempt
};

}  // namespace constrictor
