// The file servo_bus.json in the run's output folder: how the buses and the servos are, for people and tools.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "servo_bus/joint_servos.hpp"

namespace constrictor {

class BusRecord {
 public:
  /// `folder`: empty: no file is written.
  explicit BusRecord(const std::filesystem::path& folder);

  /// Adds the time that a tick spent on the buses.
  void add_round(std::int64_t duration_ns) { rounds_ns_.push_back(duration_ns); }
  void add_news(const std::string& line);
  /// Replaces the file, so that a reader sees either the old or the new one. A full disk is no reason to stop the
  /// robot: the file is then left out.
  void write(std::int64_t tick, const JointServos& servos, const BusPorts& ports);

 private:
  std::filesystem::path file_;
  std::vector<std::int64_t> rounds_ns_;  ///< since the last write()
  std::vector<std::string> news_;        ///< the newest ones
};

}  // namespace constrictor
