// The rules of `constrictor doctor`: what is wrong with a DDS domain or this host, derived from facts alone. Pure.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <string>
#include <string_view>
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
  std::vector<msg::Hello> hellos;       ///< all Hello messages that writers keep for late readers
  std::string idl_hash;                 ///< of this program
  std::vector<msg::StopState> stops{};  ///< the newest of each robot
};

/// The faults that `doctor` can find, in the order of deploy/TROUBLESHOOTING.md, which has a section for each.
inline constexpr std::array<std::string_view, 20> kFaultNames{"empty domain",
                                                              "wrong domain",
                                                              "unreadable configuration",
                                                              "wrong interface",
                                                              "missing multicast",
                                                              "small socket buffers",
                                                              "two plants",
                                                              "two members of one name",
                                                              "differing IDL hash",
                                                              "differing QoS",
                                                              "differing type",
                                                              "no DDS",
                                                              "latched stop",
                                                              "no address",
                                                              "host silent",
                                                              "port in use",
                                                              "ports closed",
                                                              "hosts differ",
                                                              "host refused",
                                                              "keys refused"};

/// One of kFaultNames; any other name does not compile.
class Fault {
 public:
  template <std::size_t N>
  consteval Fault(const char (&name)[N]) : name_(name, N - 1) {  // NOLINT(google-explicit-constructor)
    if (std::find(kFaultNames.begin(), kFaultNames.end(), name_) == kFaultNames.end())
      throw "kFaultNames does not contain this name";
  }
  operator std::string() const { return std::string(name_); }  // NOLINT(google-explicit-constructor)
  [[nodiscard]] std::string_view name() const { return name_; }
  bool operator==(const Fault&) const = default;
  /// The heading of its section as an anchor: "two-plants".
  [[nodiscard]] std::string anchor() const;

 private:
  std::string_view name_;
};

/// The page with a section for each fault, as a path for data_path().
inline constexpr const char* kTroubleshooting = "deploy/TROUBLESHOOTING.md";

struct Finding {
  Fault fault;
  std::string what;
  std::string cure;
};

/// Findings in the order in which they should be cured; empty if the facts show no fault.
std::vector<Finding> diagnose(const Facts& facts);

}  // namespace constrictor::cli
