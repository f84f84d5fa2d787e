#include "configuration/quantiles.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

namespace constrictor {
namespace {

TEST(Quantiles, AreTheValuesAtTheirPlaceInTheSortedOrder) {
  constexpr unsigned kSeed = 7;
  SCOPED_TRACE(::testing::Message() << "seed " << kSeed);
  std::mt19937 random(kSeed);
  for (std::size_t count = 1; count < 30; ++count) {
    std::vector<double> values(count);
    for (std::size_t i = 0; i < count; ++i) values[i] = static_cast<double>(i);  // each value is its place
    std::shuffle(values.begin(), values.end(), random);
    const std::size_t middle = count / 2;  // rounded down
    EXPECT_EQ(upper_median(values), static_cast<double>(middle));
    EXPECT_EQ(lower_quantile(values, 0.0), 0.0);
    EXPECT_EQ(lower_quantile(values, 1.0), static_cast<double>(count - 1));
    EXPECT_EQ(lower_quantile(values, 0.5), std::floor(0.5 * static_cast<double>(count - 1)));
    EXPECT_EQ(interpolated_quantile(values, 0.5), 0.5 * static_cast<double>(count - 1));
  }
}

TEST(Quantiles, OfNoValuesAreUnknown) {
  EXPECT_TRUE(std::isnan(lower_quantile({}, 0.5)));
  EXPECT_TRUE(std::isnan(interpolated_quantile({}, 0.5)));
}

}  // namespace
}  // namespace constrictor
