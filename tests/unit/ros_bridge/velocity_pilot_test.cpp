// When the bridge requests a motion, how long it repeats the request, and when it releases authority.
#include <gtest/gtest.h>

#include "ros_bridge/velocity_pilot.hpp"

namespace constrictor::ros_bridge {
namespace {

constexpr Drive kAhead{0.5, 0.0};
constexpr double kTurn_s = 0.02;

class VelocityPilotTest : public ::testing::Test {
 protected:
  /// Lets `duration_s` pass while ROS sends the constant velocity `stream`, or no velocity if it is empty. Returns the
  /// number of requests that the pilot made.
  int asks(double duration_s, std::optional<Drive> stream, bool connected = true, bool steered = true) {
    int count = 0;
    for (const double end_s = now_s_ + duration_s; now_s_ < end_s; now_s_ += kTurn_s) {
      if (stream) pilot_.command(*stream, now_s_);
      const auto ask = pilot_.next(connected, steered, now_s_);
      if (!ask) continue;
      ++count;
      last_ = *ask;
      if (answer_) pilot_.answered(*answer_);
      if (answer_ == true) pilot_.authority(ask->kind == msg::kRequestMotion, false, now_s_);
    }
    return count;
  }
  VelocityPilot pilot_{0.5};
  std::optional<bool> answer_ = true;  ///< the answer of `input`; empty: `input` does not answer
  VelocityPilot::Ask last_;
  double now_s_ = 1000.0;
};

TEST_F(VelocityPilotTest, RequestsAConstantVelocityOnce) {
  EXPECT_EQ(asks(5.0, kAhead), 1);
  EXPECT_EQ(last_.drive, kAhead);
}

TEST_F(VelocityPilotTest, RepeatsARefusedVelocityUntilItIsGranted) {
  answer_ = false;
  const int refused = asks(5.0, kAhead);
  EXPECT_GE(refused, 4);
  EXPECT_LE(refused, 6) << "a refused request must be repeated about once a second";
  answer_ = true;
  EXPECT_EQ(asks(5.0, kAhead), 1);
}

TEST_F(VelocityPilotTest, RepeatsAnUnansweredRequest) {
  answer_.reset();
  const int unanswered = asks(2.0, kAhead);
  EXPECT_GE(unanswered, 4);
  EXPECT_LE(unanswered, 5);
}

TEST_F(VelocityPilotTest, RequestsNothingBeforeInputIsDiscovered) {
  EXPECT_EQ(asks(2.0, kAhead, /*connected=*/false), 0);
  EXPECT_EQ(asks(0.1, kAhead), 1);
}

TEST_F(VelocityPilotTest, RequestsAuthorityAgainAWhileAfterItWasLost) {
  asks(1.0, kAhead);
  pilot_.authority(false, false, now_s_);
  EXPECT_EQ(asks(0.9, kAhead), 0);
  EXPECT_EQ(asks(0.3, kAhead), 1);
}

TEST_F(VelocityPilotTest, StartsNoMotionAfterAStopUntilTheVelocityWasZeroOrAbsent) {
  asks(1.0, kAhead);
  pilot_.authority(false, true, now_s_);
  EXPECT_EQ(asks(2.0, kAhead), 0);
  pilot_.authority(false, false, now_s_);
  EXPECT_EQ(asks(3.0, kAhead), 0);
  asks(1.0, std::nullopt);
  EXPECT_EQ(asks(0.2, kAhead), 1);
}

TEST_F(VelocityPilotTest, StandsWithoutVelocitiesAndReleasesWhenTheirWriterIsGone) {
  asks(1.0, kAhead);
  EXPECT_EQ(asks(2.0, std::nullopt), 1);
  EXPECT_EQ(last_.kind, msg::kRequestMotion);
  EXPECT_EQ(last_.drive, Drive{});
  EXPECT_EQ(asks(2.0, std::nullopt, true, /*steered=*/false), 1);
  EXPECT_EQ(last_.kind, msg::kRequestRelease);
  EXPECT_EQ(asks(0.1, kAhead), 1) << "the first velocity of the next writer must be requested at once";
}

TEST_F(VelocityPilotTest, RequestsAChangedVelocityAtOnce) {
  asks(1.0, kAhead);
  EXPECT_EQ(asks(0.1, Drive{0.5, 0.3}), 1);
  EXPECT_EQ(asks(0.1, Drive{0.4, 0.3}), 1);
}

TEST_F(VelocityPilotTest, ATaskIsNotEndedByTheVelocityBeforeItNorByZeros) {
  asks(0.2, kAhead);
  pilot_.task(true);
  EXPECT_EQ(asks(2.0, std::nullopt), 0) << "the end of the old velocity must not make the robot stand";
  EXPECT_EQ(asks(2.0, Drive{}), 0) << "many ROS programs write zeros all the time";
  EXPECT_EQ(asks(0.1, kAhead), 1) << "a new velocity is the newest command";
  EXPECT_EQ(asks(0.1, Drive{}), 1) << "and its end makes the robot stand";
  pilot_.task(false);
  EXPECT_EQ(asks(0.1, std::nullopt, true, /*steered=*/false), 1);
  EXPECT_EQ(last_.kind, msg::kRequestRelease);
}

}  // namespace
}  // namespace constrictor::ros_bridge
