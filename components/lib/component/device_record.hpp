// A JSON file in the run's output folder with which the driver of a device reports the device's state to people and
// tools.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

namespace constrictor {

/// The part that such files have in common: durations since the last write, and news.
class DeviceRecord {
 public:
  /// Adds a duration [ns]. The file shows the median, the 99th percentile and the longest one.
  void add_duration(std::int64_t duration_ns) { durations_ns_.push_back(duration_ns); }
  /// Adds a line. The file shows the newest ones.
  void add_news(const std::string& line);
  /// The state of the device at the last replace(), in at most 127 characters for ComponentStatus; empty before.
  [[nodiscard]] const std::string& summary() const { return summary_; }

 protected:
  /// `folder`: empty: no file is written. `durations`: what the durations are; with the ending "_ms" it is their key in
  /// the file.
  DeviceRecord(const std::filesystem::path& folder, const char* file_name, std::string durations);

  /// Replaces the file by what `make_fields` returns, with durations and news, and the summary by `state` with the
  /// durations. A reader sees either the old or the new file. A full disk is no reason to stop the robot: the file is
  /// then left out.
  void replace(std::string state, const std::function<nlohmann::json()>& make_fields);

 private:
  std::filesystem::path file_;
  std::string durations_;  ///< what they are
  std::string summary_;
  std::vector<std::int64_t> durations_ns_;  ///< since the last replace()
  std::vector<std::string> news_;           ///< the newest ones
};

}  // namespace constrictor
