// The DDS configuration of a run on several hosts, made by the launcher for each of them.
#pragma once

#include <string>
#include <vector>

namespace constrictor::cli {

/// The configuration, as XML for Cyclone DDS, of a host with the IPv4 address `own`: processes of this host reach each
/// other on the loopback interface, and those of the hosts `others` on the interface with that address.
/// Processes announce themselves every 2 s instead of every 8 s, because announcements are lost in a black-out.
/// `message_bytes`: the largest packet. `additional`: what CYCLONEDDS_URI contained, merged after it; its settings take
/// precedence.
[[nodiscard]] std::string dds_configuration(const std::string& own, const std::vector<std::string>& others,
                                            int message_bytes, const std::string& additional);

/// The XML that a value of CYCLONEDDS_URI stands for: files are replaced by their content. Throws ConfigurationError if
/// a file cannot be read.
[[nodiscard]] std::string resolve_dds_uri(const std::string& uri);

}  // namespace constrictor::cli
