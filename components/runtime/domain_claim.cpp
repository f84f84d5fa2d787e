#include "runtime/domain_claim.hpp"

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include <cstdlib>
#include <stdexcept>
#include <string>

namespace constrictor {

std::filesystem::path run_directory() {
  const char* runtime = std::getenv("XDG_RUNTIME_DIR");
  const std::filesystem::path directory = runtime && *runtime ? std::filesystem::path(runtime) / "constrictor"
                                                              : std::filesystem::path("/tmp/constrictor-" + std::to_string(::getuid()));
  std::filesystem::create_directories(directory);
  return directory;
}

DomainClaim::DomainClaim() {
  const auto directory = run_directory();
  for (std::uint32_t domain = 1; domain <= 100; ++domain) {
    const auto file = directory / ("domain-" + std::to_string(domain) + ".lock");
    // Not inherited: a child must not keep the claim of a launcher that died.
    const int lock = ::open(file.c_str(), O_CREAT | O_RDWR | O_CLOEXEC, 0600);
    if (lock < 0) continue;
    if (::flock(lock, LOCK_EX | LOCK_NB) == 0) {
      domain_ = domain;
      lock_ = lock;
      return;
    }
    ::close(lock);
  }
  throw std::runtime_error("no free DDS domain: 1 to 100 are claimed by locks in " + directory.string());
}

DomainClaim::~DomainClaim() {
  if (lock_ >= 0) ::close(lock_);
}

}  // namespace constrictor
