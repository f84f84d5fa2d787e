#include "sim/render/pixel_noise.hpp"

#include <algorithm>
#include <cstddef>

#include "sim/render/splitmix64.hpp"

namespace constrictor {
PixelNoise::PixelNoise(double standard_deviation, std::uint64_t seed)
    : on_(standard_deviation > 0.0), seed_(splitmix64(seed)) {
  if (!on_) return;
  table_.resize(1 << 16);
  const double scale = standard_deviation * 255.0 * (1 << kFractionBits);
  std::uint64_t counter = 0;
  for (std::int16_t& deviate : table_) {
    double sum = -6.0;
    for (int i = 0; i < 12; ++i) sum += static_cast<double>(splitmix64(counter++) >> 11) * 0x1p-53;
    deviate = static_cast<std::int16_t>(std::clamp(sum * scale, -32000.0, 32000.0));
  }
}

void PixelNoise::add(std::vector<std::uint8_t>& rgb, std::int64_t tick) const {
  if (!on_) return;
  std::uint64_t counter = splitmix64(seed_ ^ static_cast<std::uint64_t>(tick));
  const auto noisy = [this](std::uint8_t value, std::uint64_t index) {
    const int level = (value << kFractionBits) + table_[index & 0xFFFFU] + (1 << (kFractionBits - 1));
    return static_cast<std::uint8_t>(std::clamp(level >> kFractionBits, 0, 255));
  };
  std::size_t i = 0;
  for (; i + 4 <= rgb.size(); i += 4) {
    const std::uint64_t random = splitmix64(counter++);
    for (std::size_t j = 0; j < 4; ++j) rgb[i + j] = noisy(rgb[i + j], random >> (16 * j));
  }
  for (std::uint64_t random = splitmix64(counter); i < rgb.size(); ++i, random >>= 16) rgb[i] = noisy(rgb[i], random);
}

}  // namespace constrictor
