#include "sim/world/state_hash.hpp"

#include <openssl/evp.h>

#include <cstring>
#include <stdexcept>

namespace constrictor {

void StateHash::extend(std::span<const double> values) {
  buffer_.resize(digest_.size() + values.size_bytes());
  std::memcpy(buffer_.data(), digest_.data(), digest_.size());
  if (!values.empty()) std::memcpy(buffer_.data() + digest_.size(), values.data(), values.size_bytes());
  unsigned int length = 0;
  if (EVP_Digest(buffer_.data(), buffer_.size(), digest_.data(), &length, EVP_sha256(), nullptr) != 1 ||
      length != digest_.size()) {
    throw std::runtime_error("SHA-256 is not available");
  }
}

}  // namespace constrictor
