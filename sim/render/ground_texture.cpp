#include "sim/render/ground_texture.hpp"

#include <algorithm>
#include <array>
#include <cstddef>

#include "sim/render/splitmix64.hpp"

namespace constrictor {
namespace {

/// A pseudo-random number from -1 to 1 for a lattice point.
double lattice(int x, int y, int octave) {
  const auto key =
      static_cast<std::uint64_t>(x) | static_cast<std::uint64_t>(y) << 20 | static_cast<std::uint64_t>(octave) << 40;
  return static_cast<double>(splitmix64(key) >> 11) * 0x1p-52 - 1.0;
}

/// Value noise with `cells` lattice cells along the edge of the tile. It is periodic.
double value_noise(int x, int y, int cells, int octave) {
  const int cell = kGroundTextureSize / cells;
  const auto smooth = [](double t) { return t * t * (3.0 - 2.0 * t); };
  const int x0 = x / cell;
  const int y0 = y / cell;
  const int x1 = (x0 + 1) % cells;
  const int y1 = (y0 + 1) % cells;
  const double fx = smooth(static_cast<double>(x % cell) / cell);
  const double fy = smooth(static_cast<double>(y % cell) / cell);
  const double near = lattice(x0, y0, octave) * (1 - fx) + lattice(x1, y0, octave) * fx;
  const double far = lattice(x0, y1, octave) * (1 - fx) + lattice(x1, y1, octave) * fx;
  return near * (1 - fy) + far * fy;
}

}  // namespace

std::vector<std::uint8_t> make_ground_texture() {
  struct Octave {
    int cells;
    double weight;
  };
  constexpr std::array<Octave, 5> kOctaves{{{8, 5.0}, {16, 4.0}, {64, 4.0}, {256, 4.0}, {1024, 6.0}}};
  constexpr int kTexelsPerMetre = static_cast<int>(kGroundTextureSize / kGroundTextureExtent_m);
  constexpr double kJoint = 15.0;  // by which a joint is darker
  std::vector<std::uint8_t> texture(static_cast<std::size_t>(kGroundTextureSize) * kGroundTextureSize);
  for (int y = 0; y < kGroundTextureSize; ++y) {
    for (int x = 0; x < kGroundTextureSize; ++x) {
      double value = 200.0;
      for (std::size_t i = 0; i < kOctaves.size(); ++i) {
        value += kOctaves[i].weight * value_noise(x, y, kOctaves[i].cells, static_cast<int>(i));
      }
      if (x % kTexelsPerMetre < 2 || y % kTexelsPerMetre < 2) value -= kJoint;
      texture[static_cast<std::size_t>(y) * kGroundTextureSize + static_cast<std::size_t>(x)] =
          static_cast<std::uint8_t>(std::clamp(value, 0.0, 255.0));
    }
  }
  return texture;
}

}  // namespace constrictor
