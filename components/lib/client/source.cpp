#include "client/source.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <chrono>

#include "cyclone/own_host.hpp"

namespace constrictor {

std::string unique_source(const std::string& name) {
  // A source holds 31 bytes. The process id must not be cut: it makes the name unique.
  return fmt::format("{:.11}.{:.11}.{}", name, own_host(), ::getpid());
}

std::uint64_t first_sequence_number() {
  const auto since_1970 = std::chrono::system_clock::now().time_since_epoch();
  return static_cast<std::uint64_t>(std::chrono::duration_cast<std::chrono::microseconds>(since_1970).count());
}

}  // namespace constrictor
