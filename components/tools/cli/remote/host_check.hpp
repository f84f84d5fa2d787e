// `constrictor doctor --manifest`: whether the hosts of a manifest can take part in a run.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "cli/introspection/diagnosis.hpp"
#include "cli/manifest.hpp"

namespace constrictor::cli {

/// What was found about one host.
struct HostReport {
  std::string name;
  std::string facts;  ///< "robot at 10.0.0.2, release 0.1.0, 4 cores"; empty if the host was not reached
  std::vector<Finding> findings;
};

/// Connects to each host, compares it with this one, and checks whether packets pass in both directions on the ports of
/// `domain`. Starts no run.
[[nodiscard]] std::vector<HostReport> check_hosts(const LaunchManifest& manifest, std::uint32_t domain);

}  // namespace constrictor::cli
