#include "component/random.hpp"

#include <gtest/gtest.h>

namespace constrictor {
namespace {

TEST(Random, IsSplitmix64) {
  // The published first outputs of the generator for seed 1234567.
  Random random(1234567);
  EXPECT_EQ(random.next(), 6457827717110365317ULL);
  EXPECT_EQ(random.next(), 3203168211198807973ULL);
}

TEST(Random, NormalHasUnitMoments) {
  Random random(5, "test");
  double sum = 0.0;
  double squares = 0.0;
  double fourths = 0.0;
  constexpr int kCount = 200000;
  for (int i = 0; i < kCount; ++i) {
    const double value = random.normal();
    sum += value;
    squares += value * value;
    fourths += value * value * value * value;
  }
  EXPECT_NEAR(sum / kCount, 0.0, 0.01);
  EXPECT_NEAR(squares / kCount, 1.0, 0.02);
  EXPECT_NEAR(fourths / kCount, 3.0, 0.1);
}

TEST(Random, StreamsOfDifferentPurposesDiffer) {
  Random a(1, "light");
  Random b(1, "line");
  Random again(1, "light");
  const std::uint64_t first = a.next();
  EXPECT_NE(first, b.next());
  EXPECT_EQ(first, again.next());
}

}  // namespace
}  // namespace constrictor
