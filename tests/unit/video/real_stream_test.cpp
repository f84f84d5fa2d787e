// Real sources behind OpenCV: a pipeline of GStreamer, and H.264 in MPEG-TS over HTTP. Waits have bounds; no test
// depends on how fast the computer is.
#include <arpa/inet.h>
#include <gtest/gtest.h>
#include <sys/socket.h>
#include <unistd.h>

#include <atomic>
#include <chrono>
#include <fstream>
#include <iterator>
#include <opencv2/videoio.hpp>
#include <thread>

#include "support/eventually.hpp"
#include "support/temporary_folder.hpp"
#include "video/live_video.hpp"

namespace constrictor::video {
namespace {

using testing::eventually;
using namespace std::chrono_literals;

constexpr double kRate_hz = 10.0;
constexpr auto kBound = 60s;

/// A film in H.264 whose frames become brighter, one after the other; blue in all of them.
void write_film(const std::filesystem::path& file, int frames) {
  cv::VideoWriter film(file.string(), cv::CAP_FFMPEG, cv::VideoWriter::fourcc('H', '2', '6', '4'), kRate_hz, {160, 120},
                       true);
  ASSERT_TRUE(film.isOpened()) << "libavcodec59 of Debian encodes H.264";
  for (int i = 0; i < frames; ++i) film.write(cv::Mat(120, 160, CV_8UC3, cv::Scalar(60 + 2 * i, 20, 20)));
}

/// Serves one file over HTTP as a camera does: at the pace of its frames, to one viewer after the other.
class PacedServer {
 public:
  PacedServer(const std::filesystem::path& file, double duration_s) : duration_s_(duration_s) {
    std::ifstream stream(file, std::ios::binary);
    bytes_.assign(std::istreambuf_iterator<char>(stream), {});
    listener_ = ::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0);
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_addr.s_addr = ::htonl(INADDR_LOOPBACK);
    socklen_t size = sizeof address;
    const auto* at = reinterpret_cast<const sockaddr*>(&address);  // the interface of sockets
    EXPECT_EQ(::bind(listener_, at, size), 0);
    EXPECT_EQ(::listen(listener_, 4), 0);
    EXPECT_EQ(::getsockname(listener_, reinterpret_cast<sockaddr*>(&address), &size), 0);
    port_ = ::ntohs(address.sin_port);
    thread_ = std::thread([this] { serve(); });
  }
  ~PacedServer() {
    ends_ = true;
    ::shutdown(listener_, SHUT_RDWR);  // wakes accept()
    thread_.join();
    ::close(listener_);
  }
  [[nodiscard]] std::string address() const { return "http://127.0.0.1:" + std::to_string(port_) + "/film.ts"; }
  [[nodiscard]] int viewers() const { return viewers_; }

 private:
  void serve() {
    while (!ends_) {
      const int viewer = ::accept4(listener_, nullptr, nullptr, SOCK_CLOEXEC);
      if (viewer < 0) return;
      ++viewers_;
      char request[2048];
      static_cast<void>(::recv(viewer, request, sizeof request, 0));
      static constexpr std::string_view kHead = "HTTP/1.0 200 OK\r\nContent-Type: video/mp2t\r\n\r\n";
      bool connected = send(viewer, kHead);
      const std::size_t step = bytes_.size() / static_cast<std::size_t>(duration_s_ * kRate_hz) + 1;
      for (std::size_t at = 0; connected && !ends_ && at < bytes_.size(); at += step) {
        connected = send(viewer, std::string_view(bytes_).substr(at, step));
        std::this_thread::sleep_for(std::chrono::duration<double>(1.0 / kRate_hz));  // the pace of the camera
      }
      ::close(viewer);
    }
  }
  static bool send(int viewer, std::string_view bytes) {
    return ::send(viewer, bytes.data(), bytes.size(), MSG_NOSIGNAL) == static_cast<ssize_t>(bytes.size());
  }

