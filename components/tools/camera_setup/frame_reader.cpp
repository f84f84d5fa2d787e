#include "camera_setup/frame_reader.hpp"

#include <thread>

namespace constrictor::camera_setup {
namespace {

using namespace std::chrono_literals;
constexpr auto kPoll = 5ms;

}  // namespace

FrameReader::FrameReader(const video::VideoSource& source, const video::DeviceRequest& request) {
  if (source.live()) {
    live_ = std::make_unique<video::LiveVideo>(video::opencv_video(source, request),
                                               video::LiveSettings{request.frame_rate_hz, 0.5, 2.0});
  } else {
    files_ = std::make_unique<video::PictureFiles>(source, false);
  }
}

std::optional<cv::Mat> FrameReader::next(std::chrono::milliseconds bound, const std::function<bool()>& stop) {
  if (files_) {
    const cv::Mat& picture = files_->at(index_++);
    if (picture.empty()) return {};
    return picture.clone();
  }
  for (const auto end = std::chrono::steady_clock::now() + bound; !stop();) {
    if (auto frame = live_->take()) return std::move(frame->bgr);
    if (std::chrono::steady_clock::now() >= end) return {};
    std::this_thread::sleep_for(kPoll);
  }
  return {};
}

}  // namespace constrictor::camera_setup
