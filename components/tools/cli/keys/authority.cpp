#include "cli/keys/authority.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <openssl/bio.h>
#include <openssl/err.h>
#include <openssl/pem.h>
#include <openssl/pkcs7.h>
#include <openssl/rand.h>
#include <openssl/x509v3.h>
#include <unistd.h>

#include <cstdint>
#include <cstdio>
#include <stdexcept>

namespace constrictor::cli {
namespace {

namespace fs = std::filesystem;

constexpr const char* kOrganisation = "constrictor";
constexpr long kDay_s = 24L * 3600L;

using Bio = std::unique_ptr<BIO, int (*)(BIO*)>;
using File = std::unique_ptr<std::FILE, int (*)(std::FILE*)>;

[[noreturn]] void fail(const std::string& what) {
  char reason[256] = {};
  ERR_error_string_n(ERR_get_error(), reason, sizeof reason);
  throw std::runtime_error(fmt::format("{}: {}", what, reason));
}

void require(bool success, const char* what) {
  if (!success) fail(what);
}

File open(const fs::path& file, const char* mode) {
  File opened(std::fopen(file.c_str(), mode), std::fclose);
  if (!opened) throw std::runtime_error(fmt::format("{}: {}", file.string(), ::strerrordesc_np(errno)));
  return opened;
}

PrivateKey new_key() {
  PrivateKey key(EVP_EC_gen("P-256"), EVP_PKEY_free);
  require(key != nullptr, "EVP_EC_gen");
  return key;
}

void set_name(X509_NAME* name, const std::string& common_name) {
  const auto add = [&](const char* field, const std::string& text) {
    require(X509_NAME_add_entry_by_txt(name, field, MBSTRING_UTF8, reinterpret_cast<const unsigned char*>(text.c_str()),
                                       -1, -1, 0) == 1,
            "X509_NAME_add_entry_by_txt");
  };
  add("CN", common_name);
  add("O", kOrganisation);
}

void add_extension(X509* certificate, int kind, const char* value) {
  X509_EXTENSION* extension = X509V3_EXT_conf_nid(nullptr, nullptr, kind, value);
  require(extension != nullptr, "X509V3_EXT_conf_nid");
  const bool added = X509_add_ext(certificate, extension, -1) == 1;
  X509_EXTENSION_free(extension);
  require(added, "X509_add_ext");
}

/// A certificate of `key`, signed by `issuer`; null: by itself, as an authority.
Certificate new_certificate(const EVP_PKEY& key, const std::string& name, int days, const Identity* issuer) {
  Certificate certificate(X509_new(), X509_free);
  require(certificate != nullptr, "X509_new");
  auto* own = const_cast<EVP_PKEY*>(&key);
  std::uint64_t serial = 0;
  require(RAND_bytes(reinterpret_cast<unsigned char*>(&serial), sizeof serial) == 1, "RAND_bytes");
  require(X509_set_version(certificate.get(), X509_VERSION_3) == 1, "X509_set_version");
  require(ASN1_INTEGER_set_uint64(X509_get_serialNumber(certificate.get()), serial >> 1 | 1) == 1, "serial number");
  // From an hour ago, because the clocks of hosts differ.
  require(X509_gmtime_adj(X509_getm_notBefore(certificate.get()), -3600) != nullptr, "X509_gmtime_adj");
  require(X509_time_adj_ex(X509_getm_notAfter(certificate.get()), days, 0, nullptr) != nullptr, "X509_time_adj_ex");
  require(X509_set_pubkey(certificate.get(), own) == 1, "X509_set_pubkey");
  X509_NAME* subject = X509_get_subject_name(certificate.get());
  set_name(subject, name);
  X509_NAME* issuer_name = issuer ? X509_get_subject_name(issuer->certificate.get()) : subject;
  require(X509_set_issuer_name(certificate.get(), issuer_name) == 1, "X509_set_issuer_name");
  add_extension(certificate.get(), NID_basic_constraints, issuer ? "critical,CA:FALSE" : "critical,CA:TRUE");
  add_extension(certificate.get(), NID_key_usage,
                issuer ? "critical,digitalSignature,keyAgreement" : "critical,keyCertSign,digitalSignature");
  require(X509_sign(certificate.get(), issuer ? issuer->key.get() : own, EVP_sha256()) > 0, "X509_sign");
  return certificate;
}

}  // namespace

std::string subject_of(const std::string& name) { return fmt::format("CN={},O={}", name, kOrganisation); }

void write_certificate(const fs::path& file, const X509& certificate) {
  const File opened = open(file, "w");
  require(PEM_write_X509(opened.get(), const_cast<X509*>(&certificate)) == 1, "PEM_write_X509");
}

void write_key(const fs::path& file, const EVP_PKEY& key) {
  std::error_code ignored;
  fs::remove(file, ignored);
  const int descriptor = ::open(file.c_str(), O_CREAT | O_EXCL | O_WRONLY | O_CLOEXEC, 0600);
  if (descriptor < 0) throw std::runtime_error(fmt::format("{}: {}", file.string(), ::strerrordesc_np(errno)));
  const File opened(::fdopen(descriptor, "w"), std::fclose);
  require(PEM_write_PrivateKey(opened.get(), const_cast<EVP_PKEY*>(&key), nullptr, nullptr, 0, nullptr, nullptr) == 1,
          "PEM_write_PrivateKey");
}

Authority::Authority(const fs::path& certificate_file, const fs::path& key_file, const std::string& name, int days)
    : own_{{nullptr, EVP_PKEY_free}, {nullptr, X509_free}} {
  if (!fs::exists(key_file) && !fs::exists(certificate_file)) {
    own_.key = new_key();
    own_.certificate = new_certificate(*own_.key, name, days, nullptr);
    write_key(key_file, *own_.key);
    write_certificate(certificate_file, *own_.certificate);
    return;
  }
  own_.key.reset(PEM_read_PrivateKey(open(key_file, "r").get(), nullptr, nullptr, nullptr));
  own_.certificate.reset(PEM_read_X509(open(certificate_file, "r").get(), nullptr, nullptr, nullptr));
  if (!own_.key || !own_.certificate || X509_check_private_key(own_.certificate.get(), own_.key.get()) != 1) {
    throw std::runtime_error(
        fmt::format("{} and {}: found no certificate with its private key, accepted the two files "
                    "that `constrictor keys` has written, or none of them",
                    certificate_file.string(), key_file.string()));
  }
}

Identity Authority::issue(const std::string& name, int days) const {
  PrivateKey key = new_key();
  Certificate certificate = new_certificate(*key, name, days, &own_);
  return {std::move(key), std::move(certificate)};
}

std::string Authority::sign(const std::string& document) const {
  const Bio text(BIO_new_mem_buf(document.data(), static_cast<int>(document.size())), BIO_free);
  const Bio out(BIO_new(BIO_s_mem()), BIO_free);
  constexpr int kFlags = PKCS7_DETACHED | PKCS7_TEXT | PKCS7_STREAM;
  const std::unique_ptr<PKCS7, void (*)(PKCS7*)> signature(
      PKCS7_sign(own_.certificate.get(), own_.key.get(), nullptr, text.get(), kFlags), PKCS7_free);
  require(signature != nullptr, "PKCS7_sign");
  require(SMIME_write_PKCS7(out.get(), signature.get(), text.get(), kFlags) == 1, "SMIME_write_PKCS7");
  char* bytes = nullptr;
  const long size = BIO_get_mem_data(out.get(), &bytes);
  return {bytes, static_cast<std::size_t>(size)};
}

}  // namespace constrictor::cli
