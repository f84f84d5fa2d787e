// The description of a host by its agent, and the check whether this host can take part in a run.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "cli/manifest.hpp"

namespace constrictor::cli {

/// This host: {protocol, release, idl_hash, numeric_profile, libraries {name: version}, host, cores, used_domains,
/// network, receive_buffer_bytes}. Runs constrictor_host, which loads the libraries that compute.
[[nodiscard]] nlohmann::json describe_this_host();

/// The differences between this host (`ours`) and another one (`theirs`) that change results or prevent that their
/// processes understand each other: release, IDL, numeric profile, libraries. One text for each.
[[nodiscard]] std::vector<std::string> differences(const nlohmann::json& ours, const nlohmann::json& theirs);

/// Identifies the network of this host: processes with the same network reach each other on the loopback interface.
[[nodiscard]] std::string this_network();

/// The IPv4 address of this host that `plan` chooses: its address, that of its interface, or the one by which this host
/// reaches `peer` (the local end of a connection to it). Throws std::runtime_error that lists the interfaces.
[[nodiscard]] std::string own_address(const HostPlan& plan, const std::string& peer);

}  // namespace constrictor::cli
