// `constrictor doctor`: finds faults that prevent processes from working together, and names the cure.
#include <fmt/format.h>
#include <ifaddrs.h>
#include <net/if.h>

#include <algorithm>
#include <cstdlib>
#include <fstream>
#include <nlohmann/json.hpp>
#include <thread>

#include "cli/introspection/diagnosis.hpp"
#include "cli/introspection/domain_view.hpp"
#include "cli/keys/keys_command.hpp"
#include "cli/launch_plan.hpp"
#include "cli/remote/host_check.hpp"
#include "cli/subcommands.hpp"
#include "cli/usage.hpp"
#include "client/run_registry.hpp"
#include "component/data_path.hpp"
#include "configuration/counted.hpp"
#include "constrictor/json.hpp"
#include "cyclone/endpoint.hpp"
#include "runtime/host.hpp"
#include "runtime/wire.hpp"

namespace constrictor::cli {
namespace {

using namespace std::chrono_literals;

constexpr int kFaults = 1;
constexpr auto kStopStateBound = 1500ms;  // the plant repeats it once a second, unless the run is paused

std::vector<NetworkInterface> interfaces() {
  std::vector<NetworkInterface> list;
  ifaddrs* first = nullptr;
  if (::getifaddrs(&first) != 0) return list;
  for (const ifaddrs* at = first; at; at = at->ifa_next) {
    const bool known =
        std::any_of(list.begin(), list.end(), [&](const auto& interface) { return interface.name == at->ifa_name; });
    if (!known) list.push_back({at->ifa_name, (at->ifa_flags & IFF_UP) != 0, (at->ifa_flags & IFF_MULTICAST) != 0});
  }
  ::freeifaddrs(first);
  return list;
}

/// The XML that CYCLONEDDS_URI holds or names.
void read_configuration(Facts& facts) {
  const char* uri = std::getenv("CYCLONEDDS_URI");
  if (!uri || !*uri) return;
  std::string text = uri;
  if (text.find('<') == std::string::npos) {
    const std::string path = text.rfind("file://", 0) == 0 ? text.substr(7) : text;
    std::ifstream file(path);
    if (!file) {
      facts.dds_configuration_error = "cannot read " + path;
      return;
    }
    text.assign(std::istreambuf_iterator<char>(file), {});
  }
  facts.dds_configuration = text;
}

std::uint64_t receive_buffer_max() {
  std::ifstream file("/proc/sys/net/core/rmem_max");
  std::uint64_t bytes = 0;
  file >> bytes;
  return bytes;
}

/// Takes the newest state of the stops of each robot.
void take_stops(const dds::Reader<msg::StopState>& reader, Facts& facts) {
  reader.take([&](const msg::StopState& state) {
    std::erase_if(facts.stops, [&](const auto& older) { return older.robot_id == state.robot_id; });
    facts.stops.push_back(state);
  });
}

void look(const DomainView& view, Facts& facts) {
  const auto stops = dds::Reader<msg::StopState>::member(view.participant(), std::string(topics::kStopState.name));
  view.settle(2500ms);
  facts.participants = view.discovery().participants();
  facts.endpoints = view.discovery().endpoints();
  const auto hellos = dds::Reader<msg::Hello>::member(view.participant(), barrier_topics::kHello);
  for (int i = 0; i < 20; ++i) {
    hellos.take([&](const msg::Hello& hello) { facts.hellos.push_back(hello); });
    if (!facts.hellos.empty() && i > 10) break;
    std::this_thread::sleep_for(20ms);
  }
  const bool stoppable = std::any_of(facts.endpoints.begin(), facts.endpoints.end(), [](const auto& endpoint) {
    return endpoint.writer && endpoint.topic == topics::kStopState.name;
  });
  const auto give_up = std::chrono::steady_clock::now() + kStopStateBound;
  for (take_stops(stops, facts); stoppable && facts.stops.empty() && std::chrono::steady_clock::now() < give_up;
       take_stops(stops, facts))
    std::this_thread::sleep_for(20ms);
}

struct Diagnosis {
  Facts facts;
  std::vector<Finding> findings;
};

/// The facts that are the same in every domain.
Facts facts_of_host() {
  Facts facts;
  for (const auto& run : live_runs()) facts.runs.push_back(run.domain);
  facts.interfaces = interfaces();
  facts.receive_buffer_max_bytes = receive_buffer_max();
  facts.idl_hash = msg::kIdlHash;
  read_configuration(facts);
  return facts;
}

Diagnosis examine(std::uint32_t domain, const Facts& host) {
  Diagnosis result{host, {}};
  Facts& facts = result.facts;
  facts.domain = domain;
  std::string error;
  try {
    ViewOptions chosen;
    chosen.domain = domain;
    // Cyclone would print again for each entity that the file cannot be opened.
    if (facts.dds_configuration_error.empty()) look(DomainView(chosen), facts);
    else error = "DDS does not start without its configuration, so the domain was not examined";
  } catch (const dds::Error& failed) {
    error = failed.what();  // Cyclone does not start with a wrong configuration; the findings name the cause
  }
  auto& findings = result.findings = diagnose(facts);
  if (!error.empty()) {
    // The domain was not examined, so whether processes are in it is unknown.
    std::erase_if(findings, [](const Finding& finding) {
      return finding.fault == Fault("empty domain") || finding.fault == Fault("wrong domain");
    });
    findings.push_back({"no DDS", error,
                        findings.empty() ? "unset CYCLONEDDS_URI, or correct it (deploy/README.md)"
                                         : "cure the findings above first"});
  }
  return result;
}

nlohmann::ordered_json json_of(const Finding& finding) {
  return {{"fault", finding.fault.name()},
          {"what", finding.what},
          {"cure", finding.cure},
          {"page", fmt::format("{}#{}", kTroubleshooting, finding.fault.anchor())}};
}

void tell(const Finding& finding) {
  fmt::print("\n{}: {}\n  cure: {}\n  more: {}#{}\n", finding.fault.name(), finding.what, finding.cure,
             data_path(kTroubleshooting).string(), finding.fault.anchor());
}

nlohmann::ordered_json json_of(const Diagnosis& diagnosis) {
  nlohmann::ordered_json json = {{"domain", diagnosis.facts.domain},
                                 {"participants", diagnosis.facts.participants.size()}};
  auto& list = json["findings"] = nlohmann::ordered_json::array();
  for (const auto& finding : diagnosis.findings) list.push_back(json_of(finding));
  return json;
}

void tell(const Diagnosis& diagnosis) {
  fmt::print("domain {}: {}, {}\n", diagnosis.facts.domain,
             counted(diagnosis.facts.participants.size(), "process", "processes"),
             counted(diagnosis.facts.endpoints.size(), "reader or writer", "readers and writers"));
  for (const auto& finding : diagnosis.findings) tell(finding);
  if (diagnosis.findings.empty()) fmt::print("no fault found\n");
}

struct DoctorOptions : ViewOptions {
  std::string manifest;  ///< name in deploy or a path; empty: no hosts are checked
  std::string secure;    ///< folder with the keys of a run on these hosts; empty: keys are not checked
};

/// Checks the hosts of a manifest.
int check_manifest(const DoctorOptions& options) {
  const LaunchManifest manifest = load_manifest(find_file(options.manifest, kManifests));
  if (manifest.hosts.empty())
    throw UsageError("--manifest: found one that names no other host, accepted one with hosts");
  if (!options.secure.empty()) {
    const std::string problems = problems_of_keys(options.secure, manifest);
    if (!problems.empty())
      throw ConfigurationError(
          fmt::format("--secure: {} cannot be used for this run:{}\n  `constrictor keys {} --manifest {}` makes what "
                      "is missing",
                      options.secure, problems, options.secure, options.manifest));
  }
  bool well = true;
  auto list = nlohmann::ordered_json::array();
  for (const auto& host : check_hosts(manifest, options.domain.value_or(1), options.secure)) {
    well = well && host.findings.empty();
    auto findings = nlohmann::ordered_json::array();
    if (!options.json) fmt::print("host {}: {}\n", host.name, host.facts.empty() ? "not reached" : host.facts);
    for (const auto& finding : host.findings) {
      findings.push_back(json_of(finding));
      if (!options.json) tell(finding);
    }
    list.push_back({{"host", host.name}, {"facts", host.facts}, {"findings", findings}});
  }
  if (options.json) fmt::print("{}\n", json_text(list, 2));
  else if (well) fmt::print("no fault found\n");
  return well ? exit_status::kOk : kFaults;
}

/// Examines the chosen domain. If none was chosen, examines the domains of all runs on this host, or domain 0 if there
/// are no runs.
int doctor(const DoctorOptions& options) {
  if (!options.manifest.empty()) return check_manifest(options);
  const Facts host = facts_of_host();
  std::vector<std::uint32_t> domains = host.runs;
  if (options.domain) domains = {*options.domain};
  if (domains.empty()) domains = {0};
  bool well = true;
  auto all = nlohmann::ordered_json::array();
  for (const std::uint32_t domain : domains) {
    const Diagnosis diagnosis = examine(domain, host);
    well = well && diagnosis.findings.empty();
    if (options.json) all.push_back(json_of(diagnosis));
    else fmt::print("{}", domain == domains.front() ? "" : "\n"), tell(diagnosis);
  }
  if (options.json) fmt::print("{}\n", json_text(all.size() == 1 ? all.front() : all, 2));
  return well ? exit_status::kOk : kFaults;
}

}  // namespace

void add_doctor(CLI::App& app, Action& action) {
  auto options = std::make_shared<DoctorOptions>();
  auto* sub = add_subcommand(app, "doctor", "find faults that keep processes from communicating, and name the cure",
                             action, options, doctor);
  add_view_options(*sub, *options);
  sub->add_option("--manifest", options->manifest,
                  "check the other hosts of this launch manifest instead: a name or a file");
  sub->add_option("--secure", options->secure,
                  "with --manifest, also check whether all hosts can use these keys: a folder of `constrictor keys`")
      ->needs("--manifest");
  sub->footer(help_footer(
      "Finds: a wrong domain or interface, missing multicast, differing IDL hash, QoS or types, two plants, two "
      "members\n"
      "of one name, small socket buffers. Without --run it examines the domains of all runs on this host; --json then\n"
      "prints a list if there are several. Each fault has a section in deploy/TROUBLESHOOTING.md. With --manifest, it "
      "connects to each host of the manifest and checks "
      "release,\n"
      "libraries, numeric profile, and whether packets pass in both directions; clocks need not agree.",
      {"constrictor doctor", "constrictor doctor --run 7 --json", "constrictor doctor --manifest my_hosts.yaml"},
      "0 no fault found; 1 a fault was found; 64 wrong usage",
      "CONSTRICTOR_DOMAIN  the domain, like --run\n  CYCLONEDDS_URI      DDS configuration; it is examined, too"));
}

}  // namespace constrictor::cli
