#include "client/tick_wait.hpp"

#include <gtest/gtest.h>

namespace constrictor {
namespace {

using namespace std::chrono_literals;

// The run makes one tick a second for 30 s, then none; the conductor still publishes its state every second.
TEST(TickWait, EndsWhenTheRunHasMadeNoTickForTheBound) {
  const TickWait::Time start{};
  TickWait wait(10s, start);
  EXPECT_EQ(wait.next_tick(), -1);
  for (int second = 1; second <= 30; ++second) {
    wait.heard(second, start + second * 1s);
    EXPECT_FALSE(wait.over(start + second * 1s)) << second;
  }
  for (int second = 31; second <= 45; ++second) {
    wait.heard(30, start + second * 1s);
    EXPECT_EQ(wait.over(start + second * 1s), second > 40) << second;
  }
  EXPECT_EQ(wait.next_tick(), 30);
}

TEST(TickWait, EndsWithoutAnyStateAfterTheBound) {
  const TickWait::Time start{};
  const TickWait wait(10s, start);
  EXPECT_FALSE(wait.over(start + 10s));
  EXPECT_TRUE(wait.over(start + 10s + 1ms));
}

}  // namespace
}  // namespace constrictor
