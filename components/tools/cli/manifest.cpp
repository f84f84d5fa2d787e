#include "cli/manifest.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <set>
#include <stdexcept>

#include "component/component.hpp"
#include "component/data_path.hpp"
#include "configuration/closest_name.hpp"
#include "configuration/configuration.hpp"

namespace constrictor::cli {

std::string ProcessPlan::name() const {
  std::string name;
  for (const auto& component : components) name += (name.empty() ? "" : "+") + component;
  return name;
}

std::vector<std::string> LaunchManifest::roster() const {
  if (!order.empty()) return order;
  std::vector<std::string> names;
  for (const auto& process : processes) names.insert(names.end(), process.components.begin(), process.components.end());
  return names;
}

namespace {

Scheduling read_scheduling(Configuration from) {
  Scheduling scheduling;
  scheduling.priority = static_cast<int>(from.integer("priority", 0, 99, scheduling.priority));
  scheduling.lock_memory = from.flag("lock_memory", scheduling.lock_memory);
  if (const std::string cpus = from.text("cpus", {}, ""); !cpus.empty()) {
    try {
      scheduling.cpus = parse_cpus(cpus);
    } catch (const std::invalid_argument& error) {
      throw from.error("cpus", error.what());
    }
  }
  from.finish();
  return scheduling;
}

/// The scheduling of a process that hosts the components of both.
Scheduling join(const Scheduling& a, const Scheduling& b) {
  Scheduling both{std::max(a.priority, b.priority), a.lock_memory || b.lock_memory, {}};
  if (!a.cpus.empty() && !b.cpus.empty())
    std::set_union(a.cpus.begin(), a.cpus.end(), b.cpus.begin(), b.cpus.end(), std::back_inserter(both.cpus));
  return both;
}

std::vector<std::string> read_environment(Configuration& entry) {
  std::vector<std::string> variables = entry.texts("environment");
  for (const std::string& variable : variables) {
    if (variable.find('=') == std::string::npos || variable.front() == '=')
      throw entry.error("environment", fmt::format("found '{}', accepted NAME=VALUE", variable));
  }
  return variables;
}

}  // namespace

LaunchManifest load_manifest(const std::filesystem::path& file) {
  Configuration root = Configuration::load(file);
  LaunchManifest manifest;
  manifest.plant = root.text("plant");
  manifest.robot_file = data_path(root.text("robot"));
  manifest.scenario_file = data_path(root.text("scenario"));
  manifest.patience_s = root.number("patience_s", {1, 86400}, manifest.patience_s);
  manifest.real_time = root.flag("real_time", false);
  for (Configuration& entry : root.list("beside", false)) {
    CompanionPlan companion{entry.text("program"), {}};
    if (entry.has("arguments")) companion.arguments = entry.texts("arguments");
    entry.finish();
    manifest.beside.push_back(std::move(companion));
  }
  std::set<std::string> known;
  for (Configuration& entry : root.list("processes")) {
    ProcessPlan process;
    process.components = entry.texts("components");
    if (process.components.empty()) throw entry.error("components", "found none, accepted at least one component");
    process.program = entry.text("program", {}, "");
    process.restarts = static_cast<int>(entry.integer("restarts", 0, 1'000'000, process.restarts));
    process.host = entry.text("host", {}, "");
    if (entry.has("environment")) process.environment = read_environment(entry);
    const bool has_latency = entry.has("latency_ticks");
    const auto latency = static_cast<std::uint16_t>(entry.integer("latency_ticks", 1, kLargestLatency_ticks, 1));
    Configuration configs = entry.section("config", false);
    for (const auto& component : process.components) {
      if (!known.insert(component).second)
        throw entry.error("components", "found " + component + " twice, accepted once");
      if (configs.has(component)) manifest.config_files[component] = data_path(configs.text(component));
      if (has_latency) {
        if (component == manifest.plant)
          throw entry.error("latency_ticks",
                            "found it at the process of the plant, accepted at other processes, "
                            "because the plant's outputs are visible at once");
        manifest.latency_ticks[component] = latency;
      }
    }
    configs.finish();
    process.scheduling = read_scheduling(entry.section("scheduling", false));
    entry.finish();
    manifest.processes.push_back(std::move(process));
  }
  if (!known.contains(manifest.plant))
    throw root.error("plant", "found " + manifest.plant + ", accepted a component of processes");
  if (root.has("roster")) {
    manifest.order = root.texts("roster");
    if (manifest.order.size() != known.size() || std::set(manifest.order.begin(), manifest.order.end()) != known)
      throw root.error("roster", fmt::format("found {}, accepted each of {} once", fmt::join(manifest.order, ", "),
                                             fmt::join(known, ", ")));
  }
  manifest.packet_bytes = static_cast<int>(root.integer("packet_bytes", 1400, 65500, manifest.packet_bytes));
  read_hosts(root, manifest);
  root.finish();
  return manifest;
}

void regroup(LaunchManifest& manifest, const std::vector<std::vector<std::string>>& groups) {
  const std::vector<std::string> roster = manifest.roster();
  std::set<std::string> grouped;
  std::vector<ProcessPlan> processes;
  for (const auto& group : groups) {
    ProcessPlan together;
    for (const auto& component : group) {
      const auto home =
          std::find_if(manifest.processes.begin(), manifest.processes.end(), [&](const ProcessPlan& process) {
            return std::count(process.components.begin(), process.components.end(), component) > 0;
          });
      if (home == manifest.processes.end())
        throw ConfigurationError(fmt::format("--group: found component '{}', accepted {}{}", component,
                                             fmt::join(roster, ", "), did_you_mean(component, roster)));
      if (!grouped.insert(component).second)
        throw ConfigurationError("--group: found component '" + component + "' twice, accepted once");
      if (!together.components.empty() && together.host != home->host)
        throw ConfigurationError(
            fmt::format("--group: found {} and {}, which the manifest puts on different hosts; "
                        "accepted components of one host, or --in-process",
                        together.components.front(), component));
      together.scheduling =
          together.components.empty() ? home->scheduling : join(together.scheduling, home->scheduling);
      together.host = home->host;
      together.components.push_back(component);
      if (!home->program.empty()) together.program = home->program;
      together.restarts = std::min(together.restarts, home->restarts);
      together.environment.insert(together.environment.end(), home->environment.begin(), home->environment.end());
    }
    if (!together.components.empty()) processes.push_back(std::move(together));
  }
  for (ProcessPlan rest : manifest.processes) {
    std::erase_if(rest.components, [&](const std::string& component) { return grouped.contains(component); });
    if (!rest.components.empty()) processes.push_back(std::move(rest));
  }
  manifest.processes = std::move(processes);
}

std::vector<std::string> latency_arguments(const LaunchManifest& manifest) {
  std::vector<std::string> arguments;
  for (const auto& [name, ticks] : manifest.latency_ticks)
    arguments.insert(arguments.end(), {"--latency", fmt::format("{}={}", name, ticks)});
  return arguments;
}

std::vector<std::string> config_arguments(const LaunchManifest& manifest, const std::vector<std::string>& components) {
  std::vector<std::string> arguments;
  for (const auto& component : components) {
    const auto config = manifest.config_files.find(component);
    if (config == manifest.config_files.end()) continue;
    arguments.insert(arguments.end(), {"--config", component + "=" + config->second.string()});
  }
  return arguments;
}

}  // namespace constrictor::cli
