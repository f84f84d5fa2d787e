// Seeded random numbers. They are the same on every platform, unlike the distributions of the standard library. The
// state is one integer.
#pragma once

#include <cmath>
#include <cstdint>
#include <numbers>
#include <string_view>

namespace constrictor {

class Random {
 public:
  explicit Random(std::uint64_t seed) : state_(seed) {}
  /// A separate stream for each purpose. An additional draw from one stream does not change the others.
  Random(std::uint64_t seed, std::string_view purpose) : state_(seed) {
    std::uint64_t hash = 0xcbf29ce484222325ULL;  // FNV-1a
    for (const char letter : purpose) hash = (hash ^ static_cast<unsigned char>(letter)) * 0x100000001b3ULL;
    state_ = next() ^ hash;
    next();
  }

  /// Source: S. Vigna, splitmix64.
  std::uint64_t next() {
    std::uint64_t z = (state_ += 0x9e3779b97f4a7c15ULL);
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9ULL;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebULL;
    return z ^ (z >> 31);
  }
  /// Uniform in [0, 1).
  double uniform() { return static_cast<double>(next() >> 11) * 0x1p-53; }
  double uniform(double min, double max) { return min + (max - min) * uniform(); }
  /// Uniform in [1 - relative, 1 + relative).
  double factor(double relative) { return uniform(1.0 - relative, 1.0 + relative); }
  bool coin() { return (next() >> 63) != 0; }
  /// Standard normal. Source: Box and Muller, 1958; the second value is discarded, so that there is no
  /// further state.
  double normal() {
    const double radius = std::sqrt(-2.0 * std::log(1.0 - uniform()));
    return radius * std::cos(2.0 * std::numbers::pi * uniform());
  }

  template <class Archive>
  void serialize(Archive& archive) {
    archive(state_);
  }

 private:
  std::uint64_t state_;
};

}  // namespace constrictor
