// The rules of `constrictor doctor`: what is wrong with a DDS domain or this host, derived from facts alone. Pure.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "constrictor/messages.hpp"
#include "cyclone/discovery.hpp"

namespace constrictor::cli {

struct NetworkInterface {
  std::string name;
  bool up = false;
  bool multicast = false;
};

/// The input of the rules.
struct Facts {
  std::uint32_t domain = 0;
  std::vector<std::uint32_t> runs;      ///< DDS domains of the runs on this host
  std::string dds_configuration;        ///< XML that CYCLONEDDS_URI names; empty: the built-in one for loopback
  std::string dds_configuration_error;  ///< why the XML cannot be read; empty if it can be read
  std::vector<NetworkInterface> interfaces;
  std::uint64_t receive_buffer_max_bytes = 0;  ///< net.core.rmem_max; 0: unknown
  std::vector<dds::Participant> participants;
  std::vector<dds::Endpoint> endpoints;
  std::vector<msg::Hello> hellos;  ///< all Hello messages that writers keep for late readers
  std::string idl_hash;            ///< of this program
};

struct Finding {
  std::string fault;  ///< short name, also for scripts: "two plants"
  std::string what;
  std::string cure;
};

/// Findings in the order in which they should be cured; empty if the facts show no fault.
std::vector<Finding> diagnose(const Facts& facts);

}  // namespace constrictor::cli
