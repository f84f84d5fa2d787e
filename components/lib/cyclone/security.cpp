#include "cyclone/security.hpp"

#include <fmt/format.h>
#include <openssl/pem.h>
#include <openssl/x509.h>
#include <unistd.h>

#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <memory>
#include <stdexcept>

#include "cyclone/domain_claim.hpp"

namespace constrictor::dds {
namespace {

namespace fs = std::filesystem;

fs::path published_file(std::uint32_t domain) { return run_directory() / fmt::format("run-{}.security", domain); }

std::string file_uri(const fs::path& file) { return "file:" + file.string(); }

}  // namespace

fs::path security_folder(std::uint32_t domain) {
  const char* folder = std::getenv("CONSTRICTOR_SECURITY");
  if (folder && *folder) return folder;
  std::string published;
  std::ifstream stream(published_file(domain));
  if (!stream || !domain_claimed(domain)) return {};  // without a claim, a launcher that died has left the file
  std::getline(stream, published);
  return published;
}

PublishedSecurity::PublishedSecurity(std::uint32_t domain, const fs::path& folder) : file_(published_file(domain)) {
  std::error_code ignored;
  fs::remove(file_, ignored);
  if (!folder.empty()) std::ofstream(file_) << fs::absolute(folder).string() << "\n";
}

PublishedSecurity::~PublishedSecurity() {
  std::error_code ignored;
  fs::remove(file_, ignored);
}

std::string problem_of_identity(const fs::path& folder, const std::string& identity) {
  const fs::path own = folder / identity;
  for (const fs::path& file : {folder / "identity_ca.pem", folder / "permissions_ca.pem", folder / "governance.p7s",
                               own / "certificate.pem", own / "key.pem", own / "permissions.p7s"}) {
    if (::access(file.c_str(), R_OK) != 0) return fmt::format("{}: cannot be read", file.string());
  }
  const fs::path file = own / "certificate.pem";
  const std::unique_ptr<std::FILE, int (*)(std::FILE*)> opened(std::fopen(file.c_str(), "r"), std::fclose);
  const std::unique_ptr<X509, void (*)(X509*)> certificate(
      opened ? PEM_read_X509(opened.get(), nullptr, nullptr, nullptr) : nullptr, X509_free);
  if (!certificate) return fmt::format("{}: found no certificate", file.string());
  if (X509_cmp_current_time(X509_get0_notAfter(certificate.get())) < 0)
    return fmt::format("{}: the certificate has expired", file.string());
  if (X509_cmp_current_time(X509_get0_notBefore(certificate.get())) > 0)
    return fmt::format("{}: the certificate is not valid yet (is the clock of this host right?)", file.string());
  return {};
}

void set_identity(dds_qos_t* qos, const fs::path& folder, const std::string& identity) {
  const std::string problem = problem_of_identity(folder, identity);
  if (!problem.empty())
    throw std::runtime_error(fmt::format("DDS Security: {}; `constrictor keys` makes and renews these files", problem));
  const fs::path own = folder / identity;
  const auto set = [qos](const char* name, const std::string& value) { dds_qset_prop(qos, name, value.c_str()); };
  set("dds.sec.auth.library.path", "dds_security_auth");
  set("dds.sec.auth.library.init", "init_authentication");
  set("dds.sec.auth.library.finalize", "finalize_authentication");
  set("dds.sec.crypto.library.path", "dds_security_crypto");
  set("dds.sec.crypto.library.init", "init_crypto");
  set("dds.sec.crypto.library.finalize", "finalize_crypto");
  set("dds.sec.access.library.path", "dds_security_ac");
  set("dds.sec.access.library.init", "init_access_control");
  set("dds.sec.access.library.finalize", "finalize_access_control");
  set("dds.sec.auth.identity_ca", file_uri(folder / "identity_ca.pem"));
  set("dds.sec.auth.identity_certificate", file_uri(own / "certificate.pem"));
  set("dds.sec.auth.private_key", file_uri(own / "key.pem"));
  set("dds.sec.access.permissions_ca", file_uri(folder / "permissions_ca.pem"));
  set("dds.sec.access.governance", file_uri(folder / "governance.p7s"));
  set("dds.sec.access.permissions", file_uri(own / "permissions.p7s"));
}

}  // namespace constrictor::dds
