// A chain of SHA-256 over raw bytes: equal chains mean equal histories, bit for bit.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace constrictor {

class StateHash {
 public:
  using Digest = std::array<std::uint8_t, 32>;

  /// chain := SHA-256(chain, raw bytes of the values in this order).
  void extend(std::span<const double> values);
  [[nodiscard]] const Digest& digest() const { return digest_; }

 private:
  Digest digest_{};
  std::vector<std::uint8_t> buffer_;
};

}  // namespace constrictor
