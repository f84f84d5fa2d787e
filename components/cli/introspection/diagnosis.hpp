// What can be wrong with a domain or this host, from facts alone: the rules of `constrictor doctor`. Pure.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "constrictor/messages.hpp"
#include "runtime/dds/discovery.hpp"

namespace constrictor::cli {

struct NetworkInterface {
  std::string name;
  bool up = false;
  bool multicast = false;
};

/// Everything the rules look at.
struct Facts {
  std::uint32_t domain = 0;
  std::vector<std::uint32_t> runs;                   ///< domains of the live runs on this host
  std::string dds_configuration;                     ///< XML that CYCLONEDDS_URI names; empty: the loopback default
  std::string dds_configuration_error;               ///< why it cannot be read; empty: it can
  std::vector<NetworkInterface> interfaces;
  std::uint64_t receive_buffer_max_bytes = 0;        ///< net.core.rmem_max; 0: unknown
  std::vector<dds::Participant> participants;
  std::vector<dds::Endpoint> endpoints;
  std::vector<msg::Hello> hellos;                    ///< all that are kept, of every writer
  std::string idl_hash;                              ///< this program's own
};

struct Finding {
  std::string fault;  ///< short name for scripts: "two plants"
  std::string what;
  std::string cure;
};

/// In the order in which they should be cured. Empty: nothing is wrong that can be seen from here.
std::vector<Finding> diagnose(const Facts& facts);

}  // namespace constrictor::cli
