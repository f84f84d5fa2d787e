// `constrictor topic`: list, find, info, echo, hz, bw, delay and pub of any topic on a domain, also of types this
// project does not define.
#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <optional>

#include "cli/introspection/domain_view.hpp"
#include "cli/introspection/topic_pub.hpp"
#include "cli/introspection/topic_watch.hpp"
#include "cli/subcommands.hpp"
#include "cli/usage.hpp"
#include "client/command_error.hpp"
#include "configuration/closest_name.hpp"
#include "constrictor/json.hpp"
#include "constrictor/topics.hpp"
#include "cyclone/type_tree.hpp"
#include "runtime/host.hpp"

namespace constrictor::cli {
namespace {

using Json = nlohmann::ordered_json;

struct TopicOptions {
  ViewOptions view;
  WatchOptions watch;
  PubOptions pub;
  std::string topic;  ///< info, echo, delay
  std::string type;   ///< find
};

/// The columns of the project's table of topics that are written for people.
struct TopicDescription {
  std::string_view doc;
  std::string_view rate;
};

/// Empty if the project does not define the topic.
std::optional<TopicDescription> described(const std::string& topic) {
  for (const auto& info : topics::kInfos) {
    if (info.name == topic) return TopicDescription{info.doc, info.rate};
  }
  for (const auto& info : barrier_topics::kInfos) {
    if (info.name == topic) return TopicDescription{info.doc, info.rate};
  }
  return std::nullopt;
}

int list_topics(const TopicOptions& options) {
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
               described(name).value_or(TopicDescription{}).doc);
  }
  return exit_status::kOk;
}

int show_topic(const TopicOptions& options) {
  const DomainView view(options.view);
  view.settle();
  const auto endpoints = view.discovery().endpoints();
  const auto participants = view.discovery().participants();
  std::vector<dds::Endpoint> here;
  std::copy_if(endpoints.begin(), endpoints.end(), std::back_inserter(here),
               [&](const auto& endpoint) { return endpoint.topic == options.topic; });
  if (here.empty()) {
    throw CommandError(no_such_topic(view, options.topic));
  }
  const auto with_type =
      std::find_if(here.begin(), here.end(), [](const auto& endpoint) { return endpoint.type_info != nullptr; });
  const auto tree =
      with_type == here.end() ? nullptr : dds::TypeTree::find(view.participant(), *with_type, std::chrono::seconds(2));
  const auto topic = described(options.topic);
  Json json = {{"topic", options.topic}, {"type", here.front().type}, {"keyed", here.front().keyed}};
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
          entry["cannot_receive_from"].push_back(DomainView::name_of(other.participant, participants, endpoints) +
                                                 ": " + why);
      }
      list.push_back(entry);
    }
  }
  if (options.view.json) {
    fmt::print("{}\n", json_text(json, 2));
    return exit_status::kOk;
  }
  fmt::print("{}  ({}, {})\n", options.topic, here.front().type, here.front().keyed ? "keyed" : "without a key");
  if (topic) fmt::print("{}; {}\n", topic->doc, topic->rate);
  for (const char* side : {"writers", "readers"}) {
    fmt::print("\n{}:\n", side);
    for (const auto& entry : json[side]) {
      fmt::print("  {:<20} {}  pid {} on {}\n", entry["node"].get<std::string>(), entry["qos"].get<std::string>(),
                 entry.value("pid", 0), entry.value("host", std::string("?")));
      if (entry.contains("cannot_receive_from")) {
        for (const auto& why : entry["cannot_receive_from"])
          fmt::print("  {:<20} cannot receive from {}\n", "", why.get<std::string>());
      }
    }
  }
  fmt::print("\n{}", tree ? tree->text() : "The writers of this topic do not describe its type.\n");
  return exit_status::kOk;
}

/// `type` as people write it: the whole name, or its last part.
bool is_type(const std::string& full, const std::string& type) {
  return full == type || (full.size() > type.size() + 2 && full.ends_with("::" + type));
}

int find_topics(const TopicOptions& options) {
  const DomainView view(options.view);
  view.settle_or_throw();
  std::map<std::string, std::string> found;
  std::vector<std::string> types;
  for (const auto& endpoint : view.discovery().endpoints()) {
    if (is_type(endpoint.type, options.type)) found[endpoint.topic] = endpoint.type;
    types.push_back(endpoint.type);
    types.push_back(endpoint.type.substr(endpoint.type.rfind(':') + 1));  // npos + 1 is 0: the whole name
  }
  if (options.view.json) {
    Json json = Json::array();
    for (const auto& [topic, type] : found) json.push_back({{"topic", topic}, {"type", type}});
    fmt::print("{}\n", json_text(json, 2));
  } else {
    for (const auto& [topic, type] : found) fmt::print("{}\n", topic);
  }
  if (!found.empty()) return exit_status::kOk;
  fmt::print(stderr, "topic: no topic of type '{}' in DDS domain {}{} (see `constrictor topic list`)\n", options.type,
             view.domain(), did_you_mean(options.type, types));
  return exit_status::kFailed;
}

void add_timeout(CLI::App& app, TopicOptions& options) {
  app.add_option("--timeout", options.watch.timeout_s, "[s] give up when no sample has arrived for this long")
      ->capture_default_str()
      ->check(number(1e-3, 1e6, "s"));
}

void add_topic_argument(CLI::App& app, TopicOptions& options) {
  app.add_option("TOPIC", options.topic, "name of the topic")->required();
}

int echo_topic(const TopicOptions& options) {
  WatchOptions watch = options.watch;
  watch.topics = {options.topic};
  return echo_command(options.view, watch);
}

