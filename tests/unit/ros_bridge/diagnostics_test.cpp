// The levels and values of the diagnostics that ROS 2 receives.
#include <gtest/gtest.h>

#include <map>
#include <string>

#include "constrictor/text.hpp"
#include "ros_bridge/ros_diagnostics.hpp"

namespace constrictor::ros_bridge {
namespace {

// Source: diagnostic_msgs/msg/DiagnosticStatus.msg.
enum Level { kOk, kWarn, kError, kStale };

struct Shown {
  int level = -1;
  std::string message;
  std::map<std::string, std::string> values;
};

class RosDiagnostics : public ::testing::Test {
 protected:
  RosDiagnostics() { tick(1000); }
  void tick(std::int64_t index, std::uint32_t epoch = 1) {
    msg::Tick tick{};
    tick.epoch = epoch;
    tick.index = index;
    tick.time_ns = 20'000'000 * index;
    health_.take(tick);
  }
  static msg::ComponentStatus status(std::int64_t tick = 1000, std::uint8_t state = msg::kComponentRunning) {
    msg::ComponentStatus status{};
    set_text(status.component, "control");
    status.run_id = 5;
    status.epoch = 1;
    status.incarnation = 1;
    status.state = state;
    status.tick = tick;
    status.step_time_p50_us = 120.4;
    return status;
  }
  Shown shown(const std::string& name) {
    const DiagnosticArray array = health_.report(counts_);
    EXPECT_EQ(array.header.stamp.sec, 20) << "the time of the newest tick";
    Shown shown;
    for (std::uint32_t i = 0; i < array.status._length; ++i) {
      const auto& one = array.status._buffer[i];
      EXPECT_STREQ(one.hardware_id, "mamba");
      if (one.name != "constrictor: " + name) continue;
      EXPECT_EQ(shown.level, -1) << name << " is shown twice";
      shown.level = one.level;
      shown.message = one.message;
      for (std::uint32_t k = 0; k < one.values._length; ++k)
        shown.values[one.values._buffer[k].key] = one.values._buffer[k].value;
    }
    return shown;
  }
  Health health_{"mamba"};
  BridgeCounts counts_;
};

TEST_F(RosDiagnostics, AHealthyComponentIsOkAndShowsItsFigures) {
  health_.take(status());
  const Shown control = shown("control");
  EXPECT_EQ(control.level, kOk);
  EXPECT_EQ(control.values.at("step time, median [us]"), "120");
  EXPECT_EQ(control.values.at("tick"), "1000");
  EXPECT_EQ(shown("ros_bridge").level, kOk);
}

TEST_F(RosDiagnostics, StatesAndDelaysHaveTheirLevels) {
  health_.take(status(1000, msg::kComponentWaiting));
  EXPECT_EQ(shown("control").level, kWarn);
  health_.take(status(1000, msg::kComponentEnded));
  EXPECT_EQ(shown("control").level, kError);
  health_.take(status(1000 - Health::kStale_ticks));
  EXPECT_EQ(shown("control").level, kOk);
  health_.take(status(999 - Health::kStale_ticks));
  EXPECT_EQ(shown("control").level, kStale);
}

TEST_F(RosDiagnostics, NewRejectionsAndMissedStepsAreWarnedOfOnce) {
  msg::ComponentStatus rejecting = status();
  rejecting.refused_count = 3;
  set_text(rejecting.last_refusal, "stale command");
  health_.take(rejecting);
  const Shown first = shown("control");
  EXPECT_EQ(first.level, kWarn);
  EXPECT_NE(first.message.find("stale command"), std::string::npos);
  EXPECT_EQ(shown("control").level, kOk);
  rejecting.overruns = 2;
  health_.take(rejecting);
  EXPECT_EQ(shown("control").level, kWarn);
  EXPECT_EQ(shown("control").level, kOk);
}

TEST_F(RosDiagnostics, AnOlderIncarnationIsIgnoredAndAResetBeginsAnew) {
  msg::ComponentStatus second = status();
  second.incarnation = 2;
  health_.take(second);
  health_.take(status(1000, msg::kComponentEnded));
  EXPECT_EQ(shown("control").level, kOk);
  tick(1000, 2);
  EXPECT_EQ(shown("control").level, -1);
}

TEST_F(RosDiagnostics, TheBridgeCountsWhatItDropsAndRefuses) {
  counts_.refused = 1;
  counts_.last_reason = "found no task";
  const Shown bridge = shown("ros_bridge");
  EXPECT_EQ(bridge.level, kWarn);
  EXPECT_EQ(bridge.message, "found no task");
  EXPECT_EQ(bridge.values.at("refused requests"), "1");
  EXPECT_EQ(shown("ros_bridge").level, kOk);
}

}  // namespace
}  // namespace constrictor::ros_bridge
