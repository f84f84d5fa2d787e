// Reads a live source in a thread of its own, and opens it again when it fails.
#pragma once

#include <cstdint>
#include <memory>
#include <opencv2/core.hpp>
#include <optional>
#include <string>
#include <vector>

#include "video/frame_check.hpp"
#include "video/video_device.hpp"

namespace constrictor::video {

struct LiveSettings {
  double frame_rate_hz = 30.0;
  double retry_s = 0.5;       ///< pause before the source is opened again
  double gone_after_s = 1.0;  ///< without a frame
};

struct LiveCounters {
  std::uint64_t frames = 0;     ///< that were read
  std::uint64_t stale = 0;      ///< read, but discarded: they had waited in a buffer
  std::uint64_t overtaken = 0;  ///< a newer frame arrived before they were taken
  std::uint64_t missing = 0;    ///< that the source left out
  std::uint64_t openings = 0;   ///< successful ones
  std::uint64_t failures = 0;   ///< attempts to open that failed
  bool connected = false, frozen = false, black = false;
  double rate_hz = 0.0;     ///< as it is measured
  std::string description;  ///< of the open source
};

struct LiveFrame {
  cv::Mat bgr;
  std::int64_t age_ns = 0;  ///< since it was sent, or since the driver received it
};

/// The newest frame of a source. The functions never wait for the source.
class LiveVideo {
 public:
  LiveVideo(OpenVideo open, const LiveSettings& settings);
  /// Waits for the thread, at most 1.5 s. A thread that still waits for its source then is left behind, and ends with
  /// the process.
  ~LiveVideo();
  LiveVideo(const LiveVideo&) = delete;
  LiveVideo& operator=(const LiveVideo&) = delete;

  /// The newest fresh frame, once.
  [[nodiscard]] std::optional<LiveFrame> take();
  [[nodiscard]] LiveCounters counters() const;
  /// The events since the last call, the oldest first; at most kMostNews.
  [[nodiscard]] std::vector<News> take_news();
  /// [ns] since some fixed point.
  [[nodiscard]] std::int64_t now_ns() const;

  static constexpr std::size_t kMostNews = 50;

 private:
  struct Shared;
  std::shared_ptr<Shared> shared_;
};

}  // namespace constrictor::video
