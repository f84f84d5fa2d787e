#include "cli/remote/host_description.hpp"

#include <arpa/inet.h>
#include <fmt/format.h>
#include <ifaddrs.h>
#include <net/if.h>
#include <netdb.h>
#include <sys/socket.h>

#include <array>
#include <fstream>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <thread>

#include "cli/launch_plan.hpp"
#include "cli/remote/message_channel.hpp"
#include "constrictor/messages.hpp"
#include "cyclone/domain_claim.hpp"
#include "cyclone/own_host.hpp"
#include "runtime/version.hpp"

namespace constrictor::cli {
namespace {

struct Address {
  std::string interface;
  std::string ip;
};

/// The IPv4 addresses of this host, that of the loopback interface left out.
std::vector<Address> addresses() {
  std::vector<Address> list;
  ifaddrs* first = nullptr;
  if (::getifaddrs(&first) != 0) return list;
  for (const ifaddrs* at = first; at; at = at->ifa_next) {
    if (!at->ifa_addr || at->ifa_addr->sa_family != AF_INET || (at->ifa_flags & IFF_LOOPBACK) != 0) continue;
    std::array<char, INET_ADDRSTRLEN> text{};
    const auto* address = reinterpret_cast<const sockaddr_in*>(at->ifa_addr);
    ::inet_ntop(AF_INET, &address->sin_addr, text.data(), text.size());
    list.push_back({at->ifa_name, text.data()});
  }
  ::freeifaddrs(first);
  return list;
}

/// The local end of a connection to `peer`; empty if there is no route. Sends nothing.
std::string local_end(const std::string& peer) {
  addrinfo hints{};
  hints.ai_family = AF_INET;
  hints.ai_socktype = SOCK_DGRAM;
  addrinfo* found = nullptr;
  if (::getaddrinfo(peer.c_str(), "9", &hints, &found) != 0) return {};
  std::string result;
  const Descriptor socket(::socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0));
  sockaddr_in own{};
  socklen_t size = sizeof(own);
  if (::connect(socket.get(), found->ai_addr, found->ai_addrlen) == 0 &&
      ::getsockname(socket.get(), reinterpret_cast<sockaddr*>(&own), &size) == 0) {
    std::array<char, INET_ADDRSTRLEN> text{};
    ::inet_ntop(AF_INET, &own.sin_addr, text.data(), text.size());
    result = text.data();
  }
  ::freeaddrinfo(found);
  return result;
}

std::uint64_t receive_buffer() {
  std::ifstream file("/proc/sys/net/core/rmem_max");
  std::uint64_t bytes = 0;
  file >> bytes;
  return bytes;
}

}  // namespace

std::string this_network() {
  std::ifstream file("/proc/sys/kernel/random/boot_id");
  std::string boot;
  file >> boot;
  std::error_code ignored;
  return boot + " " + std::filesystem::read_symlink("/proc/self/ns/net", ignored).string();
}

nlohmann::json describe_this_host() {
  nlohmann::json description = {{"protocol", kAgentProtocol},
                                {"release", kVersion},
                                {"idl_hash", std::string(msg::kIdlHash)},
                                {"cores", std::thread::hardware_concurrency()},
                                {"network", this_network()},
                                {"used_domains", used_domains()},
                                {"receive_buffer_bytes", receive_buffer()},
                                {"libraries", nlohmann::json::object()},
                                {"host", own_host()}};
  for (const auto& line : ask_host("--describe")) {
    const auto space = line.find(' ');
    const std::string key = line.substr(0, space), value = space == std::string::npos ? "" : line.substr(space + 1);
    if (key == "profile") description["numeric_profile"] = value;
    if (key == "library")
      description["libraries"][value.substr(0, value.find(' '))] = value.substr(value.find(' ') + 1);
  }
  return description;
}

std::vector<std::string> differences(const nlohmann::json& ours, const nlohmann::json& theirs) {
  std::vector<std::string> list;
  const auto compare = [&](const std::string& what, const nlohmann::json& here, const nlohmann::json& there) {
    const auto text = [](const nlohmann::json& value) {
      return value.is_null() ? "none" : value.is_string() ? value.get<std::string>() : value.dump();
    };
    if (here != there) list.push_back(fmt::format("{}: found {}, accepted {}", what, text(there), text(here)));
  };
  const auto value = [](const nlohmann::json& object, const char* name) {
    const auto found = object.find(name);
    return found == object.end() ? nlohmann::json() : *found;
  };
  compare("release", value(ours, "release"), value(theirs, "release"));
  compare("IDL hash", value(ours, "idl_hash"), value(theirs, "idl_hash"));
  compare("numeric profile", value(ours, "numeric_profile"), value(theirs, "numeric_profile"));
  const auto here = value(ours, "libraries"), there = value(theirs, "libraries");
  for (const auto& [name, version] : here.items()) compare("library " + name, version, value(there, name.c_str()));
  return list;
}

std::string own_address(const HostPlan& plan, const std::string& peer) {
  const std::string wanted = !plan.address.empty() ? plan.address : plan.interface.empty() ? local_end(peer) : "";
  std::string known;
  for (const auto& [interface, ip] : addresses()) {
    if (!wanted.empty() ? ip == wanted : interface == plan.interface) return ip;
    known += fmt::format("{}{} {}", known.empty() ? "" : ", ", interface, ip);
  }
  throw std::runtime_error(fmt::format(
      "found no network interface {}, accepted one of: {} (keys interface and address of the host in the manifest)",
      !wanted.empty()          ? "with the address " + wanted
      : plan.interface.empty() ? "that reaches " + peer
                               : plan.interface,
      known.empty() ? "none with IPv4" : known));
}

}  // namespace constrictor::cli
