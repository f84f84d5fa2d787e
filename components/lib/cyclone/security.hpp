// DDS Security: the files with which a participant proves who it is and what it may read and write.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

#include "cyclone/entity.hpp"

namespace constrictor::dds {

/// The folder that `constrictor keys` has made, for the participants of a domain: $CONSTRICTOR_SECURITY, or the one
/// that the launcher of the domain's run on this host has published. Empty: the run is not secured.
[[nodiscard]] std::filesystem::path security_folder(std::uint32_t domain);

/// Publishes the folder until this object is destroyed. The owner must hold the claim of the domain.
class PublishedSecurity {
 public:
  PublishedSecurity(std::uint32_t domain, const std::filesystem::path& folder);
  ~PublishedSecurity();
  PublishedSecurity(const PublishedSecurity&) = delete;
  PublishedSecurity& operator=(const PublishedSecurity&) = delete;

 private:
  std::filesystem::path file_;
};

/// Sets the properties of a participant with this identity. Throws std::runtime_error if problem_of_identity() names a
/// problem.
void set_identity(dds_qos_t* qos, const std::filesystem::path& folder, const std::string& identity);

/// Why the files of an identity cannot be used: one is missing, or the certificate has expired. Empty: they can.
[[nodiscard]] std::string problem_of_identity(const std::filesystem::path& folder, const std::string& identity);

}  // namespace constrictor::dds
