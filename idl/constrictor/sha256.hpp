// SHA-256: the only place that calls OpenSSL for it.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <string_view>

namespace constrictor {

/// SHA-256 over bytes given in pieces. To construct one costs much more than to hash a short message.
class Sha256 {
 public:
  using Digest = std::array<std::uint8_t, 32>;
  Sha256();
  void update(std::span<const std::byte> bytes);
  /// Returns the digest; the next update() begins a new one.
  [[nodiscard]] Digest finish();

 private:
  struct Free {
    void operator()(void* context) const;
  };
  std::unique_ptr<void, Free> context_;
  bool begun_ = false;
};

/// SHA-256 of bytes given at once.
[[nodiscard]] Sha256::Digest sha256(std::span<const std::byte> bytes);

/// HMAC-SHA-256 (RFC 2104) of a text.
[[nodiscard]] Sha256::Digest hmac_sha256(std::string_view key, std::string_view text);

}  // namespace constrictor
