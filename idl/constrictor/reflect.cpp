#include "constrictor/reflect.hpp"

#include <openssl/evp.h>

#include <cstdio>
#include <cstdlib>

namespace constrictor {
namespace {

EVP_MD_CTX* context_of(void* context) { return static_cast<EVP_MD_CTX*>(context); }

void require(int success) {
  if (success != 1) {
    std::fputs("constrictor: OpenSSL has no SHA-256\n", stderr);
    std::abort();
  }
}

}  // namespace

namespace reflect {

std::string violation(const FieldInfo& info, std::ptrdiff_t index, double found) {
  char text[192];
  char accepted[96];
  if (info.has_range) std::snprintf(accepted, sizeof(accepted), "%g to %g", info.min, info.max);
  else std::snprintf(accepted, sizeof(accepted), "finite");
  std::snprintf(text, sizeof(text), ": found %g, accepted %s%s", found, accepted, info.nan_allowed ? " or nan" : "");
  return std::string(info.name) + (index < 0 ? "" : "[" + std::to_string(index) + "]") + text;
}

std::string violation(const FieldInfo& info, const char* found_and_accepted) {
  return std::string(info.name) + ": " + found_and_accepted;
}

}  // namespace reflect

Sha256::Sha256() : context_(EVP_MD_CTX_new()) { require(EVP_DigestInit_ex(context_of(context_), EVP_sha256(), nullptr)); }

Sha256::~Sha256() { EVP_MD_CTX_free(context_of(context_)); }

void Sha256::update(std::span<const std::byte> bytes) { require(EVP_DigestUpdate(context_of(context_), bytes.data(), bytes.size())); }

Sha256::Digest Sha256::finish() {
  Digest digest{};
  require(EVP_DigestFinal_ex(context_of(context_), digest.data(), nullptr));
  require(EVP_DigestInit_ex(context_of(context_), EVP_sha256(), nullptr));
  return digest;
}

std::string hex(std::span<const std::uint8_t> bytes) {
  static constexpr char kDigits[] = "0123456789abcdef";
  std::string text;
  for (const std::uint8_t byte : bytes) {
    text += kDigits[byte >> 4];
    text += kDigits[byte & 15];
  }
  return text;
}

}  // namespace constrictor
