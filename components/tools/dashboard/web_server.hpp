// One port for web pages and for WebSocket clients of the Foxglove protocol.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "dashboard/protocol.hpp"

namespace constrictor::dashboard {

/// What is wrong with the address of a WebServer; empty if it is an IP address.
[[nodiscard]] std::string wrong_address(const std::string& text);

struct WebOptions {
  std::string address = "127.0.0.1";  ///< an IP address
  std::uint16_t port = 8765;          ///< 0: any free one
  std::filesystem::path page;         ///< folder of the files of the page
  /// Further files of the page that are not files on the disk: content by path, as "/tasks.json".
  std::map<std::string, std::string> made = {};
  std::vector<std::string> origins;  ///< further web sites whose pages may watch, as in the header Origin
};

/// Serves in the thread that calls poll(). A client that reads slowly loses its oldest messages; it delays neither this
/// process nor other clients. Only pages of this server, and programs that send no Origin, may call services: otherwise
/// any web page that its user visits could command the robot.
class WebServer {
 public:
  /// A call of a service: `answer(text)` or `fail(reason)` is to be called once, in the thread of poll().
  struct Call {
    std::string service;
    nlohmann::json request;
    std::function<void(const std::string& text)> answer;
    std::function<void(const std::string& reason)> fail;
  };
  using OnCall = std::function<void(Call)>;
  /// A viewer asks for a change of parameters: `done(results)` is to be called once, in the thread of poll(), with a
  /// result for each value, in the same order.
  struct Change {
    struct Result {
      nlohmann::json value;  ///< the accepted one
      std::string refusal;   ///< the reason; empty: accepted
    };
    std::vector<ParameterValue> values;
    std::function<void(const std::vector<Result>& results)> done;
  };
  using OnChange = std::function<void(Change)>;

  struct Impl;  ///< see web_session.hpp

  /// Throws std::runtime_error if the port cannot be opened.
  WebServer(WebOptions options, std::string name, const std::vector<std::string>& services, OnCall on_call,
            OnChange on_change);
  ~WebServer();
  WebServer(const WebServer&) = delete;
  WebServer& operator=(const WebServer&) = delete;

  /// Returns the number of the new channel; every client learns of it.
  std::uint32_t add_channel(Channel channel);
  /// True if a client has subscribed to the channel.
  [[nodiscard]] bool wanted(std::uint32_t channel) const;
  void send(std::uint32_t channel, std::uint64_t time_ns, std::string_view payload);
  /// The parameters as they are now. Viewers that have subscribed to changes receive those that they do not know.
  void set_parameters(const std::vector<ParameterValue>& values);
  /// Does what sockets are ready for. Never waits.
  void poll();
  /// Sends all viewers the reason why this server is about to end.
  void tell_end(const std::string& why);

  [[nodiscard]] std::uint16_t port() const;
  [[nodiscard]] bool on_this_host_only() const;
  /// Messages that slow clients have lost.
  [[nodiscard]] std::uint64_t dropped() const;

 private:
  std::shared_ptr<Impl> impl_;
};

}  // namespace constrictor::dashboard
