#include "video/video_device.hpp"

#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <chrono>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <opencv2/core/utils/logger.hpp>
#include <opencv2/videoio.hpp>

namespace constrictor::video {
namespace {

constexpr double kManualExposure = 1.0;   // of V4L2_CID_EXPOSURE_AUTO
constexpr double kExposureUnit_ms = 0.1;  // of V4L2_CID_EXPOSURE_ABSOLUTE
constexpr double kLargestStampAge_ms = 5000.0;

double now_ms() {
  return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

/// Settings of OpenCV and FFmpeg that only the environment can give. Values of the user stay in force.
void prepare_environment(double timeout_s) {
  // FFmpeg would else collect frames for seconds to guess the frame rate, and keep some to sort them.
  ::setenv("OPENCV_FFMPEG_CAPTURE_OPTIONS", "rtsp_transport;tcp|flags;low_delay|analyzeduration;0|fpsprobesize;0", 0);
  ::setenv("OPENCV_FFMPEG_LOGLEVEL", "8", 0);  // fatal errors: it would else print a line for each attempt to open
  ::setenv("OPENCV_VIDEOIO_V4L_SELECT_TIMEOUT", std::to_string(std::max(1L, std::lround(timeout_s))).c_str(), 0);
  cv::utils::logging::setLogLevel(cv::utils::logging::LOG_LEVEL_ERROR);  // this program reports errors itself
}

/// Sets a property of a device and reads it back. Returns false if the device has another value afterwards.
bool obeys(cv::VideoCapture& capture, int property, double value) {
  return capture.set(property, value) && std::abs(capture.get(property) - value) < 1e-6 + 1e-3 * std::abs(value);
}

class OpenCvInput final : public VideoInput {
 public:
  OpenCvInput(const VideoSource& source, const DeviceRequest& request) : name_(source.name()) {
    const int timeout_ms = static_cast<int>(std::lround(1e3 * request.timeout_s));
    switch (source.kind) {
      case SourceKind::kDevice:
        open_device(source, request);
        break;
      case SourceKind::kPipeline:
        capture_.open(source.text, cv::CAP_GSTREAMER);
        break;
      default: {
        const std::string address = source.kind == SourceKind::kAddress ? read_address(source.path) : source.text;
        name_ = without_password(address);
        capture_.open(address, cv::CAP_FFMPEG,
                      {cv::CAP_PROP_OPEN_TIMEOUT_MSEC, timeout_ms, cv::CAP_PROP_READ_TIMEOUT_MSEC, timeout_ms});
      }
    }
    if (!capture_.isOpened()) {
      // A device says why it cannot be opened; OpenCV does not.
      throw VideoError(fmt::format("{}: cannot be opened{}", name_,
                                   source.kind == SourceKind::kPipeline
                                       ? "; try the pipeline with gst-launch-1.0"
                                       : "; is it switched on, and does a player such as ffplay show it?"));
    }
  }

  bool read(cv::Mat& bgr) override { return capture_.read(bgr) && !bgr.empty(); }

  [[nodiscard]] std::optional<std::int64_t> stamp_ns() const override {
    if (!is_device_) return {};
    const double stamp_ms = capture_.get(cv::CAP_PROP_POS_MSEC);
    const double age_ms = now_ms() - stamp_ms;
    if (!(age_ms >= 0.0 && age_ms < kLargestStampAge_ms)) return {};  // some drivers have another clock
    return std::llround(stamp_ms * 1e6);
  }

  [[nodiscard]] std::string description() const override {
    return fmt::format("{}: {:.0f} x {:.0f} pixels, {}", name_, capture_.get(cv::CAP_PROP_FRAME_WIDTH),
                       capture_.get(cv::CAP_PROP_FRAME_HEIGHT), capture_.getBackendName());
  }
  [[nodiscard]] std::vector<std::string> remarks() const override { return remarks_; }

 private:
  void open_device(const VideoSource& source, const DeviceRequest& request) {
    struct stat status {};
    if (::stat(source.path.c_str(), &status) != 0)
      throw VideoError(fmt::format("{}: {}; `ls /dev/video*` shows the devices", name_, std::strerror(errno)));
    if (!S_ISCHR(status.st_mode))
      throw VideoError(fmt::format("{}: found no device, accepted a V4L2 device such as /dev/video0", name_));
    if (::access(source.path.c_str(), R_OK | W_OK) != 0)
      throw VideoError(fmt::format("{}: {}; add the user to the group video", name_, std::strerror(errno)));
    is_device_ = true;
    capture_.open(source.path.string(), cv::CAP_V4L2);
    if (!capture_.isOpened()) return;
    // MJPEG first: raw images of this size need more than a USB 2 port has.
    static_cast<void>(capture_.set(cv::CAP_PROP_FOURCC, cv::VideoWriter::fourcc('M', 'J', 'P', 'G')));
    const auto ask = [&](const char* what, int property, double value) {
      if (!obeys(capture_, property, value))
        remarks_.push_back(
            fmt::format("{}: {}: asked for {:g}, found {:g}", name_, what, value, capture_.get(property)));
    };
    if (request.width > 0) ask("width", cv::CAP_PROP_FRAME_WIDTH, request.width);
    if (request.height > 0) ask("height", cv::CAP_PROP_FRAME_HEIGHT, request.height);
    ask("frame rate", cv::CAP_PROP_FPS, request.frame_rate_hz);
    static_cast<void>(capture_.set(cv::CAP_PROP_BUFFERSIZE, 1));  // the newest frame, not the oldest of a queue
    if (request.lock_exposure) {
      const double found = capture_.get(cv::CAP_PROP_EXPOSURE);
      ask("manual exposure", cv::CAP_PROP_AUTO_EXPOSURE, kManualExposure);
      ask("exposure", cv::CAP_PROP_EXPOSURE, request.exposure_ms > 0 ? request.exposure_ms / kExposureUnit_ms : found);
    }
    if (request.lock_white_balance) {
      const double found = capture_.get(cv::CAP_PROP_WB_TEMPERATURE);
      ask("manual white balance", cv::CAP_PROP_AUTO_WB, 0.0);
      ask("white balance", cv::CAP_PROP_WB_TEMPERATURE, request.white_balance_k > 0 ? request.white_balance_k : found);
    }
    if (request.lock_focus) ask("manual focus", cv::CAP_PROP_AUTOFOCUS, 0.0);
  }

  std::string name_;
  bool is_device_ = false;
  cv::VideoCapture capture_;
  std::vector<std::string> remarks_;
};

}  // namespace

OpenVideo opencv_video(const VideoSource& source, const DeviceRequest& request) {
  prepare_environment(request.timeout_s);
  return [source, request]() -> std::unique_ptr<VideoInput> {
    try {
      return std::make_unique<OpenCvInput>(source, request);
    } catch (const cv::Exception& error) {
      throw VideoError(fmt::format("{}: {}", source.name(), error.err));
    }
  };
}

}  // namespace constrictor::video
