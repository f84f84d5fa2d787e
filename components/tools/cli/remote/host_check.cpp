#include "cli/remote/host_check.hpp"

#include <arpa/inet.h>
#include <fmt/format.h>
#include <netinet/in.h>
#include <sys/socket.h>

#include <array>
#include <chrono>
#include <functional>
#include <thread>

#include "cli/remote/host_description.hpp"
#include "cli/remote/host_link.hpp"
#include "cli/remote/host_set.hpp"

namespace constrictor::cli {
namespace {

using namespace std::chrono_literals;
using Clock = std::chrono::steady_clock;

constexpr double kReachBound_s = 20;
constexpr auto kEchoBound = 3s;
constexpr auto kLinkEndBound = 5s;

/// Calls exchange() until `done` returns true. False after `bound`.
bool wait_until(HostLink& link, const std::function<bool()>& done, std::chrono::milliseconds bound) {
  const auto end = Clock::now() + bound;
  while (true) {
    link.exchange();
    if (done()) return true;
    if (Clock::now() > end) return false;
    std::this_thread::sleep_for(5ms);
  }
}

/// Whether the host sends back a packet. Packets are repeated, because a link may lose some.
bool packets_pass(HostLink& link, const std::string& own, const std::string& other, std::uint16_t port) {
  const Descriptor socket(::socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0));
  const auto address_of = [](const std::string& ip, std::uint16_t number) {
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_port = htons(number);
    ::inet_pton(AF_INET, ip.c_str(), &address.sin_addr);
    return address;
  };
  const sockaddr_in from = address_of(own, port), to = address_of(other, port);
  static_cast<void>(::bind(socket.get(), reinterpret_cast<const sockaddr*>(&from), sizeof(from)));
  auto next = Clock::now();
  return wait_until(
      link,
      [&] {
        if (Clock::now() >= next) {
          next += 100ms;
          ::sendto(socket.get(), "echo", 4, 0, reinterpret_cast<const sockaddr*>(&to), sizeof(to));
        }
        std::array<char, 8> bytes{};
        return ::recv(socket.get(), bytes.data(), bytes.size(), 0) == 4;
      },
      kEchoBound);
}

void check_network(HostLink& link, const LaunchManifest& manifest, std::uint32_t domain, HostReport& report) {
  const std::string ip = link.description().value("ip", "");
  if (ip.empty()) return;                                                  // the same network: the loopback interface
  const auto port = static_cast<std::uint16_t>(7400 + 250 * domain + 10);  // RTPS 2.3, 9.6.1.1: the first participant's
  std::string own;
  try {
    own = own_address(manifest.here, link.description().value("launcher_ip", ""));
  } catch (const std::runtime_error& error) {
    report.findings.push_back({"no address", error.what(), "set `here: {interface: ...}` in the manifest"});
    return;
  }
  link.echo(port);
  if (!wait_until(
          link, [&] { return !link.echo_answer().is_null(); }, kEchoBound)) {
    report.findings.push_back({"host silent", "its agent did not answer", "look at the load of the host"});
  } else if (const std::string error = link.echo_answer().value("error", ""); !error.empty()) {
    report.findings.push_back({"port in use", fmt::format("UDP port {} of {}: {}", port, ip, error),
                               "end the run that uses this domain there, or choose another one with --run"});
  } else if (!packets_pass(link, own, ip, port)) {
    report.findings.push_back({"ports closed",
                               fmt::format("no packet to UDP port {} of {} came back to {}", port, ip, own),
                               "open the UDP ports from 7400 to 32649 between the hosts, in both directions"});
  }
}

constexpr const char* kKeysCure =
    "`constrictor keys DIR` with the same manifest makes and renews keys; set the clock of a host that is wrong";

/// Lets the host store the keys of its processes and examine them, with its own clock.
void check_keys(HostLink& link, const LaunchManifest& manifest, std::uint32_t domain,
                const std::filesystem::path& secure, HostReport& report) {
  nlohmann::json message = {{"op", "prepare"},
                            {"domain", domain},
                            {"claim", false},
                            {"keep", false},
                            {"resume", false},
                            {"dds", ""},
                            {"files", nlohmann::json::array()}};
  try {
    add_keys(secure, manifest, link.name(), message);
    link.prepare(message);
    if (!wait_until(
            link, [&] { return link.prepared(); }, kEchoBound))
      report.findings.push_back({"host silent", "its agent did not answer", "look at the load of the host"});
    else report.facts += fmt::format(", {} identities in order", message["identities"].size());
  } catch (const HostError& error) {
    report.findings.push_back({"keys refused", error.what(), kKeysCure});
  }
}

HostReport check_host(const std::string& name, const HostPlan& plan, const LaunchManifest& manifest,
                      const nlohmann::json& ours, std::uint32_t domain, const std::filesystem::path& secure) {
  HostReport report{name, "", {}};
  HostLink link(name, plan, "doctor-" + std::to_string(Clock::now().time_since_epoch().count()) + "-" + name,
                kReachBound_s, [](const std::string&) {});
  try {
    while (link.description().is_null()) {
      link.exchange();
      std::this_thread::sleep_for(5ms);
    }
    const auto& theirs = link.description();
    report.facts = fmt::format("{}{}, release {}, {} cores", theirs.value("host", ""),
                               theirs.value("ip", "").empty() ? "" : " at " + theirs.value("ip", ""),
                               theirs.value("release", ""), theirs.value("cores", 0));
    for (const auto& difference : differences(ours, theirs))
      report.findings.push_back({"hosts differ", difference, "install the same release and packages on all hosts"});
    check_network(link, manifest, domain, report);
    if (!secure.empty()) check_keys(link, manifest, domain, secure, report);
    link.end(false);
    static_cast<void>(wait_until(
        link, [&] { return link.ended(); }, kLinkEndBound));
  } catch (const HostError& error) {
    report.findings.push_back({"host refused", error.what(),
                               "make `ssh " + plan.ssh +
                                   "` work without a question, and install the release "
                                   "there (deploy/README.md, Several hosts)"});
  }
  return report;
}

}  // namespace

std::vector<HostReport> check_hosts(const LaunchManifest& manifest, std::uint32_t domain,
                                    const std::filesystem::path& secure) {
  const nlohmann::json ours = describe_this_host();
  std::vector<HostReport> reports;
  for (const auto& [name, plan] : manifest.hosts)
    reports.push_back(check_host(name, plan, manifest, ours, domain, secure));
  return reports;
}

}  // namespace constrictor::cli
