// The name of this host.
#pragma once

#include <unistd.h>

#include <string>

namespace constrictor {

/// The name of this host as it is in messages: at most 63 bytes.
[[nodiscard]] inline std::string own_host() {
  char name[64] = {};
  ::gethostname(name, sizeof(name) - 1);
  return name;
}

}  // namespace constrictor
