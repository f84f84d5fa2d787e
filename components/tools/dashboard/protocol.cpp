#include "dashboard/protocol.hpp"

#include <fmt/format.h>

#include <limits>
#include <map>

namespace constrictor::dashboard {
namespace {

using nlohmann::json;

constexpr std::uint8_t kMessageData = 1;      // server
constexpr std::uint8_t kServiceResponse = 3;  // server
constexpr std::uint8_t kServiceCall = 2;      // client
constexpr std::size_t kMostItems = 1000;      // in one message of a client
constexpr std::size_t kMostNameBytes = 200;   // of a parameter, or of the id of a request

std::string text_of(const json& message) { return message.dump(-1, ' ', false, json::error_handler_t::replace); }

void append(std::string& frame, std::uint64_t number, int bytes) {
  for (int i = 0; i < bytes; ++i) frame += static_cast<char>(number >> (8 * i) & 0xffu);
}

std::optional<std::uint32_t> take_u32(std::string_view& frame) {
  if (frame.size() < 4) return {};
  std::uint32_t number = 0;
  for (std::size_t i = 0; i < 4; ++i)
    number |= static_cast<std::uint32_t>(static_cast<unsigned char>(frame[i])) << (8 * i);
  frame.remove_prefix(4);
  return number;
}

std::optional<std::uint32_t> id_of(const json& value) {
  if (!value.is_number_unsigned()) return {};
  const auto number = value.get<std::uint64_t>();
  if (number > std::numeric_limits<std::uint32_t>::max()) return {};
  return static_cast<std::uint32_t>(number);
}

Parsed refused(const std::string& why) { return {{}, why}; }

Parsed parse_subscriptions(const json& list) {
  Parsed parsed;
  for (const auto& item : list) {
    const auto subscription = item.is_object() && item.contains("id") ? id_of(item["id"]) : std::nullopt;
    const auto channel = item.is_object() && item.contains("channelId") ? id_of(item["channelId"]) : std::nullopt;
    if (!subscription || !channel) return refused("subscribe: each subscription needs the numbers id and channelId");
    parsed.actions.emplace_back(Subscribe{*subscription, *channel});
  }
  return parsed;
}

Parsed parse_unsubscriptions(const json& list) {
  Parsed parsed;
  for (const auto& item : list) {
    const auto subscription = id_of(item);
    if (!subscription) return refused("unsubscribe: subscriptionIds must be numbers");
    parsed.actions.emplace_back(Unsubscribe{*subscription});
  }
  return parsed;
}

/// The texts of a list; empty: not all of its items are short texts.
std::optional<std::vector<std::string>> names_of(const json& list) {
  std::vector<std::string> names;
  for (const auto& item : list) {
    if (!item.is_string() || item.get_ref<const std::string&>().size() > kMostNameBytes) return {};
    names.push_back(item.get<std::string>());
  }
  return names;
}

Parsed parse_names(const std::string& op, const json& list, const std::string& id) {
  auto names = names_of(list);
  if (!names) return refused(op + ": parameterNames must be texts");
  if (op == "getParameters") return {{GetParameters{std::move(*names), id}}, {}};
  if (op == "subscribeParameterUpdates") return {{SubscribeParameters{std::move(*names)}}, {}};
  return {{UnsubscribeParameters{std::move(*names)}}, {}};
}

Parsed parse_values(const json& list, const std::string& id) {
  SetParameters wish{{}, id};
  for (const auto& item : list) {
    const auto name = item.is_object() && item.contains("name") ? names_of(json::array({item["name"]})) : std::nullopt;
    if (!name) return refused("setParameters: each parameter needs the text name");
    wish.values.push_back({name->front(), item.value("value", json())});
  }
  return {{std::move(wish)}, {}};
}

/// The key of the list, by the name of the message.
const std::map<std::string, const char*> kLists = {{"subscribe", "subscriptions"},
                                                   {"unsubscribe", "subscriptionIds"},
                                                   {"getParameters", "parameterNames"},
                                                   {"setParameters", "parameters"},
                                                   {"subscribeParameterUpdates", "parameterNames"},
                                                   {"unsubscribeParameterUpdates", "parameterNames"}};

}  // namespace

std::string server_info(const std::string& name, const std::string& session) {
  return text_of({{"op", "serverInfo"},
                  {"name", name},
                  {"capabilities", {"services", "parameters", "parametersSubscribe"}},
                  {"supportedEncodings", {"json"}},
                  {"metadata", json::object()},
                  {"sessionId", session}});
}

std::string advertise(const std::vector<Channel>& channels) {
  json list = json::array();
  for (const auto& channel : channels) {
    list.push_back({{"id", channel.id},
                    {"topic", channel.topic},
                    {"encoding", channel.encoding},
                    {"schemaName", channel.schema_name},
                    {"schema", channel.schema},
                    {"schemaEncoding", channel.schema_encoding}});
  }
  return text_of({{"op", "advertise"}, {"channels", list}});
}

std::string advertise_services(const std::vector<Service>& services) {
  json list = json::array();
  for (const auto& service : services) {
    const json answer = {{"encoding", "json"},
                         {"schemaName", service.name + "_answer"},
                         {"schemaEncoding", "jsonschema"},
                         {"schema", R"({"type":"object","properties":{"text":{"type":"string"}}})"}};
    json request = answer;
    request["schemaName"] = service.name + "_request";
    request["schema"] = service.request_schema;
    list.push_back({{"id", service.id},
                    {"name", service.name},
                    {"type", service.name},
                    {"request", request},
                    {"response", answer},
                    {"requestSchema", service.request_schema},
                    {"responseSchema", answer["schema"]}});
  }
  return text_of({{"op", "advertiseServices"}, {"services", list}});
}

std::string status(int level, const std::string& message, const std::string& id) {
  json text = {{"op", "status"}, {"level", level}, {"message", message}};
  if (!id.empty()) text["id"] = id;
  return text_of(text);
}

std::string service_failure(std::uint32_t service, std::uint32_t call, const std::string& message) {
  return text_of({{"op", "serviceCallFailure"}, {"serviceId", service}, {"callId", call}, {"message", message}});
}

std::string named(const std::string& name, const std::string& text) {
  return text.starts_with(name + ": ") ? text : name + ": " + text;
}

std::string parameter_values(const std::vector<ParameterValue>& values, const std::string& id) {
  json list = json::array();
  for (const auto& [name, value, real] : values) {
    list.push_back({{"name", name}, {"value", value}});
    if (real && value.is_number()) list.back()["type"] = "float64";  // else JavaScript takes 3.0 for a whole number
  }
  json message = {{"op", "parameterValues"}, {"parameters", list}};
  if (!id.empty()) message["id"] = id;
  return text_of(message);
}

std::string message_data(std::uint32_t subscription, std::uint64_t time_ns, std::string_view payload) {
  std::string frame;
  frame.reserve(13 + payload.size());
  append(frame, kMessageData, 1);
  append(frame, subscription, 4);
  append(frame, time_ns, 8);
  frame += payload;
  return frame;
}

std::string service_response(std::uint32_t service, std::uint32_t call, std::string_view json) {
  std::string frame;
  append(frame, kServiceResponse, 1);
  append(frame, service, 4);
  append(frame, call, 4);
  append(frame, 4, 4);
  frame += "json";
  frame += json;
  return frame;
}

Parsed parse_text(std::string_view text) {
  const json message = json::parse(text, nullptr, false);
  if (!message.is_object() || !message.contains("op") || !message["op"].is_string())
    return refused("found no JSON object with the text `op`");
  const std::string op = message["op"].get<std::string>();
  const auto known = kLists.find(op);
  if (known == kLists.end()) {
    std::vector<std::string> accepted;
    for (const auto& entry : kLists) accepted.push_back(entry.first);
    return refused(fmt::format("found op '{}', accepted {}", op.substr(0, 40), fmt::join(accepted, ", ")));
  }
  const char* key = known->second;
  if (!message.contains(key) || !message[key].is_array() || message[key].size() > kMostItems)
    return refused(fmt::format("{}: accepted a list `{}` of at most {} items", op, key, kMostItems));
  const json& list = message[key];
  if (op == "subscribe") return parse_subscriptions(list);
  if (op == "unsubscribe") return parse_unsubscriptions(list);
  const auto id = message.contains("id") ? names_of(json::array({message["id"]})) : std::vector<std::string>{""};
  if (!id) return refused(fmt::format("{}: the id must be a text of at most {} bytes", op, kMostNameBytes));
  return op == "setParameters" ? parse_values(list, id->front()) : parse_names(op, list, id->front());
}

Parsed parse_frame(std::string_view frame) {
  if (frame.empty() || static_cast<std::uint8_t>(frame.front()) != kServiceCall)
    return refused("found a frame that is not a service call");
  frame.remove_prefix(1);
  const auto service = take_u32(frame), call = take_u32(frame), length = take_u32(frame);
  if (!service || !call) return refused("found a service call that is too short");
  // The caller waits for an answer to its call.
  const auto failed = [&](const std::string& why) { return Parsed{{}, why, FailedCall{*service, *call}}; };
  if (!length || frame.size() < *length) return failed("found a service call that is too short");
  if (frame.substr(0, *length) != "json") return failed("service call: accepted the encoding json");
  frame.remove_prefix(*length);
  json request = frame.empty() ? json::object() : json::parse(frame, nullptr, false);
  if (!request.is_object()) return failed("service call: accepted a JSON object");
  return {{ServiceCall{*service, *call, std::move(request)}}, {}};
}

}  // namespace constrictor::dashboard
