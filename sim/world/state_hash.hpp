// A SHA-256 chain over raw bytes. Two equal chains mean that all values of both histories were equal, bit for bit.
#pragma once

#include <array>
#include <cereal/types/array.hpp>
#include <cstdint>
#include <span>

#include "constrictor/sha256.hpp"

namespace constrictor {

class StateHash {
 public:
  using Digest = Sha256::Digest;

  /// chain := SHA-256(chain, raw bytes of the values in this order).
  void extend(std::span<const double> values);
  [[nodiscard]] const Digest& digest() const { return digest_; }

  template <class Archive>
  void serialize(Archive& archive) {
    archive(digest_);
  }

 private:
  Digest digest_{};
  Sha256 hash_;
};

}  // namespace constrictor
