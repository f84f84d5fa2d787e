// The pacer decides when the next tick may be sent.
#include "runtime/pacer.hpp"

#include <gtest/gtest.h>

#include <limits>

#include "constrictor/messages.hpp"

namespace constrictor {
namespace {

constexpr std::int64_t kLongestRun_ns = 1'000'000'000'000'000;  // --max-sim-time accepts up to 1e6 s

TEST(Pacer, AcceptsLockstepAndPacesWhoseDeadlinesTheClockCanHold) {
  for (const double pace : {0.0, 0.001, 0.5, 1.0, 1000.0}) EXPECT_TRUE(Pacer::accepts(pace)) << pace;
  for (const double pace : {1e-12, 0.000999, -1.0, 1000.1, std::numeric_limits<double>::infinity(),
                            std::numeric_limits<double>::quiet_NaN()}) {
    EXPECT_FALSE(Pacer::accepts(pace)) << pace;
  }
  EXPECT_LT(static_cast<double>(kLongestRun_ns) / Pacer::kSlowest, 0x1p62)
      << "[ns] there must be room for the time since the machine started";
}

TEST(Pacer, ATickIsDueAtItsTimeAtEveryAcceptedPace) {
  for (const double pace : {Pacer::kSlowest, 1.0, Pacer::kFastest}) {
    Pacer pacer(0.0);
    pacer.control(msg::kRunPace, pace);
    EXPECT_TRUE(pacer.may_tick(0)) << "the first tick must be due at once, at pace " << pace;
    EXPECT_FALSE(pacer.may_tick(kLongestRun_ns)) << "at pace " << pace;
    EXPECT_GT(pacer.wait_ns(), 0) << pace;
  }
}

TEST(Pacer, MakesTheRequestedStepsAndPausesAgain) {
  Pacer pacer(1.0);
  EXPECT_FALSE(pacer.holding());
  pacer.control(msg::kRunPause, 0.0);
  EXPECT_FALSE(pacer.may_tick(0));
  pacer.control(msg::kRunStep, 0.0, 2);
  for (int i = 0; i < 2; ++i) {
    ASSERT_TRUE(pacer.may_tick(i * 20'000'000)) << "requested steps must not wait for the pace";
    pacer.ticked();
  }
  EXPECT_TRUE(pacer.holding());
  EXPECT_FALSE(pacer.may_tick(40'000'000));
}

}  // namespace
}  // namespace constrictor
