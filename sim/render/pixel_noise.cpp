#include "sim/render/pixel_noise.hpp"

#include <algorithm>
#include <array>
#include <cstddef>

#include "sim/render/splitmix64.hpp"

namespace constrictor {
PixelNoise::PixelNoise(double standard_deviation, std::uint64_t seed)
    : on_(standard_deviation > 0.0), seed_(splitmix64(seed)) {
  if (!on_) return;
  table_.resize(1 << 16);
  constexpr int kFractionBits = 8;
  const double scale = standard_deviation * 255.0 * (1 << kFractionBits);
  std::uint64_t counter = 0;
  for (std::int8_t& deviate : table_) {
    double sum = -6.0;
    for (int i = 0; i < 12; ++i) sum += static_cast<double>(splitmix64(counter++) >> 11) * 0x1p-53;
    // Rounded once here: a grey level is an integer, so rounding the sum of both would give the same.
    const int fixed = static_cast<int>(std::clamp(sum * scale, -32000.0, 32000.0)) + (1 << (kFractionBits - 1));
    deviate = static_cast<std::int8_t>(fixed >> kFractionBits);
  }
}

void PixelNoise::add(std::vector<std::uint8_t>& rgb, std::int64_t tick) const {
  if (!on_) return;
  std::uint64_t counter = splitmix64(seed_ ^ static_cast<std::uint64_t>(tick));
  const std::int8_t* table = table_.data();
  // One random number has the indices of four deviates. They are collected in blocks, so that the compiler can use
  // vector instructions to add a block.
  constexpr std::size_t kBlock = 64;
  std::array<std::int8_t, kBlock> deviates{};
  const auto draw_block = [&] {
    for (std::size_t i = 0; i < kBlock; i += 4) {
      const std::uint64_t random = splitmix64(counter++);
      deviates[i] = table[random & 0xFFFFU];
      deviates[i + 1] = table[random >> 16 & 0xFFFFU];
      deviates[i + 2] = table[random >> 32 & 0xFFFFU];
      deviates[i + 3] = table[random >> 48];
    }
  };
  const auto noisy = [](std::uint8_t value, std::int8_t deviate) {
    return static_cast<std::uint8_t>(std::clamp(value + deviate, 0, 255));
  };
  std::uint8_t* block = rgb.data();
  std::uint8_t* const end = block + rgb.size();
  for (; end - block >= static_cast<std::ptrdiff_t>(kBlock); block += kBlock) {
    draw_block();
    for (std::size_t i = 0; i < kBlock; ++i) block[i] = noisy(block[i], deviates[i]);
  }
  draw_block();
  for (std::size_t i = 0; block < end; ++block, ++i) *block = noisy(*block, deviates[i]);
}

}  // namespace constrictor
