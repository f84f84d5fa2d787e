#include "constrictor/sha256.hpp"

#include <openssl/evp.h>
#include <openssl/hmac.h>

#include <cstdio>
#include <cstdlib>

namespace constrictor {
namespace {

EVP_MD_CTX* context_of(const auto& context) { return static_cast<EVP_MD_CTX*>(context.get()); }

void require(int success) {
  if (success != 1) {
    std::fputs("constrictor: OpenSSL does not offer SHA-256; install a complete libcrypto\n", stderr);
    std::abort();
  }
}

/// Fetched once, because EVP_sha256() would search the providers of OpenSSL at each use.
const EVP_MD* algorithm() {
  static const EVP_MD* const kAlgorithm = EVP_MD_fetch(nullptr, "SHA256", nullptr);
  require(kAlgorithm != nullptr ? 1 : 0);
  return kAlgorithm;
}

}  // namespace

Sha256::Sha256() : context_(EVP_MD_CTX_new()) { require(context_ != nullptr ? 1 : 0); }

void Sha256::Free::operator()(void* context) const { EVP_MD_CTX_free(static_cast<EVP_MD_CTX*>(context)); }

void Sha256::update(std::span<const std::byte> bytes) {
  if (!begun_) require(EVP_DigestInit_ex(context_of(context_), algorithm(), nullptr));
  begun_ = true;
  require(EVP_DigestUpdate(context_of(context_), bytes.data(), bytes.size()));
}

Sha256::Digest Sha256::finish() {
  Digest digest{};
  update({});  // begins a hash of no bytes, if there were none
  require(EVP_DigestFinal_ex(context_of(context_), digest.data(), nullptr));
  begun_ = false;
  return digest;
}

Sha256::Digest sha256(std::span<const std::byte> bytes) {
  Sha256 hash;
  hash.update(bytes);
  return hash.finish();
}

Sha256::Digest hmac_sha256(std::string_view key, std::string_view text) {
  Sha256::Digest digest{};
  const auto* found = HMAC(EVP_sha256(), key.data(), static_cast<int>(key.size()),
                           reinterpret_cast<const unsigned char*>(text.data()), text.size(), digest.data(), nullptr);
  require(found ? 1 : 0);
  return digest;
}

}  // namespace constrictor
