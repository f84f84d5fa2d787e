#include "runtime/jitter_meter.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "constrictor/text.hpp"
#include "runtime/status_meter.hpp"

namespace constrictor {
namespace {

using namespace std::chrono_literals;

/// Ticks of 20 ms at the times [ms] at which they arrive.
msg::ComponentStatus status_of(JitterMeter& meter, const std::vector<double>& at_ms, std::int64_t first_tick = 0) {
  const JitterMeter::Clock::time_point start{1h};
  for (const double ms : at_ms) {
    const auto offset =
        std::chrono::duration_cast<JitterMeter::Clock::duration>(std::chrono::duration<double, std::milli>(ms));
    meter.arrived(start + offset, 20'000'000 * first_tick++);
  }
  msg::ComponentStatus status{};
  meter.fill(status);
  return status;
}

TEST(StatusMeter, IsDueEveryFiftyTicksAndSoonInANewEpoch) {
  StatusMeter meter;
  EXPECT_TRUE(meter.due(0));
  msg::ComponentStatus status{};
  status.tick = 500;
  meter.fill(status);
  EXPECT_FALSE(meter.due(500));
  EXPECT_FALSE(meter.due(549));
  EXPECT_TRUE(meter.due(550));
  EXPECT_TRUE(meter.due(0)) << "the run was reset";
  status.tick = 0;
  meter.fill(status);
  EXPECT_FALSE(meter.due(1));
  EXPECT_TRUE(meter.due(50));
}

TEST(JitterMeter, KnowsNothingBeforeTheSecondTick) {
  JitterMeter meter;
  for (const msg::ComponentStatus& status : {status_of(meter, {}), status_of(meter, {0})}) {
    EXPECT_TRUE(std::isnan(status.jitter_p50_us));
    EXPECT_TRUE(std::isnan(status.jitter_p99_us));
    EXPECT_TRUE(std::isnan(status.jitter_max_us));
  }
  EXPECT_EQ(meter.histogram(), "");
}

TEST(JitterMeter, IsHowMuchLongerThanAPeriodTheTickWasOnItsWay) {
  JitterMeter meter;
  // 3 ms late, then on the original schedule again (3 ms early after the late one), then punctual.
  const msg::ComponentStatus status = status_of(meter, {0, 23, 40, 60, 80, 100});
  EXPECT_NEAR(status.jitter_p50_us, 0, 1e-6);
  EXPECT_NEAR(status.jitter_max_us, 3000, 1e-6);
}

TEST(JitterMeter, ATickThatWasLeftOutIsNotLate) {
  JitterMeter meter;
  status_of(meter, {0}, 0);
  EXPECT_NEAR(status_of(meter, {60}, 3).jitter_max_us, 0, 1e-6);
}

TEST(JitterMeter, TheLargestIsOfTheEpochAndTheOthersAreOfTheInterval) {
  JitterMeter meter;
  EXPECT_NEAR(status_of(meter, {0, 27}, 0).jitter_max_us, 7000, 1e-6);
  const msg::ComponentStatus later = status_of(meter, {47, 67, 87}, 2);
  EXPECT_NEAR(later.jitter_p99_us, 0, 1e-6);
  EXPECT_NEAR(later.jitter_max_us, 7000, 1e-6);
  meter.begin();
  EXPECT_TRUE(std::isnan(status_of(meter, {87}, 5).jitter_max_us));
}

TEST(JitterMeter, APauseIsNotLate) {
  JitterMeter meter;
  status_of(meter, {0, 20}, 0);
  meter.interrupt();
  EXPECT_NEAR(status_of(meter, {5000, 5021}, 2).jitter_max_us, 1000, 1e-6);
}

TEST(JitterMeter, TheHistogramCountsEveryTick) {
  JitterMeter meter;
  // Seven ticks that are punctual, one 0.3 ms late, one 4 ms late, one 70 ms late.
  status_of(meter, {0, 20, 40, 60, 80, 100, 120, 140, 160.3, 184.3, 274.3});
  EXPECT_EQ(meter.histogram(),
            "10 ticks: 70.0 % at most 0.1 ms late, 80.0 % at most 0.5 ms late, 90.0 % at most 5 ms late, the latest "
            "70.0 ms");
}

}  // namespace
}  // namespace constrictor
