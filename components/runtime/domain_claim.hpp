// A DDS domain that no other run on this host uses.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>

namespace constrictor {

/// $XDG_RUNTIME_DIR/constrictor, or /tmp/constrictor-UID: locks and notes of the runs on this host. Created if missing.
std::filesystem::path run_directory();

/// True while some process that keeps its notes in this `run_directory` holds a claim on the domain.
bool domain_claimed(std::uint32_t domain);

/// Claims the first free domain of 1 to 100, or `wanted` and no other, by a file lock and a name in the network namespace, which the
/// kernel gives back however the process ends. A domain that somebody talks in without a claim is passed over. Throws std::runtime_error if there is none.
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
