// The component `camera` of a real robot, in a run with a plant that only makes ticks.
#include "video_capture/video_capture.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <condition_variable>
#include <fstream>
#include <mutex>
#include <opencv2/imgcodecs.hpp>

#include "barrier/local_run.hpp"
#include "component/data_path.hpp"
#include "configuration/configuration.hpp"
#include "support/eventually.hpp"
#include "support/scripted_members.hpp"
#include "support/temporary_folder.hpp"

namespace constrictor {
namespace {

struct Image {
  std::int64_t tick, exposed;
  int width, height, red, blue;
  bool operator==(const Image&) const = default;
};

/// A camera whose frames the test sends, each with the age that it has when it is sent.
class HandFed {
 public:
  void send(int width, int height, std::int64_t age_ns = 0) {
    const std::lock_guard lock(mutex_);
    frame_ = cv::Mat(height, width, CV_8UC3, cv::Scalar(10 + 10 * ++sent_, 0, 200));
    stamp_ns_ = now_ns() - age_ns;
    waiting_ = true;
    changed_.notify_all();
  }
  void close() {
    const std::lock_guard lock(mutex_);
    closed_ = true;
    changed_.notify_all();
  }
  class Input final : public video::VideoInput {
   public:
    explicit Input(std::shared_ptr<HandFed> camera) : camera_(std::move(camera)) {}
    bool read(cv::Mat& bgr) override {
      std::unique_lock lock(camera_->mutex_);
      camera_->changed_.wait(lock, [this] { return camera_->waiting_ || camera_->closed_; });
      if (!camera_->waiting_) return false;
      camera_->waiting_ = false;
      stamp_ns_ = camera_->stamp_ns_;
      bgr = camera_->frame_.clone();
      return true;
    }
    [[nodiscard]] std::optional<std::int64_t> stamp_ns() const override { return stamp_ns_; }
    [[nodiscard]] std::string description() const override { return "a camera fed by hand"; }

   private:
    std::shared_ptr<HandFed> camera_;
    std::int64_t stamp_ns_ = 0;
  };

 private:
  static std::int64_t now_ns() {
    return std::chrono::steady_clock::now().time_since_epoch() / std::chrono::nanoseconds(1);
  }
  std::mutex mutex_;
  std::condition_variable changed_;
  cv::Mat frame_;
  std::int64_t stamp_ns_ = 0;
  int sent_ = 0;
  bool waiting_ = false;
  bool closed_ = false;
};

class VideoCaptureTest : public ::testing::Test {
 protected:
  ~VideoCaptureTest() override {
    camera_->close();
    run_.reset();
  }
  void start(const std::string& config, bool live) {
    std::ofstream(folder_.path() / "camera.yaml") << config << "\n";
    constrictor::Setup setup;
    setup.robot_file = data_path("components/lib/robot/" + robot_);
    setup.output_dir = folder_.path();
    setup.log = Log("camera", folder_.path() / "log");
    const video::OpenVideo open = [camera = camera_] { return std::make_unique<HandFed::Input>(camera); };
    run_ = std::make_unique<LocalRun>(
        std::vector<ComponentFactory>{testing::idle_plant(),
                                      live ? make_video_capture_factory(open) : make_video_capture_factory()},
        setup, std::map<std::string, std::filesystem::path>{{"camera", folder_.path() / "camera.yaml"}});
    run_->subscribe<msg::CameraImage>(topics::kCameraImage, [this](const msg::CameraImage& m) {
      ASSERT_EQ(m.data._length, static_cast<std::uint32_t>(m.width * m.height * 3));
      images_.push_back({m.header.tick, m.exposure_tick, m.width, m.height, m.data._buffer[0], m.data._buffer[2]});
    });
    run_->subscribe<msg::CameraInfo>(topics::kCameraInfo, [this](const msg::CameraInfo& m) { infos_.push_back(m); });
  }
  void pictures(int count, int width = 320, int height = 240) const {
    std::filesystem::create_directory(folder_.path() / "pictures");
    for (int i = 0; i < count; ++i)
      ASSERT_TRUE(cv::imwrite((folder_.path() / "pictures" / (std::to_string(100 + i) + ".png")).string(),
                              cv::Mat(height, width, CV_8UC3, cv::Scalar(10 * i, 0, 200))));
  }
  [[nodiscard]] std::string folder_source() const { return "source: " + (folder_.path() / "pictures").string(); }
  /// Advances until the count of images is reached.
  bool images(std::size_t count, std::chrono::seconds bound = std::chrono::seconds(20)) {
    const auto enough = [&] {
      run_->advance(1);
      return images_.size() >= count;
    };
    return testing::eventually(enough, bound);
  }
  /// The lines of the log.
  [[nodiscard]] std::string log() const {
    std::ifstream file(folder_.path() / "log");
    return {std::istreambuf_iterator<char>(file), {}};
  }
  bool logged(const std::string& text) {
    return testing::eventually([&] {
      run_->advance(1);
      return log().find(text) != std::string::npos;
    });
  }
  [[nodiscard]] std::string refusals() { return run_->member("camera").counters().last_refusal; }

