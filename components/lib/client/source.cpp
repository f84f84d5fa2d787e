#include "client/source.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <chrono>

namespace constrictor {

std::string unique_source(const std::string& name) {
  char host[64] = {};
  ::gethostname(host, sizeof(host) - 1);
  // A source holds 31 bytes. The process id must not be cut: it makes the name unique.
  return fmt::format("{:.11}.{:.11}.{}", name, host, ::getpid());
}

std::uint64_t first_sequence_number() {
  const auto since_1970 = std::chrono::system_clock::now().time_since_epoch();
  return static_cast<std::uint64_t>(std::chrono::duration_cast<std::chrono::microseconds>(since_1970).count());
}

}  // namespace constrictor
