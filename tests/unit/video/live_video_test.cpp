// The reader of live sources, with sources that the test scripts. Waits have bounds; no test depends on how fast the
// computer is.
#include "video/live_video.hpp"

#include <gtest/gtest.h>

#include <atomic>
#include <condition_variable>
#include <deque>
#include <mutex>

#include "support/eventually.hpp"

namespace constrictor::video {
namespace {

using testing::eventually;
using namespace std::chrono_literals;

/// What the source does next: a grey frame, or (negative) its end. The reader waits for the next one.
class Script {
 public:
  void frame(int grey) { add(grey); }
  void end() { add(-1); }
  std::optional<int> next() {
    std::unique_lock lock(mutex_);
    changed_.wait_for(lock, 5s, [this] { return !steps_.empty(); });
    if (steps_.empty()) return {};
    const int step = steps_.front();
    steps_.pop_front();
    return step;
  }
  std::atomic<int> openings{0};
  std::atomic<bool> closed{false};  ///< it cannot be opened

 private:
  void add(int step) {
    const std::lock_guard lock(mutex_);
    steps_.push_back(step);
    changed_.notify_all();
  }
  std::mutex mutex_;
  std::condition_variable changed_;
  std::deque<int> steps_;
};

class ScriptedInput final : public VideoInput {
 public:
  explicit ScriptedInput(Script& script) : script_(script) {}
  bool read(cv::Mat& bgr) override {
    const auto step = script_.next();
    if (!step || *step < 0) return false;
    bgr = cv::Mat(8, 8, CV_8UC3, cv::Scalar::all(*step));
    return true;
  }
  [[nodiscard]] std::optional<std::int64_t> stamp_ns() const override {  // as a driver that knows the time
    return std::chrono::duration_cast<std::chrono::nanoseconds>(std::chrono::steady_clock::now().time_since_epoch())
        .count();
  }
  [[nodiscard]] std::string description() const override { return "a scripted camera"; }
  [[nodiscard]] std::vector<std::string> remarks() const override { return {"it has no focus"}; }

 private:
  Script& script_;
};

class LiveVideoTest : public ::testing::Test {
 protected:
  LiveVideoTest()
      : video_(std::make_unique<LiveVideo>(
            [this]() -> std::unique_ptr<VideoInput> {
              if (script_.closed) throw VideoError("it is switched off");
              ++script_.openings;
              return std::make_unique<ScriptedInput>(script_);
            },
            LiveSettings{30.0, 0.05, 0.2})) {}
  ~LiveVideoTest() override {
    script_.end();  // wakes the reader
    video_.reset();
  }
  /// The grey of the next frame.
  int take() {
    int grey = -1;
    EXPECT_TRUE(eventually([&] {
      const auto frame = video_->take();
      if (frame) grey = frame->bgr.at<cv::Vec3b>(0, 0)[0];
      return frame.has_value();
    }));
    return grey;
  }
  bool told(const std::string& text) {
    return eventually([&] {
      static_cast<void>(video_->take());
      for (const auto& one : video_->take_news()) (one.is_good ? good_ : bad_) += one.text + "\n";
      news_ = good_ + bad_;
      return news_.find(text) != std::string::npos;
    });
  }
  bool counted(std::uint64_t frames) {
    return eventually([&] { return video_->counters().frames == frames; });
  }

  Script script_;
  std::unique_ptr<LiveVideo> video_;
  std::string news_, good_, bad_;  ///< all that was told, that which is good, and that which is not
};

TEST_F(LiveVideoTest, GivesEachFrameOnceAndOnlyTheNewest) {
  script_.frame(10);
  EXPECT_EQ(take(), 10);
  EXPECT_FALSE(video_->take().has_value());
  script_.frame(20);
  script_.frame(30);
  ASSERT_TRUE(counted(3));
  EXPECT_EQ(take(), 30);
  EXPECT_EQ(video_->counters().overtaken, 1U);
}

TEST_F(LiveVideoTest, TellsWhatTheDeviceDidNotObey) {
  EXPECT_TRUE(told("a scripted camera"));
  EXPECT_TRUE(told("it has no focus"));
  EXPECT_NE(good_.find("a scripted camera"), std::string::npos) << "a connection is good news";
  EXPECT_NE(bad_.find("it has no focus"), std::string::npos);
}

TEST_F(LiveVideoTest, OpensASourceThatEndedAgain) {
  script_.frame(10);
  EXPECT_EQ(take(), 10);
  script_.end();
  script_.frame(20);
  EXPECT_EQ(take(), 20);
  EXPECT_EQ(video_->counters().openings, 2U);
  EXPECT_TRUE(told("opened again"));
}

TEST_F(LiveVideoTest, TriesUntilTheSourceIsThereAndSaysTheReasonOnce) {
  script_.frame(10);
  EXPECT_EQ(take(), 10);
  script_.closed = true;
  script_.end();
  EXPECT_TRUE(told("it is switched off"));
  EXPECT_TRUE(eventually([&] { return video_->counters().failures >= 3; }));
  static_cast<void>(told("the camera is gone"));
  EXPECT_EQ(news_.find("it is switched off"), news_.rfind("it is switched off"));
  EXPECT_NE(news_.find("the camera is gone"), std::string::npos);
  EXPECT_FALSE(video_->counters().connected);
  script_.closed = false;
  script_.frame(30);
  EXPECT_EQ(take(), 30);
  EXPECT_TRUE(told("frames arrive again"));
  EXPECT_NE(bad_.find("the camera is gone"), std::string::npos);
  EXPECT_NE(good_.find("frames arrive again"), std::string::npos);
}

TEST_F(LiveVideoTest, NoticesAFrozenAndABlackCamera) {
  for (int i = 0; i < 4; ++i) script_.frame(50);
  EXPECT_TRUE(told("the camera is frozen: 4 equal frames"));
  EXPECT_TRUE(video_->counters().frozen);
  script_.frame(51);
  EXPECT_TRUE(told("no longer frozen"));
  script_.frame(2);
  EXPECT_TRUE(told("the image is black"));
  EXPECT_TRUE(video_->counters().black);
  script_.frame(90);
  EXPECT_TRUE(told("no longer black"));
  for (const char* bad : {"the camera is frozen", "the image is black"})
    EXPECT_NE(bad_.find(bad), std::string::npos) << bad;
  for (const char* good : {"no longer frozen", "no longer black"})
    EXPECT_NE(good_.find(good), std::string::npos) << good;
}

TEST(LiveVideo, EndsInTimeAlthoughTheSourceDoesNotAnswer) {
  class Stuck final : public VideoInput {
   public:
    explicit Stuck(std::shared_ptr<Script> script) : script_(std::move(script)) {}
    bool read(cv::Mat&) override {
      static_cast<void>(script_->next());
      return false;
    }
    [[nodiscard]] std::string description() const override { return "a stuck camera"; }

   private:
    std::shared_ptr<Script> script_;
  };
  const auto script = std::make_shared<Script>();
  auto video = std::make_unique<LiveVideo>(
      [script]() -> std::unique_ptr<VideoInput> {
        ++script->openings;
        return std::make_unique<Stuck>(script);
      },
      LiveSettings{});
  ASSERT_TRUE(eventually([&] { return script->openings > 0; }));
  const auto begin = std::chrono::steady_clock::now();
  video.reset();
  EXPECT_LT(std::chrono::steady_clock::now() - begin, 4s) << "the source answers after 5 s";
}

}  // namespace
}  // namespace constrictor::video
