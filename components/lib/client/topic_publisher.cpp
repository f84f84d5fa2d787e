#include "client/topic_publisher.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <string_view>
#include <utility>

#include "client/polling.hpp"
#include "client/source.hpp"
#include "configuration/closest_name.hpp"
#include "constrictor/field_table.hpp"
#include "constrictor/topics.hpp"
#include "cyclone/raw_writer.hpp"
#include "cyclone/type_tree.hpp"

namespace constrictor {
namespace {

using namespace std::chrono_literals;
using Json = nlohmann::ordered_json;
constexpr std::string_view kModule = "constrictor::msg::";
constexpr int kSamplesKept = 64;
constexpr auto kReaderDiscovery = 1500ms;
constexpr auto kSettled = 250ms;  // without a new endpoint

/// The row of a topic in the table of topics.
struct Row {
  std::string type;
  std::string owner;  ///< its writer, as a text for people
  bool of_clients = false;
};

std::optional<Row> row_of(const std::string& topic) {
  for (const auto& info : topics::kInfos) {
    if (info.name == topic) return Row{std::string(kModule) + std::string(info.type), std::string(info.writer), false};
  }
  for (const auto& info : barrier_topics::kInfos) {
    if (info.name == topic)
      return Row{std::string(kModule) + std::string(info.type), std::string(info.writers), info.writers == "clients"};
  }
  return std::nullopt;
}

bool keyed(const std::string& type) {
  const auto* fields = fields_of(type);
  return fields && std::any_of(fields->begin(), fields->end(), [](const auto& field) { return field.info.is_key; });
}

std::vector<dds::Endpoint> settled_endpoints(const dds::Discovery& discovery) {
  std::vector<dds::Endpoint> endpoints;
  const auto poll = [&] {
    const std::size_t before = endpoints.size();
    endpoints = discovery.endpoints();
    return endpoints.size() != before;
  };
  wait_until_quiet(kSettled, kReaderDiscovery, poll, [&] { return !endpoints.empty(); });
  return endpoints;
}

}  // namespace

std::string publishing_refusal(const std::string& topic, const std::vector<dds::Endpoint>& endpoints) {
  const auto row = row_of(topic);
  if (!row || row->of_clients) return {};
  const bool run = std::any_of(endpoints.begin(), endpoints.end(), [](const dds::Endpoint& endpoint) {
    return endpoint.writer &&
           (endpoint.topic.starts_with("barrier/") || endpoint.topic == barrier_topics::kRunState.name);
  });
  if (!run) return {};
  return fmt::format(
      "topic '{}' belongs to {} of the run in this domain. The members refuse what another process writes there, and "
      "observers would show it as if it were true. To command the robot, use request/v2 (`constrictor task`, `teleop`, "
      "`param`); to replace a component, give the manifest your program; to test a program of your own, use a domain "
      "without a run",
      topic, row->owner);
}

bool publishes_commands(const std::string& topic) {
  const auto row = row_of(topic);
  return row && row->of_clients;
}

struct TopicPublisher::Parts {
  explicit Parts(std::int32_t own) : participant(own), discovery(own) {}
  std::int32_t participant;
  dds::Discovery discovery;
  std::unique_ptr<dds::TypeTree> tree;
  bool keyed = false;
  std::optional<dds::RawWriter> writer;
};

TopicPublisher::TopicPublisher(std::int32_t participant, std::uint32_t domain, std::string topic,
                               const std::string& type, std::string source, std::optional<RunKey> key)
    : topic_(std::move(topic)),
      source_(std::move(source)),
      key_(key ? std::move(*key) : run_key(domain)),
      sequence_(first_sequence_number()),
      parts_(std::make_unique<Parts>(participant)) {
  const auto endpoints = settled_endpoints(parts_->discovery);
  if (const std::string why = publishing_refusal(topic_, endpoints); !why.empty())
    throw CommandError(why, CommandError::Cause::kRefused);
  const auto row = row_of(topic_);
  std::vector<std::string> names;
  const dds::Endpoint* known = nullptr;
  for (const auto& endpoint : endpoints) {
    names.push_back(endpoint.topic);
    if (endpoint.topic == topic_ && (!known || (!known->type_info && endpoint.type_info))) known = &endpoint;
  }
  if (!type.empty()) type_ = type.find("::") == std::string::npos ? std::string(kModule) + type : type;
  else if (known) type_ = known->type;
  else if (row) type_ = row->type;
  if (type_.empty()) {
    for (const auto& info : topics::kInfos) names.emplace_back(info.name);
    for (const auto& info : barrier_topics::kInfos) names.emplace_back(info.name);
    throw CommandError(
        fmt::format("no topic '{}' in DDS domain {}{}; a new topic needs the name of its type (--type TYPE)", topic_,
                    domain, did_you_mean(topic_, names)));
  }
  parts_->keyed = known && known->type == type_ ? known->keyed : keyed(type_);
  if (known && known->type == type_) parts_->tree = dds::TypeTree::find(participant, *known, 2s);
  if (!parts_->tree) parts_->tree = dds::TypeTree::known(participant, type_);
  if (!parts_->tree) {
    throw CommandError(fmt::format("topic '{}': no process describes its type {}, and this project does not define it",
                                   topic_, type_));
  }
}

TopicPublisher::~TopicPublisher() = default;

Json TopicPublisher::completed(Json message) {
  const auto row = row_of(topic_);
  if (!row || !row->of_clients || !message.is_object() || row->type != type_) return message;
  const auto fill = [&](Json& object, const char* name, const auto& value) {
    if (!object.contains(name)) object[name] = value;
  };
  ++sequence_;
  fill(message, "source", source_);
  if (topic_ != barrier_topics::kRunControl.name) fill(message, "robot_id", 1);
  if (topic_ == barrier_topics::kRequest.name) {
    fill(message, "token", key_.token);
    fill(message, "header", Json::object());
    if (!message["header"].is_object()) return message;  // encode() names the problem
    fill(message["header"], "sequence_number", sequence_);
    fill(message["header"], "run_id", key_.run_id);
    fill(message, "parameters", Json{{"timeout_s", nullptr}});
    return message;
  }
  fill(message, "sequence_number", sequence_);
  if (topic_ == barrier_topics::kRunControl.name) {
    fill(message, "token", key_.token);
    fill(message, "run_id", key_.run_id);
  }
  return message;
}

std::vector<std::uint8_t> TopicPublisher::encode(const Json& message) const { return parts_->tree->encode(message); }

Json TopicPublisher::decode(const std::vector<std::uint8_t>& bytes) const { return parts_->tree->decode(bytes); }

int TopicPublisher::readers() {
  if (!parts_->writer)
    parts_->writer.emplace(parts_->participant, topic_, dds::RawWriter::Type{type_, parts_->keyed, false},
                           kSamplesKept);
  return parts_->writer->readers();
}

std::vector<std::string> TopicPublisher::mismatched_readers() const {
  dds::Endpoint own;
  own.type = type_;
  own.keyed = parts_->keyed;
  own.qos.reliable = own.qos.transient_local = true;
  std::vector<std::string> list;
  for (const auto& endpoint : parts_->discovery.endpoints()) {
    if (endpoint.writer || endpoint.topic != topic_) continue;
    const std::string why = dds::mismatch(own, endpoint);
    const std::string name = endpoint.user_data.empty() ? dds::short_name(endpoint.participant) : endpoint.user_data;
    if (!why.empty()) list.push_back(fmt::format("{}: {}", name, why));
  }
  return list;
}

void TopicPublisher::write(const std::vector<std::uint8_t>& bytes) {
  static_cast<void>(readers());
  parts_->writer->write(bytes);
}

bool TopicPublisher::flush(std::chrono::milliseconds bound) const {
  return !parts_->writer || parts_->writer->flush(bound);
}

}  // namespace constrictor
