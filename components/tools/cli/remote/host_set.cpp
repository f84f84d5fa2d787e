#include "cli/remote/host_set.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <fstream>
#include <random>
#include <set>
#include <thread>

#include "cli/keys/keys_command.hpp"
#include "cli/remote/dds_configuration.hpp"
#include "cli/remote/host_description.hpp"
#include "cli/remote/remote_child.hpp"
#include "configuration/configuration.hpp"

namespace constrictor::cli {
namespace {

namespace fs = std::filesystem;
using namespace std::chrono_literals;

std::string bytes_in(const fs::path& file) {
  std::ifstream stream(file, std::ios::binary);
  std::string text(std::istreambuf_iterator<char>(stream), {});
  if (!stream) throw HostError("cannot read " + file.string());
  return text;
}

}  // namespace

std::string new_hosts_token() {
  std::random_device entropy;
  return fmt::format("{:08x}{:08x}", entropy(), entropy());
}

void add_keys(const fs::path& folder, const LaunchManifest& manifest, const std::string& host,
              nlohmann::json& message) {
  auto& identities = message["identities"] = nlohmann::json::array();
  auto& keys = message["keys"] = nlohmann::json::object();
  if (folder.empty()) return;
  for (const auto& process : manifest.processes) {
    if (process.host == host && !has_own_keys(process)) identities.push_back(identity_of(process));
  }
  if (identities.empty()) return;
  for (const auto& file : files_of_identities(identities.get<std::vector<std::string>>()))
    keys[file.string()] = bytes_in(folder / file);
}

HostSet::HostSet(const LaunchManifest& manifest, HostOptions options, HostLink::Print print, std::function<void()> wait)
    : manifest_(manifest), options_(std::move(options)), print_(std::move(print)), wait_(std::move(wait)) {
  if (manifest.hosts.empty()) return;
  try {
    connect();
  } catch (...) {
    end_agents();
    throw;
  }
}

void HostSet::connect() {
  for (const auto& [name, plan] : manifest_.hosts)
    links_.push_back(std::make_unique<HostLink>(name, plan, options_.token + "-" + name, manifest_.patience_s, print_,
                                                options_.resume));
  exchange();  // the connections are made while this host describes itself
  ours_ = describe_this_host();
  for (const auto& line : ask_host("--describe")) {
    if (!line.starts_with("default ")) continue;
    const auto space = line.find(' ', 8);
    default_configs_[line.substr(8, space - 8)] = line.substr(space + 1);
  }
  while (!std::all_of(links_.begin(), links_.end(), [](const auto& link) { return !link->description().is_null(); })) {
    exchange();
    wait_();
  }
  compare();
}

void HostSet::compare() const {
  std::string all;
  for (const auto& link : links_) {
    for (const auto& difference : differences(ours_, link->description()))
      all += fmt::format("\n  host {}: {}", link->name(), difference);
  }
  if (!all.empty())
    throw HostError(
        "the hosts differ, so a run on them could have another result than a run on one host; install the same "
        "release and packages on all hosts:" +
        all);
}

void HostSet::exchange() {
  for (const auto& link : links_) link->exchange();
}

bool HostSet::exchange_until(const std::function<bool()>& done, std::chrono::milliseconds bound) {
  const auto end = std::chrono::steady_clock::now() + bound;
  while (true) {
    exchange();
    if (done()) return true;
    if (std::chrono::steady_clock::now() > end) return false;
    std::this_thread::sleep_for(5ms);
  }
}

std::set<std::uint32_t> HostSet::used_domains() const {
  std::set<std::uint32_t> used;
  for (const auto& link : links_) used.merge(link->description()["used_domains"].get<std::set<std::uint32_t>>());
  return used;
}

void HostSet::add_file(const fs::path& file) {
  if (places_.contains(file.string())) return;
  const std::string text = bytes_in(file);
  const auto number = files_.size();
  files_.push_back({{"number", number}, {"name", file.filename().string()}, {"text", text}});
  places_[file.string()] = fmt::format("files/{}/{}", number, file.filename().string());
}

std::string HostSet::continued() const {
  for (const auto& link : links_) {
    if (!link->continued().empty()) return link->continued();
  }
  return {};
}

void HostSet::prepare(std::uint32_t domain, const fs::path& report_dir, const fs::path& token_file) {
  if (links_.empty()) return;
  report_dir_ = report_dir;
  add_file(manifest_.robot_file);
  add_file(manifest_.scenario_file);
  add_file(token_file);
  if (!manifest_.faults_file.empty()) add_file(manifest_.faults_file);
  for (const auto& [component, file] : manifest_.config_files) add_file(file);
  for (const auto& process : manifest_.processes) {
    if (process.host.empty() || !process.program.empty()) continue;
    for (const auto& component : process.components) {
      if (default_configs_.contains(component)) add_file(default_configs_[component]);
    }
  }
  places_[report_dir.string()] = "output";

  const char* uri = std::getenv("CYCLONEDDS_URI");
  const std::string additional = uri ? resolve_dds_uri(uri) : "";
  const auto ip_of = [](const HostLink& link) { return link.description().value("ip", ""); };
  std::string own_ip;
  std::set<std::string> claimed{this_network()};  // each network has its domains once
  for (const auto& link : links_) {
    if (own_ip.empty() && !ip_of(*link).empty())
      own_ip = own_address(manifest_.here, link->description().value("launcher_ip", ""));
  }
  // Hosts in this host's network have no address of their own: their processes use the loopback interface.
  const auto configuration = [&](const std::string& own) {
    std::set<std::string> others;
    for (const auto& link : links_) others.insert(ip_of(*link).empty() ? own_ip : ip_of(*link));
    others.insert(own_ip);
    others.erase(own);
    return dds_configuration(own, {others.begin(), others.end()}, manifest_.packet_bytes, additional);
  };
  if (!own_ip.empty()) {
    dds_xml_ = configuration(own_ip);
    dds_ = PublishedDdsConfiguration(domain, dds_xml_);
    ::unsetenv("CYCLONEDDS_URI");  // the published configuration contains it
  }
  for (const auto& link : links_) {
    const std::string ip = ip_of(*link);
    const bool claim = claimed.insert(link->description().value("network", "")).second;
    nlohmann::json message = {{"op", "prepare"},
                              {"domain", domain},
                              {"claim", claim},
                              {"files", files_},
                              {"keep", options_.keep},
                              {"resume", options_.resume && link->name() == manifest_.host_of_plant()},
                              {"dds", own_ip.empty() ? additional : configuration(ip.empty() ? own_ip : ip)}};
    add_keys(options_.secure, manifest_, link->name(), message);
    link->prepare(message);
  }
  while (!std::all_of(links_.begin(), links_.end(), [](const auto& link) { return link->prepared(); })) {
    exchange();
    wait_();
  }
  for (const auto& link : links_) {
    const nlohmann::json& description = link->description();
    print_(fmt::format("host {}: {} {}, {} cores", link->name(), description.value("host", ""),
                       description.value("ip", ""), description.value("cores", 0)));
  }
}

std::string HostSet::there(const HostLink& link, const std::string& argument) const {
  if (const auto place = places_.find(argument); place != places_.end()) return link.folder() + "/" + place->second;
  const auto equals = argument.find('=');
  const auto place = equals == std::string::npos ? places_.end() : places_.find(argument.substr(equals + 1));
  if (place == places_.end()) return argument;
  return argument.substr(0, equals + 1) + link.folder() + "/" + place->second;
}

std::unique_ptr<Child> HostSet::start(const ProcessPlan& plan, std::uint32_t incarnation,
                                      const std::vector<std::string>& argv, const std::vector<std::string>& environment,
                                      const fs::path& log) {
  if (plan.host.empty()) {
    std::vector<std::string> with_dds = environment;
    if (!dds_xml_.empty()) with_dds.push_back("CYCLONEDDS_URI=" + dds_xml_);
    return Supervisor::start_here(plan, incarnation, argv, with_dds, log);
  }
  HostLink& link =
      **std::find_if(links_.begin(), links_.end(), [&](const auto& each) { return each->name() == plan.host; });
  std::vector<std::string> arguments;
  for (std::size_t i = 1; i < argv.size(); ++i) arguments.push_back(there(link, argv[i]));
  for (const auto& component : plan.components) {
    const auto config = default_configs_.find(component);
    if (!plan.program.empty() || config == default_configs_.end() || manifest_.config_files.contains(component))
      continue;
    arguments.insert(arguments.end(), {"--config", component + "=" + there(link, config->second)});
  }
  const fs::path program = argv.front();
  link.start(plan.name(), incarnation,
             {{"op", "start"},
              {"name", plan.name()},
              {"incarnation", incarnation},
              {"program", program.parent_path() == program_folder() ? program.filename().string() : program.string()},
              {"arguments", arguments},
              {"environment", plan.environment}},
             log);
  return std::make_unique<RemoteChild>(link, plan.name());
}

nlohmann::ordered_json HostSet::report() const {
  if (links_.empty()) return nullptr;
  nlohmann::ordered_json hosts;
  const auto add = [&](const std::string& name, const nlohmann::json& description, const std::string& ssh) {
    auto& entry = hosts[name];
    for (const char* key : {"host", "ip", "cores", "release", "idl_hash", "numeric_profile", "libraries"}) {
      if (description.contains(key)) entry[key] = description[key];
    }
    if (!ssh.empty()) entry["ssh"] = ssh;
  };
  add("here", ours_, "");
  for (const auto& link : links_) add(link->name(), link->description(), link->plan().ssh);
  return hosts;
}

}  // namespace constrictor::cli
