#include "video/live_video.hpp"

#include <fmt/format.h>

#include <chrono>
#include <condition_variable>
#include <mutex>
#include <string_view>
#include <thread>
#include <utility>

#include "video/frame_clock.hpp"

namespace constrictor::video {
namespace {

using Clock = std::chrono::steady_clock;
constexpr auto kPatience = std::chrono::milliseconds(1500);

std::int64_t clock_ns() {
  return std::chrono::duration_cast<std::chrono::nanoseconds>(Clock::now().time_since_epoch()).count();
}

}  // namespace

struct LiveVideo::Shared {
  Shared(OpenVideo given, const LiveSettings& wanted) : open(std::move(given)), settings(wanted) {}

  void run();
  void read(VideoInput& input);
  /// False if the thread must end.
  bool pause();
  void tell(std::string_view text, bool is_good) {  // needs the lock
    if (news.size() < kMostNews) news.push_back({std::string(text), is_good});
  }

  const OpenVideo open;
  const LiveSettings settings;
  std::mutex mutex;
  std::condition_variable changed;
  bool stop = false;
  bool ended = false;
  LiveCounters counters;
  std::vector<News> news;
  std::optional<std::pair<cv::Mat, std::int64_t>> newest;  ///< and when it was sent
  std::int64_t last_frame_ns = clock_ns();
  bool gone = false;
};

bool LiveVideo::Shared::pause() {
  std::unique_lock lock(mutex);
  changed.wait_for(lock, std::chrono::duration<double>(settings.retry_s), [this] { return stop; });
  return !stop;
}

void LiveVideo::Shared::read(VideoInput& input) {
  FrameClock clock(static_cast<std::int64_t>(1e9 / settings.frame_rate_hz));
  FrameCheck check;
  for (;;) {
    cv::Mat bgr;
    const std::int64_t began_ns = clock_ns();
    const bool arrived = input.read(bgr);
    const std::int64_t ended_ns = clock_ns();
    if (!arrived) return;
    const auto stamp = input.stamp_ns();
    const FrameClock::Verdict verdict = stamp ? clock.on_stamped_frame(*stamp) : clock.on_frame(began_ns, ended_ns);
    const auto change = check.look(bgr);
    const std::lock_guard lock(mutex);
    if (stop) return;
    ++counters.frames;
    counters.missing += static_cast<std::uint64_t>(verdict.missing);
    counters.frozen = check.frozen();
    counters.black = check.black();
    counters.rate_hz = 1e9 / static_cast<double>(std::max<std::int64_t>(1, clock.period_ns()));
    if (change) tell(change->text, change->is_good);
    last_frame_ns = ended_ns;
    if (std::exchange(gone, false)) tell("frames arrive again", true);
    if (!verdict.fresh) {
      ++counters.stale;
      continue;
    }
    if (newest) ++counters.overtaken;
    newest.emplace(std::move(bgr), verdict.sent_ns);
  }
}

void LiveVideo::Shared::run() {
  std::string last_error;
  for (;;) {
    std::unique_ptr<VideoInput> input;
    std::string error;
    try {
      input = open();
    } catch (const std::exception& failure) {
      error = failure.what();
    }
    {
      const std::lock_guard lock(mutex);
      if (stop) break;
      if (input) {
        ++counters.openings;
        counters.connected = true;
        counters.description = input->description();
        tell(counters.description, true);
        for (const auto& remark : input->remarks()) tell(remark, false);
        last_error.clear();
      } else {
        ++counters.failures;
        if (error != last_error) tell(error, false);  // a repeated reason is not reported again
        last_error = error;
      }
    }
    if (input) {
      try {
        read(*input);
      } catch (const std::exception& failure) {
        const std::lock_guard lock(mutex);
        tell(failure.what(), false);
      }
      input.reset();
      const std::lock_guard lock(mutex);
      if (stop) break;
      counters.connected = counters.frozen = counters.black = false;
      tell("the stream has ended or is silent: it is opened again", false);
    }
    if (!pause()) break;
  }
  const std::lock_guard lock(mutex);
  ended = true;
  changed.notify_all();
}

LiveVideo::LiveVideo(OpenVideo open, const LiveSettings& settings)
    : shared_(std::make_shared<Shared>(std::move(open), settings)) {
  std::thread([shared = shared_] { shared->run(); }).detach();
}

LiveVideo::~LiveVideo() {
  std::unique_lock lock(shared_->mutex);
  shared_->stop = true;
  shared_->changed.notify_all();
  shared_->changed.wait_for(lock, kPatience, [this] { return shared_->ended; });
}

std::optional<LiveFrame> LiveVideo::take() {
  const std::lock_guard lock(shared_->mutex);
  const std::int64_t now = clock_ns();
  const double silent_s = static_cast<double>(now - shared_->last_frame_ns) * 1e-9;
  if (!shared_->gone && silent_s > shared_->settings.gone_after_s) {
    shared_->gone = true;
    shared_->tell(fmt::format("no frame for {:.1f} s: the camera is gone", silent_s), false);
  }
  if (!shared_->newest) return {};
  LiveFrame frame{std::move(shared_->newest->first), now - shared_->newest->second};
  shared_->newest.reset();
  return frame;
}

LiveCounters LiveVideo::counters() const {
  const std::lock_guard lock(shared_->mutex);
  return shared_->counters;
}

std::vector<News> LiveVideo::take_news() {
  const std::lock_guard lock(shared_->mutex);
  return std::exchange(shared_->news, {});
}

std::int64_t LiveVideo::now_ns() const { return clock_ns(); }

}  // namespace constrictor::video
