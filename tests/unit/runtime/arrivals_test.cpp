// Arrivals: a wait ends for the samples that matter, and for none that was lost or that nobody wants.
#include "runtime/arrivals.hpp"

#include <gtest/gtest.h>

#include <chrono>
#include <thread>

namespace constrictor {
namespace {

using namespace std::chrono_literals;
using Clock = std::chrono::steady_clock;

constexpr auto kLong = 30s;  // never reached, unless a wake-up is lost
constexpr auto kShort = 20ms;
constexpr Arrivals::Sources bit(std::size_t source) { return Arrivals::Sources{1} << source; }

/// How long a wait for `wanted` takes if its bound is `bound`.
Clock::duration waits(Arrivals& arrivals, Clock::duration bound, Arrivals::Sources wanted) {
  const auto start = Clock::now();
  arrivals.wait(bound, wanted);
  return Clock::now() - start;
}

TEST(Arrivals, WaitReturnsAtOnceWhenWhatIsWantedHasArrived) {
  Arrivals arrivals;
  arrivals.note(3);
  EXPECT_LT(waits(arrivals, kLong, bit(3)), kLong / 2);
  EXPECT_EQ(arrivals.take(), bit(3));
  EXPECT_EQ(arrivals.take(), 0U);
}

TEST(Arrivals, WaitIgnoresWhatIsNotWantedButKeepsIt) {
  Arrivals arrivals;
  arrivals.note(1);
  arrivals.note(62);
  EXPECT_GE(waits(arrivals, kShort, bit(2)), kShort);
  EXPECT_EQ(arrivals.take(), bit(1) | bit(62));
}

TEST(Arrivals, WakeEndsThePresentOrTheNextWaitOnce) {
  Arrivals arrivals;
  arrivals.wake();
  EXPECT_LT(waits(arrivals, kLong, 0), kLong / 2);
  EXPECT_EQ(arrivals.take(), 0U);
  EXPECT_GE(waits(arrivals, kShort, 0), kShort);
  std::thread waker([&] { arrivals.wake(); });
  EXPECT_LT(waits(arrivals, kLong, 0), kLong / 2);
  waker.join();
}

TEST(Arrivals, ExpectedSamplesEndTheWaitOnlyTogether) {
  Arrivals arrivals;
  arrivals.note(5);
  EXPECT_EQ(arrivals.take(), bit(5));
  arrivals.expect(5, 2);
  arrivals.note(5);
  EXPECT_GE(waits(arrivals, kShort, bit(5)), kShort);
  arrivals.note(5);
  EXPECT_LT(waits(arrivals, kLong, bit(5)), kLong / 2);
  EXPECT_EQ(arrivals.take(), bit(5));
  arrivals.note(5);  // what was expected has been taken
  EXPECT_LT(waits(arrivals, kLong, bit(5)), kLong / 2);
}

TEST(Arrivals, OtherSourcesEndAWaitThatExpectsMore) {
  Arrivals arrivals;
  arrivals.expect(5, 8);
  arrivals.note(5);
  arrivals.note(6);
  EXPECT_LT(waits(arrivals, kLong, bit(5) | bit(6)), kLong / 2);
  EXPECT_EQ(arrivals.take(), bit(5) | bit(6));
}

// The counterpart answers each sample by one, so that a lost wake-up stops both threads.
TEST(Arrivals, NoWakeUpIsLostBetweenTwoThreads) {
  constexpr int kRounds = 20000;
  Arrivals here;
  Arrivals there;
  std::thread counterpart([&] {
    for (int i = 0; i < kRounds; ++i) {
      while (there.take() == 0) there.wait(kLong, bit(0));
      here.note(static_cast<std::size_t>(i % 2));
    }
  });
  const auto start = Clock::now();
  for (int i = 0; i < kRounds; ++i) {
    there.note(0);
    while (here.take() == 0) here.wait(kLong, bit(0) | bit(1));
  }
  counterpart.join();
  EXPECT_LT(Clock::now() - start, kLong);
}

}  // namespace
}  // namespace constrictor
