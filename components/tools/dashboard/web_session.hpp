// The parts of WebServer: its state, and one object for each connection.
#pragma once

#include <algorithm>
#include <boost/asio/ip/tcp.hpp>
#include <boost/beast/core.hpp>
#include <boost/beast/http.hpp>
#include <boost/beast/websocket.hpp>
#include <deque>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "dashboard/viewer_parameters.hpp"
#include "dashboard/web_server.hpp"

namespace constrictor::dashboard {

inline constexpr std::size_t kMostClients = 32;

class Session;

struct WebServer::Impl : std::enable_shared_from_this<WebServer::Impl> {
  using tcp = boost::asio::ip::tcp;
  Impl(WebOptions given, std::string given_name, const std::vector<std::string>& names, OnCall call, OnChange change);
  void listen();
  void accept();
  /// Whether the header Host of a request names this server. Without this check, a page from elsewhere whose name leads
  /// to this address could read everything.
  [[nodiscard]] bool knows_host(const std::string& host) const;

  WebOptions options;
  std::string name;
  boost::asio::io_context context{1};
  tcp::acceptor acceptor;
  OnCall on_call;
  OnChange on_change;
  ParameterMap parameters;
  std::vector<Channel> channels;
  std::vector<Service> services;
  std::map<std::string, std::filesystem::path> files;  ///< of the page, by the path of the request
  std::set<std::shared_ptr<Session>> sessions;         ///< WebSocket clients only
  std::size_t connections = 0;
  std::uint64_t dropped = 0;
};

/// One connection: a request for a file, or a WebSocket client.
class Session : public std::enable_shared_from_this<Session> {
 public:
  Session(boost::asio::ip::tcp::socket socket, std::shared_ptr<WebServer::Impl> server);
  ~Session();
  /// Reads the request.
  void begin();
  void send_text(std::string text) { push({std::move(text), true, false}); }
  void send_frame(std::string frame) { push({std::move(frame), false, false}); }
  /// Sends the message to each subscription of the channel. The oldest ones are dropped if the client is too slow.
  void send_data(std::uint32_t channel, std::uint64_t time_ns, std::string_view payload);
  [[nodiscard]] bool wants(std::uint32_t channel) const;
  /// Sends the parameters to which the client has subscribed and whose present values it does not know.
  void send_news();
  void close();

 private:
  struct Outgoing {
    std::string bytes;
    bool text;
    bool droppable;
  };
  void on_request();
  void respond(boost::beast::http::status code, std::string body, const char* type = "text/plain; charset=utf-8");
  void upgrade();
  void open();
  void read();
  void obey(const Parsed& parsed);
  void obey(const Subscribe& wish);
  void obey(const Unsubscribe& wish) { subscriptions_.erase(wish.subscription); }
  void obey(const ServiceCall& wish);
  void obey(const GetParameters& wish);
  void obey(const SetParameters& wish);
  void obey(const SubscribeParameters& wish) { parameters_.subscribe(wish.names, server_->parameters); }
  void obey(const UnsubscribeParameters& wish) { parameters_.unsubscribe(wish.names); }
  void send_values(const std::vector<ParameterValue>& values, const std::string& id);
  void answer(const SetParameters& wish, const std::vector<WebServer::Change::Result>& results);
  void push(Outgoing message);
  void write();

  std::shared_ptr<WebServer::Impl> server_;
  boost::beast::websocket::stream<boost::beast::tcp_stream> stream_;
  boost::beast::flat_buffer buffer_;
  std::optional<boost::beast::http::request_parser<boost::beast::http::string_body>> parser_;
  std::map<std::uint32_t, std::uint32_t> subscriptions_;  ///< channel by subscription
  ViewerParameters parameters_;
  std::deque<Outgoing> queue_;
  std::size_t queued_bytes_ = 0;
  Outgoing current_{};
  bool writing_ = false;
  bool closed_ = false;
  bool own_page_ = false;  ///< only then it may command
};

}  // namespace constrictor::dashboard
