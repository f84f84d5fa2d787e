// The texts and frames of the Foxglove WebSocket protocol, version 1. Pure: no sockets, no DDS.
// Source: https://github.com/foxglove/ws-protocol/blob/main/docs/spec.md
#pragma once

#include <cstdint>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

namespace constrictor::dashboard {

/// The subprotocols that the server accepts. The messages used here are the same in both, also those about parameters.
inline constexpr const char* kSubprotocols[] = {"foxglove.sdk.v1", "foxglove.websocket.v1"};

/// A channel to which a client can subscribe.
struct Channel {
  std::uint32_t id = 0;
  std::string topic;
  std::string encoding;         ///< "cdr" or "json"
  std::string schema_name;      ///< "constrictor/msg/JointState"
  std::string schema;           ///< the schema's text
  std::string schema_encoding;  ///< "ros2msg" or "jsonschema"
};

/// A command that a client can call with an empty request or a JSON object.
struct Service {
  std::uint32_t id = 0;
  std::string name;
  std::string request_schema = R"({"type":"object","properties":{}})";
};

/// A parameter as viewers see it.
struct ParameterValue {
  std::string name;
  nlohmann::json value;  ///< a number, or the name of the value; null: not known
  bool real = false;     ///< the number need not be whole, even if this value is
  bool operator==(const ParameterValue&) const = default;
};

[[nodiscard]] std::string server_info(const std::string& name, const std::string& session);
[[nodiscard]] std::string advertise(const std::vector<Channel>& channels);
[[nodiscard]] std::string advertise_services(const std::vector<Service>& services);
/// `level`: 0 information, 1 warning, 2 error. `id`: for programs; may be empty.
[[nodiscard]] std::string status(int level, const std::string& message, const std::string& id = {});
[[nodiscard]] std::string service_failure(std::uint32_t service, std::uint32_t call, const std::string& message);

/// `text` that begins with `name: `, once also if it begins so already.
[[nodiscard]] std::string named(const std::string& name, const std::string& text);

/// `id`: of the request that this answers; empty: none.
[[nodiscard]] std::string parameter_values(const std::vector<ParameterValue>& values, const std::string& id);

/// Frames; all numbers are little-endian.
[[nodiscard]] std::string message_data(std::uint32_t subscription, std::uint64_t time_ns, std::string_view payload);
[[nodiscard]] std::string service_response(std::uint32_t service, std::uint32_t call, std::string_view json);

struct Subscribe {
  std::uint32_t subscription = 0;
  std::uint32_t channel = 0;
};
struct Unsubscribe {
  std::uint32_t subscription = 0;
};
struct ServiceCall {
  std::uint32_t service = 0;
  std::uint32_t call = 0;
  nlohmann::json request;  ///< an object
};
/// In the following, no names mean all parameters.
struct GetParameters {
  std::vector<std::string> names;
  std::string id;  ///< empty: none
};
struct SetParameters {
  std::vector<ParameterValue> values;  ///< of any JSON type
  std::string id;                      ///< empty: none
};
struct SubscribeParameters {
  std::vector<std::string> names;
};
struct UnsubscribeParameters {
  std::vector<std::string> names;
};
using Action = std::variant<Subscribe, Unsubscribe, ServiceCall, GetParameters, SetParameters, SubscribeParameters,
                            UnsubscribeParameters>;

/// A call whose request cannot be read.
struct FailedCall {
  std::uint32_t service = 0;
  std::uint32_t call = 0;
};

/// The request of a client, or the reason why it is refused. Clients may send anything.
struct Parsed {
  std::vector<Action> actions;
  std::string refusal;                         ///< empty: none
  std::optional<FailedCall> failed_call = {};  ///< to be answered with the refusal
};
[[nodiscard]] Parsed parse_text(std::string_view text);
[[nodiscard]] Parsed parse_frame(std::string_view frame);

}  // namespace constrictor::dashboard
