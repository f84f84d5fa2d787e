#include "video_capture/video_capture.hpp"

#include <fmt/format.h>

#include <cmath>
#include <stdexcept>
#include <utility>

#include "component/data_path.hpp"
#include "component/default_robot.hpp"
#include "configuration/configuration.hpp"
#include "robot/pose_message.hpp"

namespace constrictor {
namespace {

constexpr std::int64_t kRecordEvery_ticks = 50;
constexpr int kMostLogLines = 10;  // in a window of NewsLog: a camera may come and go all the time

video::VideoSource source_of(const VideoCaptureConfig& config, const Setup& setup) {
  try {
    return video::parse_source(config.source, data_path("."), setup.output_dir);
  } catch (const video::VideoError& error) {
    throw ConfigurationError(error.what());
  }
}

video::Rectifier rectifier_of(const VideoCaptureConfig& config, const Setup& setup) {
  const auto file = robot_file_of(setup);
  const auto robot = load_robot(file);
  if (!robot.further_cameras.empty()) {
    throw ConfigurationError(fmt::format(
        "{}: further_cameras: found a list of {}, accepted none: video_capture reads one camera, that of the head; the "
        "others would write no images",
        file.string(), robot.further_cameras.size()));
  }
  const auto calibration = config.calibration == "none"
                               ? video::calibration_of(robot.camera)
                               : video::load_calibration(data_path(config.calibration), robot.camera);
  try {
    return {calibration, config.image_width, config.image_height};
  } catch (const std::invalid_argument& error) {
    throw ConfigurationError(fmt::format("image: {}", error.what()));
  }
}

video::DeviceRequest request_of(const VideoCaptureConfig& config) {
  return {config.stream_width,       config.stream_height,   config.frame_rate_hz,
          config.timeout_s,          config.lock_exposure,   config.exposure_ms,
          config.lock_white_balance, config.white_balance_k, config.lock_focus};
}

}  // namespace

VideoCapture::VideoCapture(Wiring& wiring, const Setup& setup, video::OpenVideo open)
    : ConfiguredComponent(wiring, setup),
      source_(open ? video::VideoSource{video::SourceKind::kNetwork, "test://", {}} : source_of(config_, setup)),
      rectifier_(rectifier_of(config_, setup)),
      open_(std::move(open)),
      record_(setup.output_dir),
      news_log_(setup.log, kMostLogLines, "more lines on the camera were left out; see camera.json") {
  if (source_.live()) return;
  try {
    files_ = std::make_unique<video::PictureFiles>(source_, config_.repeat);
    static_cast<void>(rectifier_.rectify(files_->at(0)));
  } catch (const std::exception& error) {
    throw ConfigurationError(fmt::format("source: {}", error.what()));
  }
}

void VideoCapture::report(const Tick& tick, const video::News& news) {
  record_.add_news(news.text);
  news_log_.at(tick.index);
  news_log_.write(news.text, news.is_good);
}

void VideoCapture::publish(const Tick& tick, const cv::Mat& bgr, std::int64_t exposure_tick) {
  const cv::Mat* rgb = nullptr;
  std::string misfit;
  try {
    rgb = &rectifier_.rectify(bgr);
  } catch (const std::invalid_argument& error) {
    misfit = error.what();
  }
  if (misfit != last_misfit_) {
    if (misfit.empty()) {
      report(tick, {"camera/image: frames have a size that is accepted again", true});
    } else {
      wiring_.count_refusal("camera/image: " + misfit);
      report(tick, {"camera/image: " + misfit, false});
    }
  }
  last_misfit_ = misfit;
  if (rgb == nullptr) return;
  if (state_.published == 0) {
    const video::CameraCalibration& model = rectifier_.model();
    msg::CameraInfo info{};
    info.width = static_cast<std::uint16_t>(model.width);
    info.height = static_cast<std::uint16_t>(model.height);
    info.fx = model.fx;
    info.fy = model.fy;
    info.cx = model.cx;
    info.cy = model.cy;
    info.X_HC = pose_message(model.X_HC);
    info.frame_period_s = std::max(1.0 / config_.frame_rate_hz, tick.period_s());
    info_.write(info);
  }
  msg::CameraImage image{};
  image.width = static_cast<std::uint16_t>(rgb->cols);
  image.height = static_cast<std::uint16_t>(rgb->rows);
  image.exposure_tick = exposure_tick;
  image.data._buffer = rgb->data;
  image.data._length = image.data._maximum = static_cast<std::uint32_t>(rgb->total() * rgb->elemSize());
  image_.write(image);
  ++state_.published;
}

void VideoCapture::step_file(const Tick& tick) {
  const auto number = static_cast<std::int64_t>(std::floor(tick.time_s() * config_.frame_rate_hz + 1e-9));
  if (number == state_.shown) return;
  state_.shown = number;
  try {
    const cv::Mat& bgr = files_->at(number);
    if (!bgr.empty()) publish(tick, bgr, tick.index);
  } catch (const video::VideoError& error) {
    wiring_.count_refusal(error.what());
    report(tick, {error.what(), false});
  }
}

void VideoCapture::step_live(const Tick& tick) {
  if (!live_) {
    if (!open_) open_ = video::opencv_video(source_, request_of(config_));
    live_ = std::make_unique<video::LiveVideo>(
        open_, video::LiveSettings{config_.frame_rate_hz, config_.retry_s, config_.gone_after_s});
  }
  const auto frame = live_->take();
  for (const auto& news : live_->take_news()) report(tick, news);
  if (frame) {
    const double age_s = static_cast<double>(frame->age_ns) * 1e-9 + config_.delay_s;
    if (age_s > config_.late_after_s) {
      ++state_.late;
      const std::string reason =
          fmt::format("camera/image: found a frame of {:.2f} s ago, accepted at most {:.2f} s (stream.late_after_s)",
                      age_s, config_.late_after_s);
      wiring_.count_refusal(reason);
      if (!std::exchange(was_late_, true)) report(tick, {reason, false});
    } else {
      if (std::exchange(was_late_, false)) report(tick, {"camera/image: frames arrive in time again", true});
      record_.add_duration(frame->age_ns);
      publish(tick, frame->bgr, std::max<std::int64_t>(0, tick.index - std::llround(age_s / tick.period_s())));
    }
  }
  if (tick.index % kRecordEvery_ticks < tick.elapsed)
    record_.write(tick.index, state_.published, state_.late, live_->counters());
}

void VideoCapture::step(const Tick& tick) {
  if (files_) step_file(tick);
  else step_live(tick);
}

ComponentFactory make_video_capture_factory(video::OpenVideo open) {
  return {"camera",
          [open = std::move(open)](Wiring& wiring, const Setup& setup) {
            return std::make_unique<VideoCapture>(wiring, setup, open);
          },
          "components/video_capture/video_capture.yaml", describe_parameters<VideoCaptureConfig>};
}

}  // namespace constrictor
