// How long a history the latencies of the members need, compared with a schedule that is played out tick by tick.
#include "barrier/history_depth.hpp"

#include <gtest/gtest.h>

#include <algorithm>

namespace constrictor {
namespace {

/// Plays a run out: the writer has always finished every step that it may do, and the reader has always only finished
/// what the conductor waited for. Returns how many of the newest samples a reader that repeats its next step needs, at
/// the worst tick. A sample of step s is visible at s + writer_latency. The conductor sends tick T only after the
/// reader has finished every step from T - reader_latency or before.
int played_out(int writer_latency, int interval, int reader_latency, int reader_period) {
  int worst = 0;
  for (int newest = 0; newest < 400; ++newest) {
    int repeated = 0;  // the first step of the reader that need not be finished at tick `newest`
    while (repeated <= newest - reader_latency) repeated += reader_period;
    if (repeated > newest) continue;
    int needed = -1;  // step of the newest sample that is visible at `repeated`
    int written = 0;
    for (int step = 0; step <= newest; step += interval) {
      if (step + writer_latency <= repeated) needed = step;
    }
    for (int step = std::max(needed, 0); needed >= 0 && step <= newest; step += interval) ++written;
    worst = std::max(worst, written);
  }
  return worst;
}

TEST(HistoryDepth, IsThatOfAScheduleThatIsPlayedOut) {
  for (int writer_latency = 0; writer_latency <= 12; ++writer_latency) {
    for (const int interval : {1, 2, 3, 5, 7}) {
      for (int reader_latency = 1; reader_latency <= 12; ++reader_latency) {
        EXPECT_EQ(needed_history(writer_latency, interval, reader_latency),
                  played_out(writer_latency, interval, reader_latency, 1))
            << writer_latency << ", " << interval << ", " << reader_latency;
        for (const int reader_period : {2, 5})
          EXPECT_GE(needed_history(writer_latency, interval, reader_latency),
                    played_out(writer_latency, interval, reader_latency, reader_period));
      }
    }
  }
}

Hello member(const std::string& name, int latency, TopicSet reads, TopicSet writes, int period = 1) {
  Hello hello;
  hello.component = name;
  hello.timing = {static_cast<std::uint16_t>(period), static_cast<std::uint16_t>(latency)};
  hello.reads = reads;
  hello.writes = writes;
  return hello;
}

const TopicSet kJoints = TopicSet::of(topics::kJointState), kPose = TopicSet::of(topics::kRobotPose);
constexpr int kKept = topics::kJointState.depth / topics::kJointState.max_per_tick;

TEST(HistoryDepth, TheLongestLatencyThatATopicAllowsIsAcceptedAndOneMoreIsNot) {
  const auto violation = [](int reader) {
    return depth_violation({member("physics", 1, {}, kJoints), member("control", reader, kJoints, {})}, "physics");
  };
  EXPECT_EQ(violation(kKept), std::nullopt) << "the plant's samples are visible at once";
  EXPECT_EQ(
      violation(kKept + 1).value_or(""),
      "latency_ticks of control: found 17, accepted at most 16, because barrier/tick_done keeps the reports of 16 "
      "steps");
  const auto pair = [](int writer, int reader) {
    return depth_violation({member("guidance", writer, {}, kPose), member("navigation", reader, kPose, {})}, "physics");
  };
  EXPECT_EQ(pair(kKept / 2, kKept / 2), std::nullopt);
  EXPECT_EQ(
      pair(kKept / 2, kKept / 2 + 1).value_or(""),
      "latency_ticks: found 8 of guidance, which writes guidance/pose, and 9 of navigation, which reads it: a "
      "restarted reader would need the samples of 17 steps, but the topic keeps 16; choose a smaller latency (of the "
      "camera: camera.latency_ticks of the robot file, of the others: latency_ticks of the manifest)");
}

TEST(HistoryDepth, ATopicThatIsWrittenAfterImagesNeedsFewerSamples) {
  const TopicSet image = TopicSet::of(topics::kCameraImage), drawn = TopicSet::of(topics::kProcessedImage);
  const auto violation = [&](int image_period) {
    return depth_violation({member("camera", 2, {}, image, image_period), member("perception", 5, image, drawn),
                            member("report", 5, drawn, {})},
                           "physics");
  };
  EXPECT_EQ(violation(5), std::nullopt);
  EXPECT_EQ(depth_violation({member("perception", 5, image, drawn), member("report", 5, drawn, {})}, "physics"),
            std::nullopt)
      << "without a camera, its rate is unknown";
  EXPECT_NE(violation(1).value_or("").find("latency_ticks: found 2 of camera, which writes camera/image"),
            std::string::npos);
}

}  // namespace
}  // namespace constrictor