  const testing::TemporaryFolder folder_;
  std::string robot_ = "mamba.yaml";
  std::shared_ptr<HandFed> camera_ = std::make_shared<HandFed>();
  std::unique_ptr<LocalRun> run_;
  std::vector<Image> images_;
  std::vector<msg::CameraInfo> infos_;
};

TEST_F(VideoCaptureTest, ShowsFilesAtTheTimesOfTheRun) {
  pictures(3);
  start(folder_source() + "\nstream: {frame_rate_hz: 10}", false);
  run_->advance(40);
  ASSERT_EQ(images_.size(), 3U) << "a folder ends with its last picture";
  for (int i = 0; i < 3; ++i)
    EXPECT_EQ(images_[static_cast<std::size_t>(i)], (Image{5 * i, 5 * i, 320, 240, 200, 10 * i}));
  ASSERT_EQ(infos_.size(), 1U);
  EXPECT_NEAR(infos_[0].fx, 160.0, 1e-9) << "90 degrees over 320 pixels: the camera of the robot file";
  EXPECT_NEAR(infos_[0].X_HC.position_m.x, 0.06, 1e-12);
}

TEST_F(VideoCaptureTest, ShowsAPipelineOfGStreamer) {
  start(
      "source: 'videotestsrc is-live=true pattern=red ! video/x-raw,width=320,height=240,framerate=10/1 ! videoconvert "
      "! appsink'\nstream: {frame_rate_hz: 10, timeout_s: 5}",
      false);
  constexpr std::chrono::seconds kBound(60);  // the thread sanitizer needs 20 s: it names each race that it suppresses
  ASSERT_TRUE(images(3, kBound)) << refusals() << " (scripts/setup.sh tests installs the elements of the pipeline)";
  EXPECT_EQ(images_.back().width, 320);
  EXPECT_GT(images_.back().red, 200);
  EXPECT_LT(images_.back().blue, 40);
  EXPECT_EQ(infos_.size(), 1U);
}

TEST_F(VideoCaptureTest, BeginsFilesAgainAndIsTheSameInEachRun) {
  pictures(3);
  start(folder_source() + "\nstream: {frame_rate_hz: 10}\nfile: {repeat: true}", false);
  run_->advance(60);
  const auto first = std::exchange(images_, {});
  ASSERT_EQ(first.size(), 12U);
  EXPECT_EQ(first[4].blue, 10);
  start(folder_source() + "\nstream: {frame_rate_hz: 10}\nfile: {repeat: true}", false);
  run_->advance(60);
  EXPECT_EQ(images_, first);
  images_.clear();
  start(folder_source() + "\nstream: {frame_rate_hz: 10}\nfile: {repeat: true}", false);
  run_->advance(23);
  run_->restart("camera");
  run_->advance(37);
  EXPECT_EQ(images_, first) << "a restarted process goes on where its predecessor was";
}

TEST_F(VideoCaptureTest, ScalesAndRectifiesByItsCalibration) {
  pictures(1, 640, 480);
  std::ofstream(folder_.path() / "lens.yaml")
      << "image: {width: 640, height: 480}\nlens: {fx: 500, fy: 500, cx: 320, cy: 240, distortion: [-0.2, 0.05, 0, "
         "0]}\n"
         "mount: {position_m: [0.01, 0.02, 0.03], orientation_wxyz: [0.5, -0.5, 0.5, -0.5]}\n";
  start(folder_source() + "\ncalibration: " + (folder_.path() / "lens.yaml").string() +
            "\nimage: {width: 320, height: 240}",
        false);
  run_->advance(2);
  ASSERT_EQ(images_.size(), 1U);
  EXPECT_EQ(images_[0].width, 320);
  ASSERT_EQ(infos_.size(), 1U);
  EXPECT_NEAR(infos_[0].fx, 250.0, 1e-9);
  EXPECT_NEAR(infos_[0].cx, 160.0, 1e-9);
  EXPECT_NEAR(infos_[0].X_HC.position_m.y, 0.02, 1e-12);
}

TEST_F(VideoCaptureTest, PublishesTheNewestLiveFrameOnceWithTheTickOfItsExposure) {
  start("stream: {delay_s: 0.1}", true);
  run_->advance(10);
  EXPECT_TRUE(images_.empty()) << "a tick does not wait for a frame";
  camera_->send(320, 240);
  ASSERT_TRUE(images(1));
  EXPECT_LE(images_[0].exposed, images_[0].tick - 5) << "0.1 s are 5 ticks";
  EXPECT_EQ(images_[0].red, 200) << "RGB, not BGR";
  run_->advance(5);
  EXPECT_EQ(images_.size(), 1U);
  camera_->send(320, 240);
  ASSERT_TRUE(images(2));
  EXPECT_EQ(infos_.size(), 1U);
}

TEST_F(VideoCaptureTest, RefusesLateFramesAndFramesOfAnotherCamera) {
  start("stream: {late_after_s: 0.3}", true);
  const auto refused = [&](const std::string& text) {
    return testing::eventually([&] {
      run_->advance(1);
      return refusals().find(text) != std::string::npos;
    });
  };
  camera_->send(320, 240, 400'000'000);
  EXPECT_TRUE(refused("accepted at most 0.30 s")) << refusals();
  camera_->send(320, 180);
  EXPECT_TRUE(refused("accepted the proportions of 320 x 240")) << refusals();
  EXPECT_TRUE(images_.empty());
  camera_->send(320, 240);
  EXPECT_TRUE(images(1)) << "it goes on with good frames";
  EXPECT_NE(log().find("warning camera: camera/image: found a frame of"), std::string::npos) << log();
  EXPECT_NE(log().find("info camera: camera/image: frames arrive in time again"), std::string::npos) << log();
}

TEST_F(VideoCaptureTest, LogsHowTheCameraIsAndCountsNoRefusalOfAHealthyOne) {
  start("stream: {gone_after_s: 0.1}", true);
  EXPECT_TRUE(logged("info camera: a camera fed by hand")) << log();
  EXPECT_TRUE(logged("warning camera: no frame for")) << log();
  camera_->send(320, 240);
  EXPECT_TRUE(logged("info camera: frames arrive again")) << log();
  EXPECT_EQ(run_->member("camera").counters().refused, 0U) << refusals();
}

TEST_F(VideoCaptureTest, BoundsTheLinesOfTheLog) {
  start("stream: {late_after_s: 0.3}", true);
  for (std::uint64_t i = 1; i <= 20; ++i) {  // late and in time, one after the other
    camera_->send(320, 240, i % 2 == 1 ? 400'000'000 : 0);
    if (i % 2 == 0) {
      ASSERT_TRUE(images(i / 2)) << log();
    } else {
      ASSERT_TRUE(testing::eventually([&] {
        run_->advance(1);
        return run_->member("camera").counters().refused == (i + 1) / 2;
      })) << i;
    }
    if (run_->tick() > 400) break;  // a slow computer: the first period would end
  }
  const std::string lines = log();
  EXPECT_LE(std::count(lines.begin(), lines.end(), '\n'), 10) << lines;
}

TEST_F(VideoCaptureTest, WritesHowTheCameraIs) {
  start("", true);
  camera_->send(320, 240);
  ASSERT_TRUE(images(1));
  run_->advance(51);
  std::ifstream file(folder_.path() / "camera.json");
  const std::string text{std::istreambuf_iterator<char>(file), {}};
  EXPECT_NE(text.find("\"published\": 1"), std::string::npos) << text;
  EXPECT_NE(text.find("a camera fed by hand"), std::string::npos) << text;
}

TEST_F(VideoCaptureTest, RefusesAConfigurationThatCannotWork) {
  const auto refusal = [&](const std::string& config) -> std::string {
    try {
      start(config, false);
    } catch (const ConfigurationError& error) {
      return error.what();
    }
    return {};
  };
  EXPECT_NE(refusal("source: no_such_film.mp4").find("no such file"), std::string::npos);
  EXPECT_NE(refusal("source: ftp://camera").find("accepted /dev/videoN"), std::string::npos);
  EXPECT_NE(refusal("image: {width: 320}").find("both or neither"), std::string::npos);
  EXPECT_NE(refusal("image: {width: 320, height: 320}").find("proportions"), std::string::npos);
  EXPECT_NE(refusal("stream: {delay_s: 0.6}").find("every frame would be late"), std::string::npos);
  EXPECT_NE(refusal("calibration: no_such.yaml").find("no_such.yaml"), std::string::npos);
  pictures(1, 320, 200);
  EXPECT_NE(refusal(folder_source()).find("proportions"), std::string::npos);
  robot_ = "mamba_two_cameras.yaml";
  EXPECT_NE(refusal(folder_source()).find("further_cameras: found a list of 1, accepted none: video_capture reads one"),
            std::string::npos);
}

}  // namespace
}  // namespace constrictor
