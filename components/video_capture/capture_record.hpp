// The file camera.json in the run's output folder: the state of the camera (connection, rate, missing frames).
#pragma once

#include "component/device_record.hpp"
#include "video/live_video.hpp"

namespace constrictor {

/// The durations are the ages that the frames had when they were published.
class CaptureRecord : public DeviceRecord {
 public:
  explicit CaptureRecord(const std::filesystem::path& folder) : DeviceRecord(folder, "camera.json", "age") {}

  void write(std::int64_t tick, std::uint64_t published, std::uint64_t late, const video::LiveCounters& counters);
};

}  // namespace constrictor
