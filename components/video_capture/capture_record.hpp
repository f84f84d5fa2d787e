// The file camera.json in the run's output folder: how the camera is, for people and tools.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "video/live_video.hpp"

namespace constrictor {

class CaptureRecord {
 public:
  /// `folder`: empty: no file is written.
  explicit CaptureRecord(const std::filesystem::path& folder);

  /// Adds the age that a frame had when it was published.
  void add_age(std::int64_t age_ns) { ages_ns_.push_back(age_ns); }
  void add_news(const std::string& line);
  /// Replaces the file, so that a reader sees either the old or the new one. A full disk is no reason to stop the
  /// robot: the file is then left out.
  void write(std::int64_t tick, std::uint64_t published, std::uint64_t late, const video::LiveCounters& counters);

 private:
  std::filesystem::path file_;
  std::vector<std::int64_t> ages_ns_;  ///< since the last write()
  std::vector<std::string> news_;      ///< the newest ones
};

}  // namespace constrictor
