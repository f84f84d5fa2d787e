// A DDS domain that no other run on this host uses.
#pragma once

#include <cstdint>
#include <filesystem>

namespace constrictor {

/// $XDG_RUNTIME_DIR/constrictor, or /tmp/constrictor-UID: locks and notes of the runs on this host. Created if missing.
std::filesystem::path run_directory();

/// Claims the first free domain of 1 to 100 by a file lock, which the kernel gives back however the process ends.
/// Throws std::runtime_error if all are taken.
class DomainClaim {
 public:
  DomainClaim();
  ~DomainClaim();
  DomainClaim(const DomainClaim&) = delete;
  DomainClaim& operator=(const DomainClaim&) = delete;
  [[nodiscard]] std::uint32_t domain() const { return domain_; }

 private:
  std::uint32_t domain_ = 0;
  int lock_ = -1;
};

}  // namespace constrictor
