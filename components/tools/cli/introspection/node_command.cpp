// `constrictor node`: the processes of a domain.
#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <set>

#include "cli/introspection/domain_view.hpp"
#include "cli/run_observer.hpp"
#include "cli/subcommands.hpp"
#include "cli/usage.hpp"
#include "client/components.hpp"
#include "configuration/closest_name.hpp"
#include "constrictor/constants.hpp"
#include "constrictor/json.hpp"
#include "runtime/host.hpp"

namespace constrictor::cli {
namespace {

using Json = nlohmann::ordered_json;

struct NodeOptions {
  ViewOptions view;
  std::string node;
};

/// One participant: what discovery found, and the newest Hello and status of its components.
Json node_json(const dds::Participant& participant, const std::vector<dds::Participant>& participants,
               const std::vector<dds::Endpoint>& endpoints, const std::map<std::string, ComponentMessages>& members) {
  const std::string name = DomainView::name_of(participant.guid, participants, endpoints);
  Json node = {{"node", name},
               {"host", participant.host},
               {"pid", participant.pid},
               {"process", participant.program},
               {"participant", dds::short_name(participant.guid)}};
  std::set<std::string> writes;
  std::set<std::string> reads;
  for (const auto& endpoint : endpoints) {
    if (endpoint.participant == participant.guid) (endpoint.writer ? writes : reads).insert(endpoint.topic);
  }
  node["components"] = Json::array();
  for (const auto& component : CLI::detail::split(name, ',')) {
    const auto found = members.find(component);
    if (found == members.end()) continue;
    const auto& [hello, status] = found->second;
    Json entry = {{"component", component}};
    if (hello) {
      entry["incarnation"] = hello->incarnation;
      entry["version"] = hello->version;
      entry["idl_hash"] = hello->idl_hash;
      entry["config_hash"] = hello->config_hash;
      entry["numeric_profile"] = hello->numeric_profile;
      entry["period_ticks"] = hello->period_ticks;
      entry["latency_ticks"] = hello->latency_ticks;
    }
    if (status) {
      entry["state"] = name_of(constants::kComponent, status->state);
      entry["tick"] = status->tick;
    }
    node["components"].push_back(entry);
  }
  node["writes"] = writes;
  node["reads"] = reads;
  return node;
}

std::vector<Json> nodes(const DomainView& view) {
  view.settle_or_throw();
  const auto members = read_component_messages(view.participant());
  const auto participants = view.discovery().participants();
  const auto endpoints = view.discovery().endpoints();
  std::vector<Json> list;
  list.reserve(participants.size());
  for (const auto& participant : participants) list.push_back(node_json(participant, participants, endpoints, members));
  std::sort(list.begin(), list.end(), [](const Json& a, const Json& b) { return a["node"] < b["node"]; });
  return list;
}

std::string first_of(const Json& node, const char* key) {
  return node["components"].empty() ? "-" : node["components"][0].value(key, std::string("-"));
}

int list_nodes(const NodeOptions& options) {
  const DomainView view(options.view);
  const auto found = nodes(view);
  if (options.view.json) {
    fmt::print("{}\n", json_text(Json(found), 2));
    return exit_status::kOk;
  }
  fmt::print("{:<28} {:<18} {:>8} {:<18} {:<10} {:<12} {:>6} {:>6}\n", "node", "host", "pid", "process", "version",
             "IDL hash", "writes", "reads");
  for (const auto& node : found) {
    fmt::print("{:<28} {:<18} {:>8} {:<18} {:<10} {:<12} {:>6} {:>6}\n", node["node"].get<std::string>(),
               node["host"].get<std::string>(), node["pid"].get<std::int64_t>(), node["process"].get<std::string>(),
               first_of(node, "version"), first_of(node, "idl_hash").substr(0, 12), node["writes"].size(),
               node["reads"].size());
  }
  return exit_status::kOk;
}

int show_node(const NodeOptions& options) {
  const DomainView view(options.view);
  Json chosen = Json::array();
  std::vector<std::string> known;
  for (const auto& node : nodes(view)) {
    const auto names = CLI::detail::split(node["node"].get<std::string>(), ',');
    known.insert(known.end(), names.begin(), names.end());
    if (node["node"] == options.node || std::to_string(node["pid"].get<std::int64_t>()) == options.node ||
        std::count(names.begin(), names.end(), options.node) > 0) {
      chosen.push_back(node);
    }
  }
  if (chosen.empty()) {
    fmt::print(stderr,
               "node info: no process in DDS domain {} has the name or pid '{}' or hosts such a component{} "
               "(see `constrictor node list`)\n",
               view.domain(), options.node, did_you_mean(options.node, known));
    return exit_status::kSoftware;
  }
  if (options.view.json) {
    fmt::print("{}\n", json_text(chosen, 2));
    return exit_status::kOk;
  }
  for (const auto& node : chosen) {
    fmt::print("{}: process {}, pid {} on {}, participant {}\n", node["node"].get<std::string>(),
               node["process"].get<std::string>(), node["pid"].get<std::int64_t>(), node["host"].get<std::string>(),
               node["participant"].get<std::string>());
    for (const auto& component : node["components"]) {
      fmt::print("\n");
      for (const auto& [key, value] : component.items())
        fmt::print("  {:<16} {}\n", key, value.is_string() ? value.get<std::string>() : json_text(value));
    }
    for (const char* side : {"writes", "reads"}) {
      fmt::print("\n  {}:\n", side);
      for (const auto& topic : node[side]) fmt::print("    {}\n", topic.get<std::string>());
    }
  }
  return exit_status::kOk;
}

}  // namespace

void add_node(CLI::App& app, Action& action) {
  auto options = std::make_shared<NodeOptions>();
  auto* node = add_group(app, "node", "list or describe the processes of a DDS domain");
  node->footer(help_footer(
      "A node is a DDS participant: one per process and domain, also of programs that are no part of this project.",
      {"constrictor node list", "constrictor node info navigation --json"},
      "0 done; 64 wrong usage; 70 no such node or run", kDomainEnvironment));
  auto* list_app =
      add_subcommand(*node, "list", "list every process: host, pid, version, IDL hash", action, options, list_nodes);
  add_view_options(*list_app, options->view);
  auto* info_app =
      add_subcommand(*node, "info", "describe one process: its components and its topics", action, options, show_node);
  info_app->add_option("NODE", options->node, "a component, the name of a node, or a process id")->required();
  add_view_options(*info_app, options->view);
}

}  // namespace constrictor::cli
