// Pixel noise has the right moments and is a pure function of seed and tick.
#include "sim/render/pixel_noise.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "sim/render/splitmix64.hpp"

namespace constrictor {
namespace {

/// The noise byte by byte, with fixed-point deviates in 1/256 grey level.
std::vector<std::uint8_t> noisy_byte_by_byte(std::vector<std::uint8_t> rgb, double sd, std::uint64_t seed,
                                             std::int64_t tick) {
  std::uint64_t random = 0;
  std::uint64_t counter = splitmix64(splitmix64(seed) ^ static_cast<std::uint64_t>(tick));
  for (std::size_t i = 0; i < rgb.size(); ++i) {
    random = i % 4 == 0 ? splitmix64(counter++) : random >> 16;
    double sum = -6.0;
    for (std::uint64_t j = 0; j < 12; ++j)
      sum += static_cast<double>(splitmix64(12 * (random & 0xFFFFU) + j) >> 11) * 0x1p-53;
    const auto deviate = static_cast<std::int16_t>(std::clamp(sum * sd * 255.0 * 256.0, -32000.0, 32000.0));
    rgb[i] = static_cast<std::uint8_t>(std::clamp((rgb[i] * 256 + deviate + 128) >> 8, 0, 255));
  }
  return rgb;
}

TEST(PixelNoise, IsTheSameAsByteByByte) {
  for (const double sd : {0.004, 0.02, 0.3}) {
    for (const std::size_t size : {0U, 1U, 63U, 64U, 66U, 5000U}) {
      std::vector<std::uint8_t> rgb(size);
      for (std::size_t i = 0; i < size; ++i) rgb[i] = static_cast<std::uint8_t>(splitmix64(i));
      const std::vector<std::uint8_t> expected = noisy_byte_by_byte(rgb, sd, 9, 40);
      PixelNoise(sd, 9).add(rgb, 40);
      EXPECT_EQ(rgb, expected) << sd << ' ' << size;
    }
  }
}

constexpr std::size_t kSize = 320 * 240 * 3;

TEST(PixelNoise, HasTheGivenStandardDeviationAndNoBias) {
  for (const double sd : {0.01, 0.03}) {
    std::vector<std::uint8_t> rgb(kSize, 128);
    PixelNoise(sd, 5).add(rgb, 17);
    double sum = 0, squares = 0, neighbours = 0;
    for (std::size_t i = 0; i < kSize; ++i) {
      const double d = rgb[i] - 128.0;
      sum += d;
      squares += d * d;
      if (i > 0) neighbours += d * (rgb[i - 1] - 128.0);
    }
    const double n = static_cast<double>(kSize);
    EXPECT_NEAR(sum / n, 0.0, 4 * sd * 255 / std::sqrt(n) + 0.01);
    // Rounding to grey levels adds a variance of 1/12.
    EXPECT_NEAR(std::sqrt(squares / n), std::sqrt(sd * sd * 255 * 255 + 1.0 / 12), 0.02 * sd * 255);
    EXPECT_NEAR(neighbours / squares, 0.0, 5 / std::sqrt(n));  // uncorrelated
  }
}

TEST(PixelNoise, DependsOnSeedAndTickOnly) {
  const auto noise = [](std::uint64_t seed, std::int64_t tick) {
    std::vector<std::uint8_t> rgb(1003, 100);
    PixelNoise generator(0.05, seed);
    generator.add(rgb, tick);
    return rgb;
  };
  EXPECT_EQ(noise(1, 10), noise(1, 10));
  EXPECT_NE(noise(1, 10), noise(1, 11));
  EXPECT_NE(noise(1, 10), noise(2, 10));
  PixelNoise generator(0.05, 1);
  std::vector<std::uint8_t> rgb(1003, 100);
  generator.add(rgb, 3);
  rgb.assign(1003, 100);
  generator.add(rgb, 10);  // earlier frames have no influence
  EXPECT_EQ(rgb, noise(1, 10));
}

TEST(PixelNoise, ZeroDoesNotChangeTheImage) {
  std::vector<std::uint8_t> rgb(100, 77);
  PixelNoise(0.0, 1).add(rgb, 1);
  EXPECT_EQ(rgb, std::vector<std::uint8_t>(100, 77));
}

}  // namespace
}  // namespace constrictor
