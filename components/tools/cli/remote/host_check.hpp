// `constrictor doctor --manifest`: whether the hosts of a manifest can take part in a run.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "cli/introspection/diagnosis.hpp"
#include "cli/manifest.hpp"

namespace constrictor::cli {

/// The result of the check of one host.
struct HostReport {
  std::string name;
  std::string facts;  ///< "robot at 10.0.0.2, release 0.1.0, 4 cores"; empty if the host was not reached
  std::vector<Finding> findings;
};

/// Connects to each host, compares it with this one, and checks whether packets pass in both directions on the ports of
/// `domain`, also between each two of the others if nothing else is wrong. `secure`: the folder with the keys of a run;
/// whether they can be used is checked here and on each host, which stores them for the check only; empty: not checked.
/// Starts no run.
[[nodiscard]] std::vector<HostReport> check_hosts(const LaunchManifest& manifest, std::uint32_t domain,
                                                  const std::filesystem::path& secure);

}  // namespace constrictor::cli
