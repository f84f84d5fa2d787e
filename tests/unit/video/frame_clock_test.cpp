#include "video/frame_clock.hpp"

#include <gtest/gtest.h>

#include <vector>

namespace constrictor::video {
namespace {

constexpr std::int64_t kMs = 1'000'000;
constexpr std::int64_t kPeriod = 100 * kMs;

/// A source that sends a frame every period into a buffer, and a reader that needs 2 ms for each.
class SteadyStream {
 public:
  explicit SteadyStream(std::int64_t promised_ns = kPeriod) : clock(promised_ns) {}

  /// The next frame that the source sends; returns the verdict, and the true time of sending.
  FrameClock::Verdict next() {
    sent += kPeriod;
    const std::int64_t began = now;
    now = std::max(now, sent) + 2 * kMs;
    return clock.on_frame(began, now);
  }
  /// [ns] by which the clock errs; positive: it takes the frame for older than it is.
  [[nodiscard]] std::int64_t error(const FrameClock::Verdict& verdict) const { return sent - verdict.sent_ns; }

  FrameClock clock;
  std::int64_t now = 0;
  std::int64_t sent = 0;
};

TEST(FrameClock, KnowsWhenFramesOfASteadyStreamWereSent) {
  SteadyStream stream;
  stream.next();
  for (int i = 0; i < 50; ++i) {
    const auto verdict = stream.next();
    EXPECT_TRUE(verdict.fresh) << i;
    EXPECT_LE(std::abs(stream.error(verdict)), 2 * kMs) << i;
    EXPECT_EQ(verdict.missing, 0);
  }
}

TEST(FrameClock, DiscardsFramesThatHaveWaitedWhileTheReaderSlept) {
  SteadyStream stream;
  for (int i = 0; i < 20; ++i) static_cast<void>(stream.next());
  stream.now += 2000 * kMs;  // the process was stopped; 20 frames wait in the buffer
  int stale = 0;
  for (int i = 0; i < 40; ++i) {
    const std::int64_t before = stream.now;
    const auto verdict = stream.next();
    const std::int64_t age = stream.now - stream.sent;
    if (!verdict.fresh) ++stale;
    else EXPECT_LE(age, 10 * kMs) << "frame " << i << ", read after " << (stream.now - before) / kMs << " ms";
  }
  EXPECT_GE(stale, 19);
  EXPECT_LE(stale, 22) << "it must not discard fresh frames";
}

TEST(FrameClock, AFrameReadLateIsOlderThanItsReading) {
  SteadyStream stream;
  for (int i = 0; i < 20; ++i) static_cast<void>(stream.next());
  stream.now += 160 * kMs;  // a busy computer; two frames wait, less than a silence
  const auto first = stream.next();
  const auto second = stream.next();
  EXPECT_TRUE(first.fresh && second.fresh);
  EXPECT_LE(std::abs(stream.error(second)), 65 * kMs);
  EXPECT_LE(second.sent_ns, stream.now);
}

TEST(FrameClock, CountsFramesThatTheSourceLeavesOut) {
  SteadyStream stream;
  for (int i = 0; i < 20; ++i) static_cast<void>(stream.next());
  stream.sent += kPeriod;  // one is left out
  EXPECT_EQ(stream.next().missing, 1);
  EXPECT_EQ(stream.next().missing, 0);
}

TEST(FrameClock, LearnsTheTrueRateWhicheverIsPromised) {
  for (const std::int64_t promised : {kPeriod / 10, kPeriod, 4 * kPeriod}) {
    SteadyStream stream(promised);
    std::vector<bool> fresh;
    for (int i = 0; i < 80; ++i) fresh.push_back(stream.next().fresh);
    EXPECT_NEAR(static_cast<double>(stream.clock.period_ns()), static_cast<double>(kPeriod), 5.0 * kMs) << promised;
    EXPECT_TRUE(fresh.back());
    EXPECT_GE(std::count(fresh.begin(), fresh.end(), true), 50) << promised;
  }
}

TEST(FrameClock, BelievesTheStampsOfADriver) {
  FrameClock clock(kPeriod);
  static_cast<void>(clock.on_stamped_frame(1000 * kMs));
  const auto verdict = clock.on_stamped_frame(1300 * kMs);
  EXPECT_TRUE(verdict.fresh);
  EXPECT_EQ(verdict.sent_ns, 1300 * kMs);
  EXPECT_EQ(verdict.missing, 2);
}

}  // namespace
}  // namespace constrictor::video