void add_echo_options(CLI::App& app, TopicOptions& options) {
  add_topic_argument(app, options);
  add_view_options(app, options.view);
  add_timeout(app, options);
  app.add_option("--count,-n", options.watch.count,
                 "end after this many samples, of which the first is the newest that the writer keeps (default: until "
                 "Ctrl-C,\nfrom the oldest one that the writer keeps)")
      ->check(whole_number());
  app.add_option("--field", options.watch.field, "print only this field, for example header.tick or position_rad");
  app.add_option("--filter", options.watch.filter,
                 "print only samples that fulfil an expression, for example 'event == line_lost and header.tick > 500'")
      ->option_text("EXPRESSION");
  app.add_flag("--no-arr", options.watch.shown.no_arrays, "print the lengths of arrays instead of their elements");
  app.add_flag("--full", options.watch.shown.full,
               "print bytes, such as the pixels of an image, as numbers instead of their count and SHA-256");
  app.add_option("--precision", options.watch.shown.precision, "decimal places of floating-point numbers, 0 to 17")
      ->check(whole_number(0, 17));
  app.add_flag("--raw", options.watch.raw, "print the encoded bytes in hexadecimal")
      ->excludes("--field")
      ->excludes("--filter");
}

}  // namespace

void add_topic(CLI::App& app, Action& action) {
  auto options = std::make_shared<TopicOptions>();
  auto* topic =
      add_group(app, "topic", "list, find, describe, print, measure or publish on the topics of a DDS domain");
  topic->footer(help_footer(
      "Works on every topic of the domain, also on topics of other programs and other vendors' DDS. The writers "
      "describe\nthe types; if they do not, echo prints the encoded bytes.",
      {"constrictor topic list", "constrictor topic info joint_state", "constrictor topic find CameraImage",
       "constrictor topic echo task/event", "constrictor topic echo guidance/pose --count 1 --json",
       "constrictor topic echo perception/objects --filter 'blobs.*.colour == green' --precision 2",
       "constrictor topic hz joint_state camera/image --for 5", "constrictor topic bw camera/image --for 5",
       "constrictor topic delay camera/image --for 5"},
      "0 done; 1 no sample arrived in time, or no topic found; 64 wrong usage; 70 no such topic or run",
      kDomainEnvironment));
  const auto add = [&](const char* name, const char* what, std::function<int(const TopicOptions&)> run) {
    return add_subcommand(*topic, name, what, action, options, std::move(run));
  };
  auto* list_app =
      add("list", "list every topic with its type and the numbers of its writers and readers", list_topics);
  add_view_options(*list_app, options->view);
  auto* find_app = add("find", "list the topics of a type", find_topics);
  find_app->add_option("TYPE", options->type, "the type, or the last part of its name: JointState")->required();
  add_view_options(*find_app, options->view);
  auto* info_app =
      add("info", "describe a topic: type, fields, writers, readers, and which reader cannot receive from which writer",
          show_topic);
  add_topic_argument(*info_app, *options);
  add_view_options(*info_app, options->view);
  auto* echo_app = add("echo", "print the samples of a topic", echo_topic);
  add_echo_options(*echo_app, *options);
  echo_app->footer(help_footer(
      "FILTER compares fields (== != < <= > >=) with numbers, texts, names of constants, or other fields, and joins\n"
      "comparisons by and, or, not and parentheses. An index selects an element of a list, * any element. null is NaN.",
      {"constrictor topic echo task/event --filter 'event == line_lost or event == end_of_line'",
       "constrictor topic echo perception/objects --filter 'blobs.*.colour == green' --field blobs",
       "constrictor topic echo joint_state --count 1 --no-arr", "constrictor topic echo camera/image --count 1"},
      "0 done; 1 no sample arrived in time; 64 no such field, or a wrong filter; 70 no such topic or run",
      kDomainEnvironment));
  using Measure = int (*)(const ViewOptions&, const WatchOptions&);
  struct Row {
    const char* name;
    const char* what;
    Measure run;
    bool several;
    const char* example;
  };
  for (const Row& row : {Row{"hz", "measure how often samples arrive, in wall time and in the robot's time", hz_command,
                             true, "constrictor topic hz joint_state camera/image --for 5"},
                         Row{"bw", "measure how many bytes arrive, in wall time and in the robot's time", bw_command,
                             true, "constrictor topic bw camera/image --for 5"},
                         Row{"delay", "measure how old samples are when they arrive, by the clocks of their writers",
                             delay_command, false, "constrictor topic delay camera/image --for 5"}}) {
    auto* meter_app = add(row.name, row.what, [run = row.run](const TopicOptions& chosen) {
      WatchOptions watch = chosen.watch;
      if (watch.topics.empty()) watch.topics = {chosen.topic};
      return run(chosen.view, watch);
    });
    if (row.several) meter_app->add_option("TOPICS", options->watch.topics, "names of the topics")->required();
    else add_topic_argument(*meter_app, *options);
    add_view_options(*meter_app, options->view);
    add_timeout(*meter_app, *options);
    meter_app->add_option("--for", options->watch.for_s, "[s] end after this time (default: until Ctrl-C)")
        ->check(number(1e-3, 1e6, "s"));
    meter_app->footer(help_footer("", {row.example},
                                  "0 done; 1 no sample arrived in time; 64 wrong usage; 70 no such topic or run",
                                  kDomainEnvironment));
  }
  auto* pub_app = add("pub", "publish a message on a topic, once or at a rate",
                      [](const TopicOptions& chosen) { return pub_command(chosen.view, chosen.pub); });
  add_pub_options(*pub_app, options->view, options->pub);
}

}  // namespace constrictor::cli
