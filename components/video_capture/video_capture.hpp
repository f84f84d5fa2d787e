// The component `camera` of a real robot: publishes the images of a camera, of a stream or of files.
#pragma once

#include <cstdint>
#include <memory>

#include "component/component.hpp"
#include "component/device_owner.hpp"
#include "log/news_log.hpp"
#include "robot/robot_model.hpp"
#include "video/live_video.hpp"
#include "video/picture_files.hpp"
#include "video/rectifier.hpp"
#include "video_capture/capture_record.hpp"
#include "video_capture/video_capture_config.hpp"

namespace constrictor {

struct VideoCaptureState {
  std::uint64_t published = 0;  ///< images
  std::uint64_t late = 0;       ///< frames that were too old to be published
  std::int64_t shown = -1;      ///< of a file: number of the last picture
  template <class Archive>
  void serialize(Archive& archive) {
    archive(published, late, shown);
  }
};

/// Publishes the newest frame at each tick at which there is a new one, and never waits for one. An image carries the
/// tick of its exposure, so that readers know how old it is. Pictures of files are published at the times of the run:
/// a run with them is repeatable, bit for bit.
class VideoCapture : public ConfiguredComponent<VideoCaptureState, VideoCaptureConfig>, public DeviceOwner {
 public:
  /// Reads the configuration and the files; opens no camera before the first step. Throws ConfigurationError. `open`:
  /// replaces OpenCV in tests.
  VideoCapture(Wiring& wiring, const Setup& setup, video::OpenVideo open = nullptr);
  void step(const Tick& tick) override;
  [[nodiscard]] std::string device_status() const override { return record_.summary(); }

 private:
  void step_live(const Tick& tick);
  void step_file(const Tick& tick);
  void publish(const Tick& tick, const cv::Mat& bgr, std::int64_t exposure_tick);
  /// Adds news to camera.json and to the log. The log gets a bounded number of lines.
  void report(const Tick& tick, const video::News& news);

  video::VideoSource source_;
  video::Rectifier rectifier_;
  video::OpenVideo open_;
  std::unique_ptr<video::LiveVideo> live_;      ///< from the first step
  std::unique_ptr<video::PictureFiles> files_;  ///< null: the source is live
  CaptureRecord record_;
  bool was_late_ = false;  ///< the last frame was too old
  NewsLog news_log_;
  std::string last_misfit_;  ///< why the last frame was not an image of this camera; empty: it was one
  Output<msg::CameraInfo> info_ = wiring_.output(topics::kCameraInfo);
  Output<msg::CameraImage> image_ = wiring_.output(topics::kCameraImage);
};

/// The component has the name `camera`: it takes the place of the simulated one.
ComponentFactory make_video_capture_factory(video::OpenVideo open = nullptr);

}  // namespace constrictor
