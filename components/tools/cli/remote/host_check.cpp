#include "cli/remote/host_check.hpp"

#include <arpa/inet.h>
#include <fmt/format.h>
#include <netinet/in.h>
#include <sys/socket.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <functional>
#include <memory>
#include <thread>

#include "cli/remote/host_description.hpp"
#include "cli/remote/host_link.hpp"
#include "cli/remote/host_set.hpp"

namespace constrictor::cli {
namespace {

using namespace std::chrono_literals;
using Clock = std::chrono::steady_clock;

constexpr double kReachBound_s = 20;
constexpr auto kReachBound = 20s;
constexpr auto kEchoBound = 3s;     // for a packet that comes back
constexpr auto kAnswerBound = 10s;  // for the answer of an agent, whose host may be busy
constexpr auto kLinkEndBound = 5s;
constexpr const char* kPortsCure = "open the UDP ports from 7400 to 32649 between the hosts, in both directions";

const Finding kSilentAgent{"host silent", "its agent did not answer", "look at the load of the host"};

/// Of the first participant in a domain (RTPS 2.3, 9.6.1.1).
std::uint16_t first_port(std::uint32_t domain) { return static_cast<std::uint16_t>(7400 + 250 * domain + 10); }

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
  if (ip.empty()) return;  // the same network: the loopback interface
  const std::uint16_t port = first_port(domain);
  std::string own;
  try {
    own = own_address(manifest.here, link.description().value("launcher_ip", ""));
  } catch (const std::runtime_error& error) {
    report.findings.push_back({"no address", error.what(), "set `here: {interface: ...}` in the manifest"});
    return;
  }
  link.echo(port);
  if (!wait_until(
          link, [&] { return !link.echo_answer().is_null(); }, kAnswerBound)) {
    report.findings.push_back(kSilentAgent);
  } else if (const std::string error = link.echo_answer().value("error", ""); !error.empty()) {
    report.findings.push_back({"port in use", fmt::format("UDP port {} of {}: {}", port, ip, error),
                               "end the run that uses this domain there, or choose another one with --domain N"});
  } else if (!packets_pass(link, own, ip, port)) {
    report.findings.push_back(
        {"ports closed", fmt::format("no packet to UDP port {} of {} came back to {}", port, ip, own), kPortsCure});
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
            link, [&] { return link.prepared(); }, kAnswerBound))
      report.findings.push_back(kSilentAgent);
    else report.facts += fmt::format(", {} identities in order", message["identities"].size());
  } catch (const HostError& error) {
    report.findings.push_back({"keys refused", error.what(), kKeysCure});
  }
}

/// The link of a check that is independent of all others.
std::unique_ptr<HostLink> check_link(const std::string& name, const HostPlan& plan) {
  return std::make_unique<HostLink>(name, plan,
                                    "doctor-" + std::to_string(Clock::now().time_since_epoch().count()) + "-" + name,
                                    kReachBound_s, [](const std::string&) {});
}

/// Whether packets pass between each two of the other hosts; this one need not be between them.
void check_pairs(const LaunchManifest& manifest, std::uint16_t port, std::vector<HostReport>& reports) {
  std::vector<std::unique_ptr<HostLink>> links;
  const auto each = [&](const std::function<bool(HostLink&)>& done, std::chrono::milliseconds bound) {
    return std::all_of(links.begin(), links.end(), [&](const auto& link) {
      return wait_until(
          *link, [&] { return done(*link); }, bound);
    });
  };
  for (const auto& [name, plan] : manifest.hosts) links.push_back(check_link(name, plan));
  bool there_again = each([](HostLink& link) { return !link.description().is_null(); }, kReachBound);
  for (const auto& link : links) link->echo(port);
  there_again = there_again && each([](HostLink& link) { return !link.echo_answer().is_null(); }, kAnswerBound);
  if (!there_again) {
    reports.front().findings.push_back(kSilentAgent);
    return;
  }
  const auto ip_of = [](const HostLink& link) { return link.description().value("ip", ""); };
  for (std::size_t from = 0; from < links.size(); ++from) {
    for (std::size_t to = 0; to < links.size(); ++to) {
      const std::string here = ip_of(*links[from]), there = ip_of(*links[to]);
      if (here.empty() || there.empty() || here == there) continue;  // the launcher's network, or one and the same
      links[from]->probe(here, there, port);
      wait_until(
          *links[from],
          [&] {
            links[to]->exchange();
            return !links[from]->probe_answer().is_null();
          },
          kEchoBound + kAnswerBound);
      if (const auto& answer = links[from]->probe_answer(); !answer.is_null() && answer.value("passed", false))
        continue;
      reports[from].findings.push_back(
          {"ports closed",
           fmt::format("no packet from {} to UDP port {} of {} ({}) came back", here, port, links[to]->name(), there),
           kPortsCure});
    }
  }
  for (const auto& link : links) link->end(false);
  each([](HostLink& link) { return link.ended(); }, kLinkEndBound);
}

HostReport check_host(const std::string& name, const HostPlan& plan, const LaunchManifest& manifest,
                      const nlohmann::json& ours, std::uint32_t domain, const std::filesystem::path& secure) {
  HostReport report{name, "", {}};
  const auto own_link = check_link(name, plan);
  HostLink& link = *own_link;
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
  const bool all_well =
      std::all_of(reports.begin(), reports.end(), [](const HostReport& report) { return report.findings.empty(); });
  try {
    if (all_well && reports.size() > 1) check_pairs(manifest, first_port(domain), reports);
  } catch (const HostError& error) {
    reports.front().findings.push_back({"host refused", error.what(), "repeat the check: this host was there before"});
  }
  return reports;
}

}  // namespace constrictor::cli
