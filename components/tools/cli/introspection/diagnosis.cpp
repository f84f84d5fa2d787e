#include "cli/introspection/diagnosis.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <map>
#include <regex>
#include <set>
#include <sstream>

#include "runtime/wire.hpp"

namespace constrictor::cli {
namespace {

namespace wire = barrier_topics;

/// Smallest sufficient receive buffer: room for an uncompressed image of 640 x 480 pixels and the messages that arrive
/// at the same time.
constexpr std::uint64_t kEnoughBuffer_bytes = 1024 * 1024;

using Findings = std::vector<Finding>;

std::string process_of(const Facts& facts, const dds::Guid& participant) {
  for (const auto& known : facts.participants) {
    if (known.guid == participant) return fmt::format("pid {} on {}", known.pid, known.host.empty() ? "?" : known.host);
  }
  return "participant " + dds::short_name(participant);
}

std::string processes_of(const Facts& facts, const std::set<dds::Guid>& participants) {
  std::vector<std::string> names;
  names.reserve(participants.size());
  for (const auto& participant : participants) names.push_back(process_of(facts, participant));
  return fmt::format("{}", fmt::join(names, " and "));
}

void check_domain(const Facts& facts, Findings& found) {
  if (!facts.participants.empty()) return;
  if (facts.runs.empty()) {
    found.push_back({"empty domain",
                     fmt::format("no process is in domain {}, and no run is on this host", facts.domain),
                     "start one with `constrictor run`; for a run on another host set CYCLONEDDS_URI "
                     "(deploy/cyclonedds/hosts.xml)"});
  } else {
    found.push_back({"wrong domain",
                     fmt::format("no process is in domain {}; the runs on this host are in {}", facts.domain,
                                 fmt::join(facts.runs, ", ")),
                     fmt::format("use --run {} or CONSTRICTOR_DOMAIN={}", facts.runs.front(), facts.runs.front())});
  }
}

void check_interface(const Facts& facts, Findings& found) {
  if (!facts.dds_configuration_error.empty()) {
    found.push_back({"unreadable configuration", "CYCLONEDDS_URI: " + facts.dds_configuration_error,
                     "correct the path, or unset CYCLONEDDS_URI for a run on this host alone"});
    return;
  }
  static const std::regex element("<NetworkInterface\\s[^>]*>");
  static const std::regex name_of("\\bname=\"([^\"]*)\"");
  static const std::regex multicast_of("\\bmulticast=\"([^\"]*)\"");
  static const std::regex allow("<AllowMulticast>\\s*([^<]*?)\\s*</AllowMulticast>");
  static const std::regex peer("<Peer\\s");
  const std::string& xml = facts.dds_configuration;
  if (xml.empty()) return;  // the built-in configuration uses loopback and finds peers without multicast
  std::smatch match;
  const bool forbidden = std::regex_search(xml, match, allow) && match[1] == "false";
  const bool peers = std::regex_search(xml, peer);
  bool multicast = !forbidden;
  std::vector<std::string> names;
  for (std::sregex_iterator at(xml.begin(), xml.end(), element), end; at != end; ++at) {
    const std::string text = at->str();
    std::smatch part;
    if (std::regex_search(text, part, multicast_of) && part[1] == "false") multicast = false;
    if (std::regex_search(text, part, name_of)) names.push_back(part[1]);
  }
  for (const auto& name : names) {
    const auto interface = std::find_if(facts.interfaces.begin(), facts.interfaces.end(),
                                        [&](const auto& known) { return known.name == name; });
    if (interface == facts.interfaces.end()) {
      std::vector<std::string> known;
      for (const auto& other : facts.interfaces) known.push_back(other.name);
      found.push_back({"wrong interface",
                       fmt::format("CYCLONEDDS_URI names interface '{}', which this host does not have", name),
                       fmt::format("name one of {}", fmt::join(known, ", "))});
    } else if (!interface->up) {
      found.push_back({"wrong interface", fmt::format("CYCLONEDDS_URI names interface '{}', which is down", name),
                       fmt::format("ip link set {} up", name)});
    } else if (multicast && !interface->multicast && !peers) {
      found.push_back(
          {"missing multicast",
           fmt::format(
               "interface '{}' cannot multicast, and CYCLONEDDS_URI lists no peers: no process is found over it", name),
           fmt::format("ip link set {} multicast on, or AllowMulticast false and a <Peer Address=...> for each host "
                       "(deploy/cyclonedds/hosts.xml)",
                       name)});
    }
  }
  if (!multicast && !peers) {
    found.push_back({"missing multicast",
                     "CYCLONEDDS_URI allows no multicast and lists no peers: no other process is found",
                     "add a <Peer Address=...> for each host (deploy/cyclonedds/hosts.xml), or allow multicast"});
  }
}

void check_buffers(const Facts& facts, Findings& found) {
  if (facts.receive_buffer_max_bytes == 0 || facts.receive_buffer_max_bytes >= kEnoughBuffer_bytes ||
      facts.dds_configuration.empty())
    return;
  found.push_back({"small socket buffers",
                   fmt::format("a socket may buffer only {} bytes: under load, images of several fragments are lost",
                               facts.receive_buffer_max_bytes),
                   fmt::format("sysctl -w net.core.rmem_max={}, and in CYCLONEDDS_URI "
                               "<Internal><SocketReceiveBufferSize min=\"1MB\"/></Internal>",
                               4 * kEnoughBuffer_bytes)});
}

void check_names(const Facts& facts, Findings& found) {
  std::set<dds::Guid> plants;
  std::map<std::string, std::set<dds::Guid>> members;
  for (const auto& endpoint : facts.endpoints) {
    if (endpoint.writer && endpoint.topic == wire::kTick.name) plants.insert(endpoint.participant);
    std::istringstream names(endpoint.user_data);
    for (std::string name; std::getline(names, name, ',');) members[name].insert(endpoint.participant);
  }
  if (plants.size() > 1) {
    found.push_back(
        {"two plants",
         fmt::format("{} plants publish ticks in domain {}: {}", plants.size(), facts.domain,
                     processes_of(facts, plants)),
         "end one of them, or give each run its own domain (--domain; `constrictor run` chooses a free one)"});
  }
  for (const auto& [name, participants] : members) {
    if (participants.size() < 2) continue;
    if (plants.size() > 1 && std::includes(plants.begin(), plants.end(), participants.begin(), participants.end()))
      continue;  // "two plants" already reports this fault
    found.push_back(
        {"two members of one name",
         fmt::format("{} processes host '{}': {}", participants.size(), name, processes_of(facts, participants)),
         fmt::format("end one of them: only one process may host '{}'", name)});
  }
}

void check_idl(const Facts& facts, Findings& found) {
  std::map<std::string, std::set<std::string>> by_hash;
  for (const auto& hello : facts.hellos)
    by_hash[hello.idl_hash].insert(fmt::format("{} (version {}, {})", hello.component, hello.version, hello.host));
  for (const auto& [hash, who] : by_hash) {
    if (hash == facts.idl_hash) continue;
    found.push_back({"differing IDL hash",
                     fmt::format("IDL hash of {}: {}; of this program: {}", fmt::join(who, ", "), hash.substr(0, 12),
                                 facts.idl_hash.substr(0, 12)),
                     "build or install the same version on every host, then restart the run"});
  }
}

void check_qos(const Facts& facts, Findings& found) {
  std::set<std::string> told;
  for (const auto& reader : facts.endpoints) {
    if (reader.writer) continue;
    for (const auto& writer : facts.endpoints) {
      if (!writer.writer || writer.topic != reader.topic) continue;
      const std::string why = dds::mismatch(writer, reader);
      if (why.empty()) continue;
      const std::string what =
          fmt::format("{}: the reader in {} cannot receive from the writer in {}: {}", reader.topic,
                      process_of(facts, reader.participant), process_of(facts, writer.participant), why);
      if (!told.insert(what).second) continue;
      const bool same_type = writer.type == reader.type && writer.keyed == reader.keyed;
      found.push_back(
          {same_type ? Fault("differing QoS") : Fault("differing type"), what,
           same_type ? "let the reader request no more than the writer offers; idl/README.md lists both for every topic"
                     : "build both with the same IDL"});
    }
  }
}

void check_stops(const Facts& facts, Findings& found) {
  for (const auto& stop : facts.stops) {
    if (!stop.stopped) continue;
    const std::string source = stop.source;
    const bool watchdog = source == "bus_watchdog";
    found.push_back(
        {"latched stop",
         fmt::format("robot {} holds its posture since tick {} because of the emergency stop of {}{}", stop.robot_id,
                     stop.since_tick, source.empty() ? "an unknown source" : source,
                     watchdog ? ": the bus of its servos was silent, and they have locked their goals" : ""),
         "look at the robot, and then: constrictor clear-stop (it starts no motion)"});
  }
}

}  // namespace

std::string Fault::anchor() const {
  std::string text(name_);
  std::transform(text.begin(), text.end(), text.begin(),
                 [](unsigned char c) { return c == ' ' ? '-' : static_cast<char>(std::tolower(c)); });
  return text;
}

std::vector<Finding> diagnose(const Facts& facts) {
  Findings found;
  check_interface(facts, found);
  check_domain(facts, found);
  check_names(facts, found);
  check_idl(facts, found);
  check_qos(facts, found);
  check_buffers(facts, found);
  check_stops(facts, found);
  return found;
}

}  // namespace constrictor::cli
