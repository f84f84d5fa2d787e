// `constrictor topic`: list, info, echo, hz and delay of any topic on a domain, also of types this project does not
// define.
#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <optional>

#include "cli/introspection/domain_view.hpp"
#include "cli/introspection/topic_watch.hpp"
#include "cli/subcommands.hpp"
#include "cli/usage.hpp"
#include "client/command_error.hpp"
#include "constrictor/json.hpp"
#include "constrictor/topics.hpp"
#include "cyclone/type_tree.hpp"
#include "runtime/host.hpp"

namespace constrictor::cli {
namespace {

using Json = nlohmann::ordered_json;

struct Options {
  ViewOptions view;
  WatchOptions watch;
  bool all = false;
};

/// The columns of the project's table of topics that are written for people.
struct Description {
  std::string_view doc;
  std::string_view rate;
};

/// Empty if the project does not define the topic.
std::optional<Description> described(const std::string& topic) {
  for (const auto& info : topics::kInfos) {
    if (info.name == topic) return Description{info.doc, info.rate};
  }
  for (const auto& info : barrier_topics::kInfos) {
    if (info.name == topic) return Description{info.doc, info.rate};
  }
  return std::nullopt;
}

int list(const Options& options) {
  const DomainView view(options.view);
  view.settle_or_throw();
  struct Row {
    std::string type;
    int writers = 0;
    int readers = 0;
  };
  std::map<std::string, Row> rows;
  for (const auto& endpoint : view.discovery().endpoints()) {
    auto& row = rows[endpoint.topic];
    row.type = endpoint.type;
    ++(endpoint.writer ? row.writers : row.readers);
  }
  if (options.view.json) {
    Json json = Json::array();
    for (const auto& [name, row] : rows) {
      const auto info = described(name);
      json.push_back({{"topic", name},
                      {"type", row.type},
                      {"writers", row.writers},
                      {"readers", row.readers},
                      {"what", info ? Json(std::string(info->doc)) : Json(nullptr)}});
    }
    fmt::print("{}\n", json_text(json, 2));
    return exit_status::kOk;
  }
  fmt::print("{:<28} {:<40} {:>7} {:>7}  {}\n", "topic", "type", "writers", "readers", "content");
  for (const auto& [name, row] : rows) {
    fmt::print("{:<28} {:<40} {:>7} {:>7}  {}\n", name, row.type, row.writers, row.readers,
               described(name).value_or(Description{}).doc);
  }
  return exit_status::kOk;
}

int info(const Options& options) {
  const DomainView view(options.view);
  view.settle();
  const auto endpoints = view.discovery().endpoints();
  const auto participants = view.discovery().participants();
  std::vector<dds::Endpoint> here;
  std::copy_if(endpoints.begin(), endpoints.end(), std::back_inserter(here),
               [&](const auto& endpoint) { return endpoint.topic == options.watch.topic; });
  if (here.empty()) {
    throw CommandError(no_such_topic(view, options.watch.topic));
  }
  const auto with_type =
      std::find_if(here.begin(), here.end(), [](const auto& endpoint) { return endpoint.type_info != nullptr; });
  const auto tree =
      with_type == here.end() ? nullptr : dds::TypeTree::find(view.participant(), *with_type, std::chrono::seconds(2));
  const auto topic = described(options.watch.topic);
  Json json = {{"topic", options.watch.topic}, {"type", here.front().type}, {"keyed", here.front().keyed}};
  if (topic) json["what"] = std::string(topic->doc), json["rate"] = std::string(topic->rate);
  json["fields"] = tree ? Json(tree->text()) : Json(nullptr);
  for (const bool writer : {true, false}) {
    auto& list = json[writer ? "writers" : "readers"] = Json::array();
    for (const auto& endpoint : here) {
      if (endpoint.writer != writer) continue;
      Json entry = {{"node", DomainView::name_of(endpoint.participant, participants, endpoints)},
                    {"qos", dds::describe(endpoint.qos)}};
      if (endpoint.type != here.front().type) entry["type"] = endpoint.type;
      for (const auto& participant : participants) {
        if (participant.guid == endpoint.participant) entry["host"] = participant.host, entry["pid"] = participant.pid;
      }
      for (const auto& other : here) {
        if (writer || !other.writer) continue;
        const std::string why = dds::mismatch(other, endpoint);
        if (!why.empty())
          entry["deaf_to"].push_back(DomainView::name_of(other.participant, participants, endpoints) + ": " + why);
      }
      list.push_back(entry);
    }
  }
  if (options.view.json) {
    fmt::print("{}\n", json_text(json, 2));
    return exit_status::kOk;
  }
  fmt::print("{}  ({}, {})\n", options.watch.topic, here.front().type, here.front().keyed ? "keyed" : "without a key");
  if (topic) fmt::print("{}; {}\n", topic->doc, topic->rate);
  for (const char* side : {"writers", "readers"}) {
    fmt::print("\n{}:\n", side);
    for (const auto& entry : json[side]) {
      fmt::print("  {:<20} {}  pid {} on {}\n", entry["node"].get<std::string>(), entry["qos"].get<std::string>(),
                 entry.value("pid", 0), entry.value("host", std::string("?")));
      if (entry.contains("deaf_to")) {
        for (const auto& why : entry["deaf_to"])
          fmt::print("  {:<20} cannot receive from {}\n", "", why.get<std::string>());
      }
    }
  }
  fmt::print("\n{}", tree ? tree->text() : "The writers of this topic do not describe its type.\n");
  return exit_status::kOk;
}

void add_watch_options(CLI::App& app, Options& options) {
  app.add_option("TOPIC", options.watch.topic, "name of the topic")->required();
  add_view_options(app, options.view);
  app.add_option("--timeout", options.watch.timeout_s, "[s] give up when no sample has arrived for this long")
      ->capture_default_str()
      ->check(number(1e-3, 1e6, "s"));
}

}  // namespace

void add_topic(CLI::App& app, Action& action) {
  auto options = std::make_shared<Options>();
  auto* topic = add_group(app, "topic", "list, describe, print or measure the topics of a DDS domain");
  topic->footer(help_footer(
      "Works on every topic of the domain, also on topics of other programs and other vendors' DDS. The writers "
      "describe\nthe types; if they do not, echo prints the encoded bytes.",
      {"constrictor topic list", "constrictor topic info joint_state", "constrictor topic echo task/event",
       "constrictor topic echo guidance/pose --count 1 --json", "constrictor topic hz joint_state --for 5"},
      "0 done; 1 no sample arrived in time; 64 wrong usage; 70 no such topic or run", kDomainEnvironment));
  const auto add = [&](const char* name, const char* what, std::function<int(const Options&)> run) {
    return add_subcommand(*topic, name, what, action, options, std::move(run));
  };
  auto* list_app = add("list", "list every topic with its type and the numbers of its writers and readers", list);
  add_view_options(*list_app, options->view);
  auto* info_app =
      add("info", "describe a topic: type, fields, writers, readers, and which reader cannot receive from which writer",
          info);
  info_app->add_option("TOPIC", options->watch.topic, "name of the topic")->required();
  add_view_options(*info_app, options->view);
  auto* echo_app = add("echo", "print the samples of a topic",
                       [](const Options& chosen) { return echo_command(chosen.view, chosen.watch); });
  add_watch_options(*echo_app, *options);
  echo_app->add_option("--count,-n", options->watch.count, "end after this many samples (default: until Ctrl-C)")
      ->check(whole_number());
  echo_app->add_option("--field", options->watch.field,
                       "print only this field, for example header.tick or position_rad");
  echo_app->add_flag("--raw", options->watch.raw, "print the encoded bytes in hexadecimal");
  for (const char* name : {"hz", "delay"}) {
    const bool hz = std::string(name) == "hz";
    auto* meter_app =
        add(name,
            hz ? "measure how often samples arrive and how large they are"
               : "measure how old samples are when they arrive, by the clocks of their writers",
            [hz](const Options& chosen) {
              return hz ? hz_command(chosen.view, chosen.watch) : delay_command(chosen.view, chosen.watch);
            });
    add_watch_options(*meter_app, *options);
    meter_app->add_option("--for", options->watch.for_s, "[s] end after this time (default: until Ctrl-C)")
        ->check(number(1e-3, 1e6, "s"));
  }
}

}  // namespace constrictor::cli
