// A live source of pictures, read with OpenCV's VideoCapture.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <opencv2/core.hpp>
#include <optional>
#include <string>
#include <vector>

#include "video/video_source.hpp"

namespace constrictor::video {

/// The settings that are requested from a device. A device that does not accept one is used anyway; its news contain
/// the setting.
struct DeviceRequest {
  int width = 0, height = 0;  ///< [pixel] 0: the default of the device
  double frame_rate_hz = 30.0;
  double timeout_s = 1.0;  ///< for opening and for each frame
  bool lock_exposure = true;
  double exposure_ms = 0.0;  ///< 0: the value that the automatic control has found
  bool lock_white_balance = true;
  double white_balance_k = 0.0;  ///< [K] 0: the value that the automatic control has found
  bool lock_focus = true;
};

/// An open source. One thread uses it.
class VideoInput {
 public:
  virtual ~VideoInput() = default;
  /// Waits for the next frame, BGR with 8 bit for each channel. Returns false if the source has ended, has failed, or
  /// is silent for the time that was asked for.
  virtual bool read(cv::Mat& bgr) = 0;
  /// [ns of CLOCK_MONOTONIC] when the driver received the last frame; empty: the source does not know.
  [[nodiscard]] virtual std::optional<std::int64_t> stamp_ns() const { return {}; }
  /// One line for people, for example "http://10.0.0.7/stream: 640 x 480, FFMPEG".
  [[nodiscard]] virtual std::string description() const = 0;
  /// The settings that the device did not accept, one line each.
  [[nodiscard]] virtual std::vector<std::string> remarks() const { return {}; }
};

/// Opens a source; throws VideoError. It is called again each time when the source has ended.
using OpenVideo = std::function<std::unique_ptr<VideoInput>()>;

/// Opens `source` with OpenCV. The source must be live().
[[nodiscard]] OpenVideo opencv_video(const VideoSource& source, const DeviceRequest& request);

}  // namespace constrictor::video
