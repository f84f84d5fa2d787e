// Certificates and signed documents of DDS Security, made with OpenSSL.
#pragma once

#include <openssl/evp.h>
#include <openssl/x509.h>

#include <filesystem>
#include <memory>
#include <string>

namespace constrictor::cli {

using PrivateKey = std::unique_ptr<EVP_PKEY, void (*)(EVP_PKEY*)>;
using Certificate = std::unique_ptr<X509, void (*)(X509*)>;

/// A certificate with its private key (elliptic curve P-256).
struct Identity {
  PrivateKey key;
  Certificate certificate;
};

/// Signs the certificates of others, or documents.
class Authority {
 public:
  /// Reads the authority's two files, or makes a new authority with the common name `name` if there are none. The
  /// private key goes to `key_file` (mode 0600). Throws std::runtime_error.
  Authority(const std::filesystem::path& certificate_file, const std::filesystem::path& key_file,
            const std::string& name, int days);
  /// A new identity whose certificate this authority has signed.
  [[nodiscard]] Identity issue(const std::string& name, int days) const;
  /// The document with its signature, in the form (S/MIME) that DDS Security 1.1 requires of governance and
  /// permissions.
  [[nodiscard]] std::string sign(const std::string& document) const;

 private:
  Identity own_;
};

/// Writes a certificate, or a private key (mode 0600), as PEM. Throws std::runtime_error.
void write_certificate(const std::filesystem::path& file, const X509& certificate);
void write_key(const std::filesystem::path& file, const EVP_PKEY& key);

/// The subject of the certificate of an identity, as permissions name it: "CN=control,O=constrictor".
std::string subject_of(const std::string& name);

}  // namespace constrictor::cli
