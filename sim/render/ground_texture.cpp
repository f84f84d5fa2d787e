#include "sim/render/ground_texture.hpp"

#include <algorithm>
#include <array>
#include <cstddef>
#include <utility>

#include "sim/render/splitmix64.hpp"

namespace constrictor {
namespace {

/// A pseudo-random number from -1 to 1 for a lattice point.
double lattice(int x, int y, int octave) {
  const auto key =
      static_cast<std::uint64_t>(x) | static_cast<std::uint64_t>(y) << 20 | static_cast<std::uint64_t>(octave) << 40;
  return static_cast<double>(splitmix64(key) >> 11) * 0x1p-52 - 1.0;
}

double smooth(double t) { return t * t * (3.0 - 2.0 * t); }

/// Value noise with `cells` lattice cells along the edge of the tile. It is periodic. The noise is computed by rows,
/// because the values of a row of the lattice serve for all rows of texels up to the next one.
class ValueNoise {
 public:
  ValueNoise(int cells, int octave)
      : cells_(cells),
        cell_(kGroundTextureSize / cells),
        octave_(octave),
        above_(blended_row(0)),
        below_(blended_row(1)) {}

  /// Adds the noise of row y, times the weight, to a row of kGroundTextureSize values. The rows must come in order.
  void add_row(int y, double weight, std::vector<double>& values) {
    if (y > 0 && y % cell_ == 0) {
      above_.swap(below_);
      below_ = blended_row((y / cell_ + 1) % cells_);
    }
    const double part = smooth(static_cast<double>(y % cell_) / cell_);
    for (std::size_t x = 0; x < values.size(); ++x) values[x] += weight * (above_[x] * (1 - part) + below_[x] * part);
  }

 private:
  /// The noise along a row of the lattice, for each texel.
  std::vector<double> blended_row(int lattice_y) const {
    std::vector<double> corners;
    for (int x = 0; x < cells_; ++x) corners.push_back(lattice(x, lattice_y % cells_, octave_));
    corners.push_back(corners.front());
    std::vector<double> row;
    row.reserve(kGroundTextureSize);
    for (int x = 0; x < kGroundTextureSize; ++x) {
      const auto left = static_cast<std::size_t>(x / cell_);
      const double part = smooth(static_cast<double>(x % cell_) / cell_);
      row.push_back(corners[left] * (1 - part) + corners[left + 1] * part);
    }
    return row;
  }

  int cells_;
  int cell_;  // [texels] edge of a cell
  int octave_;
  std::vector<double> above_;
  std::vector<double> below_;
};

}  // namespace

std::vector<std::uint8_t> make_ground_texture() {
  struct Octave {
    ValueNoise noise;
    double weight;
  };
  std::vector<Octave> octaves;
  constexpr std::array<std::pair<int, double>, 5> kOctaves{{{8, 5.0}, {16, 4.0}, {64, 4.0}, {256, 4.0}, {1024, 6.0}}};
  for (const auto& [cells, weight] : kOctaves)
    octaves.push_back({ValueNoise(cells, static_cast<int>(octaves.size())), weight});
  constexpr int kTexelsPerMetre = static_cast<int>(kGroundTextureSize / kGroundTextureExtent_m);
  constexpr double kJoint = 15.0;  // by which a joint is darker
  std::vector<std::uint8_t> texture;
  texture.reserve(static_cast<std::size_t>(kGroundTextureSize) * kGroundTextureSize);
  for (int y = 0; y < kGroundTextureSize; ++y) {
    std::vector<double> values(kGroundTextureSize, 200.0);
    for (Octave& octave : octaves) octave.noise.add_row(y, octave.weight, values);
    for (int x = 0; x < kGroundTextureSize; ++x) {
      const bool joint = x % kTexelsPerMetre < 2 || y % kTexelsPerMetre < 2;
      const double value = values[static_cast<std::size_t>(x)] - (joint ? kJoint : 0.0);
      texture.push_back(static_cast<std::uint8_t>(std::clamp(value, 0.0, 255.0)));
    }
  }
  return texture;
}

}  // namespace constrictor
