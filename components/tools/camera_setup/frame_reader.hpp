// Pictures one after the other, from a live source or from files.
#pragma once

#include <chrono>
#include <functional>
#include <memory>
#include <opencv2/core.hpp>
#include <optional>

#include "video/live_video.hpp"
#include "video/picture_files.hpp"

namespace constrictor::camera_setup {

class FrameReader {
 public:
  /// Throws VideoError if files cannot be read. A live source is opened in the background.
  FrameReader(const video::VideoSource& source, const video::DeviceRequest& request);

  [[nodiscard]] bool live() const { return live_ != nullptr; }
  /// The next picture, BGR; of a live source the newest one that was not given yet. Waits for it, at most `bound` or
  /// until `stop` returns true. Empty: there is none.
  [[nodiscard]] std::optional<cv::Mat> next(std::chrono::milliseconds bound, const std::function<bool()>& stop);
  /// The events of a live source since the last call.
  [[nodiscard]] std::vector<video::News> news() { return live_ ? live_->take_news() : std::vector<video::News>{}; }
  [[nodiscard]] video::LiveCounters counters() const { return live_ ? live_->counters() : video::LiveCounters{}; }

 private:
  std::unique_ptr<video::LiveVideo> live_;
  std::unique_ptr<video::PictureFiles> files_;
  std::int64_t index_ = 0;
};

}  // namespace constrictor::camera_setup
