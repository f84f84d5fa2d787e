// Sensor noise of a camera: zero-mean Gaussian noise on every channel of every pixel. It is a pure function of seed and
// tick.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

namespace constrictor {

/// Adds normal deviates from a table at random indices that depend on a counter. It has no state, so a restarted camera
/// repeats its frames, and it does not use libm. The deviates are sums of 12 uniform numbers (Irwin-Hall distribution),
/// bounded at 6 standard deviations.
class PixelNoise {
 public:
  /// `standard_deviation` is relative to the full scale of a channel; 0 turns the noise off.
  PixelNoise(double standard_deviation, std::uint64_t seed);
  void add(std::vector<std::uint8_t>& rgb, std::int64_t tick) const;

 private:
  bool on_;
  std::uint64_t seed_;
  std::vector<std::int8_t> table_;  // 65536 deviates in grey levels
};

}  // namespace constrictor
