// Claims a DDS domain that no other run on this host uses.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

namespace constrictor {

/// Folder of the locks and notes of the runs on this host: $XDG_RUNTIME_DIR/constrictor, or /tmp/constrictor-UID. It is
/// created, for this user only, if it does not exist.
std::filesystem::path run_directory();

/// True while a process with the same run_directory() claims the domain.
bool domain_claimed(std::uint32_t domain);

/// The DDS configuration of a run on several hosts. The process that claims the domain on a host publishes it there, so
/// that every program of that host that joins the domain uses it.
class PublishedDdsConfiguration {
 public:
  PublishedDdsConfiguration() = default;
  /// This process must hold the claim of the domain. `xml`: as in CYCLONEDDS_URI, without names of files.
  PublishedDdsConfiguration(std::uint32_t domain, const std::string& xml);
  ~PublishedDdsConfiguration();
  PublishedDdsConfiguration(PublishedDdsConfiguration&& other) noexcept : file_(std::exchange(other.file_, {})) {}
  PublishedDdsConfiguration& operator=(PublishedDdsConfiguration&& other) noexcept {
    std::swap(file_, other.file_);
    return *this;
  }

 private:
  std::filesystem::path file_;
};

/// The published configuration; empty if there is none, or no process claims the domain.
std::string published_dds_configuration(std::uint32_t domain);

/// The domains from 1 to 100 that are claimed or in use on this host.
std::vector<std::uint32_t> used_domains();

/// Claims the first free domain from 1 to 100 that is not in `avoid`, or only `wanted`. The claim is a file lock and an
/// abstract socket name: the kernel frees both when the process ends in any way. A domain that is in use without a
/// claim is skipped. Throws std::runtime_error if no domain is free.
class DomainClaim {
 public:
  explicit DomainClaim(std::optional<std::uint32_t> wanted = std::nullopt, const std::set<std::uint32_t>& avoid = {});
  ~DomainClaim();
  DomainClaim(const DomainClaim&) = delete;
  DomainClaim& operator=(const DomainClaim&) = delete;
  [[nodiscard]] std::uint32_t domain() const { return domain_; }

 private:
  std::uint32_t domain_ = 0;
  int lock_ = -1, name_ = -1;
};

}  // namespace constrictor
