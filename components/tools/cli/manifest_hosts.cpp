// The part of a launch manifest that describes hosts.
#include <arpa/inet.h>
#include <fmt/format.h>
#include <yaml-cpp/yaml.h>

#include <algorithm>

#include "cli/manifest.hpp"
#include "configuration/closest_name.hpp"
#include "configuration/configuration.hpp"

namespace constrictor::cli {
namespace {

constexpr const char* kLocal = "local";
constexpr double kShortestPatience_s = 3.0;  ///< [s] processes on several hosts may need as long to find each other

/// True if a shell or ssh cannot read the text as anything but a name or path.
bool harmless(const std::string& text, const std::string& also) {
  return !text.empty() && text.front() != '-' && std::all_of(text.begin(), text.end(), [&](unsigned char c) {
    return (c < 128 && std::isalnum(c) != 0) || also.find(static_cast<char>(c)) != std::string::npos;
  });
}

/// The text of an optional key, which contains only letters, digits and the characters `also`.
std::string plain_text(Configuration& entry, const char* key, const std::string& also, const char* example) {
  std::string text = entry.text(key, {}, "");
  if (entry.has(key) && !harmless(text, also))
    throw entry.error(key,
                      fmt::format("found '{}', accepted letters, digits and {}, for example {}", text, also, example));
  return text;
}

HostPlan read_host(Configuration entry) {
  HostPlan host;
  host.ssh = plain_text(entry, "ssh", "@._-:/[]", "user@10.0.0.2");
  host.interface = plain_text(entry, "interface", "._-@:", "eth0");
  host.address = entry.text("address", {}, "");
  in_addr parsed{};
  if (entry.has("address") && ::inet_pton(AF_INET, host.address.c_str(), &parsed) != 1)
    throw entry.error("address",
                      fmt::format("found '{}', accepted an IPv4 address, for example 10.0.0.2", host.address));
  host.directory = plain_text(entry, "directory", "/._-+~", "/opt/constrictor or ~/constrictor");
  if (host.directory.string().find('~', host.directory.string().starts_with("~/") ? 1 : 0) != std::string::npos)
    throw entry.error("directory", fmt::format("found '{}', accepted ~ only in ~/ at the beginning, which is the home "
                                               "directory of the user of ssh",
                                               host.directory.string()));
  if (host.ssh.empty() && !host.directory.empty())
    throw entry.error("directory", "found one of the launcher's own host, accepted only together with ssh");
  entry.finish();
  return host;
}

}  // namespace

bool has_own_keys(const ProcessPlan& process) {
  return std::any_of(process.environment.begin(), process.environment.end(),
                     [](const std::string& variable) { return variable.starts_with("CONSTRICTOR_SECURITY="); });
}

std::string LaunchManifest::host_of_plant() const {
  for (const auto& process : processes) {
    const auto& hosted = process.components;
    if (std::find(hosted.begin(), hosted.end(), plant) != hosted.end()) return process.host;
  }
  return {};
}

void read_hosts(Configuration& root, LaunchManifest& manifest) {
  Configuration section = root.section("hosts", false);
  std::vector<std::string> names;
  for (const auto& entry : YAML::Load(root.one_line("hosts"))) names.push_back(entry.first.as<std::string>());
  std::string here;  // the name of the launcher's own host
  for (const auto& name : names) {
    if (!harmless(name, "._-"))
      throw section.error(name, "found this name, accepted letters, digits, '.', '_' and '-'");
    const bool local = section.one_line(name) == kLocal;
    HostPlan host = local ? HostPlan{} : read_host(section.section(name));
    if (!host.ssh.empty()) {
      manifest.hosts[name] = std::move(host);
      continue;
    }
    if (!here.empty())
      throw section.error(
          name, fmt::format("found a second host without ssh, beside {}, accepted one: the launcher's", here));
    here = name;
    manifest.here = std::move(host);
  }
  section.finish();
  for (auto& process : manifest.processes) {
    if (process.host.empty() || manifest.hosts.contains(process.host)) continue;
    if (process.host != here)
      throw root.error("processes", fmt::format("{}: found host {}, accepted {}{}", process.name(), process.host,
                                                names.empty() ? "a name that hosts: describes"
                                                              : fmt::format("{}", fmt::join(names, ", ")),
                                                did_you_mean(process.host, names)));
    process.host.clear();
  }
  if (!manifest.hosts.empty() && manifest.patience_s < kShortestPatience_s)
    throw root.error("patience_s", fmt::format("found {:g}, accepted at least {:g} for a run on several hosts, whose "
                                               "processes may need as long to find each other",
                                               manifest.patience_s, kShortestPatience_s));
  // A host without a process needs no connection.
  std::erase_if(manifest.hosts, [&](const auto& entry) {
    return std::none_of(manifest.processes.begin(), manifest.processes.end(),
                        [&](const ProcessPlan& process) { return process.host == entry.first; });
  });
}

}  // namespace constrictor::cli
