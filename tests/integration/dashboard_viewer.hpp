// A program that watches a dashboard and calls its services.
#pragma once

#include <nlohmann/json.hpp>
#include <optional>
#include <string>

#include "support/web_socket.hpp"

namespace constrictor::testing {

class Viewer : public WebSocket {
 public:
  using WebSocket::WebSocket;

  /// Receives until a text with this `op` arrives; null if the connection ends or is silent.
  nlohmann::json wait_for(const std::string& op) {
    for (;;) {
      const auto message = receive();
      if (!message) return nullptr;
      if (!message->text) continue;
      nlohmann::json text = nlohmann::json::parse(message->bytes, nullptr, false);
      if (text.value("op", "") == op) return text;
    }
  }
  /// Receives until the channel of this topic is advertised; its number, or 0.
  std::uint32_t channel_of(const std::string& topic) {
    for (;;) {
      const nlohmann::json text = wait_for("advertise");
      if (text.is_null()) return 0;
      for (const auto& channel : text.at("channels")) {
        if (channel.at("topic") == topic) return channel.at("id");
      }
    }
  }
  static std::string subscribe(std::uint32_t subscription, std::uint32_t channel) {
    return nlohmann::json{{"op", "subscribe"}, {"subscriptions", {{{"id", subscription}, {"channelId", channel}}}}}
        .dump();
  }
  static std::string call(std::uint32_t service, std::uint32_t number, const std::string& request) {
    std::string frame{'\2', static_cast<char>(service), 0, 0, 0, static_cast<char>(number), 0, 0, 0, 4, 0, 0, 0};
    return frame + "json" + request;
  }
  /// Calls a service; its answer, or "failure: " and the reason of its refusal.
  std::string ask(const std::string& name, const std::string& request) {
    if (services_.is_null()) services_ = wait_for("advertiseServices");
    if (services_.is_null()) return "no services";
    std::uint32_t id = 0;
    for (const auto& service : services_.at("services"))
      if (service.at("name") == name) id = service.at("id");
    if (!send_binary(call(id, 9, request))) return "not connected";
    for (;;) {
      const auto message = receive(std::chrono::seconds(20));
      if (!message) return "no answer";
      if (message->text) {
        const nlohmann::json text = nlohmann::json::parse(message->bytes);
        if (text.value("op", "") == "serviceCallFailure") return "failure: " + text.value("message", "");
      } else if (message->bytes[0] == 3) {
        return nlohmann::json::parse(message->bytes.substr(17)).value("text", "");
      }
    }
  }

 private:
  nlohmann::json services_;
};

}  // namespace constrictor::testing