  double duration_s_;
  std::string bytes_;
  int listener_ = -1;
  std::uint16_t port_ = 0;
  std::atomic<bool> ends_{false};
  std::atomic<int> viewers_{0};
  std::thread thread_;
};

std::unique_ptr<LiveVideo> watch(const VideoSource& source) {
  DeviceRequest request;
  request.timeout_s = 5.0;
  return std::make_unique<LiveVideo>(opencv_video(source, request), LiveSettings{kRate_hz, 0.1, 5.0});
}

/// The next frame; empty: none within the bound.
cv::Mat next(LiveVideo& video) {
  cv::Mat bgr;
  EXPECT_TRUE(eventually(
      [&] {
        auto frame = video.take();
        if (frame) bgr = frame->bgr;
        return frame.has_value();
      },
      kBound))
      << video.counters().description << ", failures: " << video.counters().failures;
  return bgr;
}

TEST(RealStream, APipelineOfGStreamerIsShown) {
  const auto video =
      watch(parse_source("videotestsrc is-live=true pattern=red ! video/x-raw,width=160,height=120,framerate=10/1 ! "
                         "videoconvert ! appsink",
                         "/", "/"));
  for (int i = 0; i < 3; ++i) {
    const cv::Mat bgr = next(*video);
    ASSERT_EQ(bgr.size(), cv::Size(160, 120)) << "scripts/setup.sh tests installs the elements of the pipeline";
    const cv::Scalar mean = cv::mean(bgr);
    EXPECT_GT(mean[2], 200.0) << mean;
    EXPECT_LT(mean[0] + mean[1], 60.0) << mean;
  }
  EXPECT_NE(video->counters().description.find("160 x 120 pixels, GSTREAMER"), std::string::npos)
      << video->counters().description;
}

TEST(RealStream, APipelineThatEndsIsOpenedAgain) {
  const auto video =
      watch(parse_source("videotestsrc is-live=true num-buffers=8 ! video/x-raw,width=64,height=48,framerate=10/1 ! "
                         "videoconvert ! appsink",
                         "/", "/"));
  EXPECT_TRUE(eventually([&] { return video->counters().openings >= 3; }, kBound)) << video->counters().failures;
  EXPECT_EQ(next(*video).size(), cv::Size(64, 48));
}

TEST(RealStream, H264OverHttpIsShownAndOpenedAgainAfterItsEnd) {
  const testing::TemporaryFolder folder;
  constexpr int kFrames = 40;
  write_film(folder.path() / "film.ts", kFrames);
  if (HasFatalFailure()) return;
  const PacedServer server(folder.path() / "film.ts", kFrames / kRate_hz);
  const auto video = watch(parse_source(server.address(), "/", "/"));
  cv::Mat bgr = next(*video);
  ASSERT_EQ(bgr.size(), cv::Size(160, 120));
  double blue = cv::mean(bgr)[0];
  for (int i = 0; i < 5; ++i) {
    bgr = next(*video);
    ASSERT_FALSE(bgr.empty());
    const cv::Scalar mean = cv::mean(bgr);
    EXPECT_GT(mean[0], blue) << "frames come in their order";
    EXPECT_NEAR(mean[1], 20.0, 12.0) << mean;
    EXPECT_NEAR(mean[2], 20.0, 12.0) << mean;
    blue = mean[0];
  }
  EXPECT_FALSE(video->counters().frozen);
  EXPECT_NE(video->counters().description.find("FFMPEG"), std::string::npos) << video->counters().description;
  // The server closes the connection at the end of the film.
  EXPECT_TRUE(eventually([&] { return server.viewers() >= 2 && video->counters().openings >= 2; }, kBound));
  EXPECT_LT(cv::mean(next(*video))[0], 60.0 + 2.0 * kFrames) << "the film from its start";
}

}  // namespace
}  // namespace constrictor::video
