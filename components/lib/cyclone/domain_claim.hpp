// Claims a DDS domain that no other run on this host uses.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>

namespace constrictor {

/// Folder of the locks and notes of the runs on this host: $XDG_RUNTIME_DIR/constrictor, or /tmp/constrictor-UID. It is
/// created if it does not exist.
std::filesystem::path run_directory();

/// True while a process with the same run_directory() claims the domain.
bool domain_claimed(std::uint32_t domain);

/// Claims the first free domain from 1 to 100, or only `wanted`. The claim is a file lock and an abstract socket name:
/// the kernel frees both when the process ends in any way. A domain that is in use without a claim is skipped. Throws
/// std::runtime_error if no domain is free.
class DomainClaim {
 public:
  explicit DomainClaim(std::optional<std::uint32_t> wanted = std::nullopt);
  ~DomainClaim();
  DomainClaim(const DomainClaim&) = delete;
  DomainClaim& operator=(const DomainClaim&) = delete;
  [[nodiscard]] std::uint32_t domain() const { return domain_; }

 private:
  std::uint32_t domain_ = 0;
  int lock_ = -1, name_ = -1;
};

}  // namespace constrictor
