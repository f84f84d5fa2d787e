#include "dashboard/web_session.hpp"

#include <fmt/format.h>

#include <chrono>
#include <fstream>
#include <random>

namespace constrictor::dashboard {
namespace {

namespace asio = boost::asio;
namespace beast = boost::beast;
namespace http = beast::http;
namespace websocket = beast::websocket;
using tcp = asio::ip::tcp;
using ErrorCode = beast::error_code;

constexpr std::size_t kMostQueuedBytes = 16u << 20;  // for one client, beside the message that is being sent
constexpr std::size_t kMostSubscriptions = 1000;     // of one client
constexpr std::size_t kMostRequestBytes = 64 << 10;
constexpr auto kRequestBound = std::chrono::seconds(20);

/// The type of a file of the page.
const char* type_of(const std::filesystem::path& file) {
  const std::string ending = file.extension().string();
  return ending == ".html"   ? "text/html; charset=utf-8"
         : ending == ".js"   ? "text/javascript; charset=utf-8"
         : ending == ".css"  ? "text/css; charset=utf-8"
         : ending == ".json" ? "application/json"
                             : "text/plain; charset=utf-8";
}

}  // namespace

Session::Session(tcp::socket socket, std::shared_ptr<WebServer::Impl> server)
    : server_(std::move(server)), stream_(std::move(socket)), buffer_(2 * kMostRequestBytes) {
  ++server_->connections;
}

Session::~Session() { --server_->connections; }

void Session::begin() {
  parser_.emplace();
  parser_->header_limit(8192);
  parser_->body_limit(kMostRequestBytes);
  stream_.next_layer().expires_after(kRequestBound);
  http::async_read(stream_.next_layer(), buffer_, *parser_, [self = shared_from_this()](ErrorCode error, std::size_t) {
    if (!error) self->on_request();
  });
}

void Session::send_data(std::uint32_t channel, std::uint64_t time_ns, std::string_view payload) {
  for (const auto& [subscription, wanted] : subscriptions_) {
    if (wanted == channel) push({message_data(subscription, time_ns, payload), false, true});
  }
}

bool Session::wants(std::uint32_t channel) const {
  return std::any_of(subscriptions_.begin(), subscriptions_.end(),
                     [&](const auto& entry) { return entry.second == channel; });
}

void Session::on_request() {
  const auto& request = parser_->get();
  const std::string host(request[http::field::host]);
  if (!server_->knows_host(host)) return respond(http::status::forbidden, "unknown host name in the request\n");
  if (websocket::is_upgrade(request)) return upgrade();
  if (request.method() != http::verb::get && request.method() != http::verb::head)
    return respond(http::status::method_not_allowed, "accepted: GET\n");
  const auto target = std::string(request.target().substr(0, request.target().find('?')));
  if (const auto file = server_->files.find(target == "/" ? "/index.html" : target); file != server_->files.end()) {
    std::ifstream stream(file->second, std::ios::binary);
    if (stream) return respond(http::status::ok, {std::istreambuf_iterator<char>(stream), {}}, type_of(file->second));
  }
  if (const auto made = server_->options.made.find(target); made != server_->options.made.end())
    return respond(http::status::ok, made->second, type_of(target));
  respond(http::status::not_found, "there is no such file; the page is at /\n");
}

void Session::respond(http::status code, std::string body, const char* type) {
  auto response = std::make_shared<http::response<http::string_body>>(code, 11);
  response->set(http::field::content_type, type);
  response->set(http::field::cache_control, "no-cache");
  response->set("X-Content-Type-Options", "nosniff");
  response->set("X-Frame-Options", "DENY");
  response->set("Content-Security-Policy", "default-src 'self'; connect-src 'self' ws: wss:; style-src 'self'");
  response->keep_alive(false);
  if (parser_->get().method() != http::verb::head) response->body() = std::move(body);
  response->prepare_payload();
  http::async_write(stream_.next_layer(), *response, [self = shared_from_this(), response](ErrorCode, std::size_t) {
    ErrorCode ignored;
    self->stream_.next_layer().socket().shutdown(tcp::socket::shutdown_send, ignored);
  });
}

void Session::upgrade() {
  const auto& request = parser_->get();
  const std::string origin(request[http::field::origin]);
  const std::string host(request[http::field::host]);
  own_page_ = origin.empty() || origin == "http://" + host || origin == "https://" + host;
  const auto& others = server_->options.origins;
  if (!own_page_ && std::find(others.begin(), others.end(), origin) == others.end()) {
    return respond(http::status::forbidden,
                   fmt::format("pages of {} may not watch; start dashboard with --allow-origin {}\n", origin, origin));
  }
  std::string chosen;
  for (const auto& offered : http::token_list(request[http::field::sec_websocket_protocol])) {
    for (const char* known : kSubprotocols) {
      if (chosen.empty() && offered == known) chosen = known;
    }
  }
  if (chosen.empty())
    return respond(http::status::bad_request, "accepted subprotocols: foxglove.sdk.v1, foxglove.websocket.v1\n");
  if (server_->sessions.size() >= kMostClients)
    return respond(http::status::service_unavailable, fmt::format("there are already {} clients\n", kMostClients));
  stream_.next_layer().expires_never();
  stream_.set_option(websocket::stream_base::timeout::suggested(beast::role_type::server));
  stream_.set_option(websocket::stream_base::decorator(
      [chosen](websocket::response_type& response) { response.set(http::field::sec_websocket_protocol, chosen); }));
  stream_.read_message_max(kMostRequestBytes);
  stream_.async_accept(request, [self = shared_from_this()](ErrorCode error) {
    if (!error) self->open();
  });
}

void Session::open() {
  parser_.reset();
  buffer_.consume(buffer_.size());
  server_->sessions.insert(shared_from_this());
  std::random_device entropy;
  send_text(server_info(server_->name, fmt::format("{:08x}{:08x}", entropy(), entropy())));
  send_text(advertise(server_->channels));
  if (own_page_) send_text(advertise_services(server_->services));
  read();
}

void Session::read() {
  stream_.async_read(buffer_, [self = shared_from_this()](ErrorCode error, std::size_t) {
    if (error) return self->close();
    const std::string bytes = beast::buffers_to_string(self->buffer_.data());
    const bool text = self->stream_.got_text();
    self->buffer_.consume(self->buffer_.size());
    self->obey(text ? parse_text(bytes) : parse_frame(bytes));
    self->read();
  });
}

void Session::obey(const Parsed& parsed) {
  if (const auto& failed = parsed.failed_call)
    return send_text(service_failure(failed->service, failed->call, parsed.refusal));
  if (!parsed.refusal.empty()) send_text(status(2, parsed.refusal));
  for (const auto& action : parsed.actions) std::visit([this](const auto& wish) { obey(wish); }, action);
}

void Session::obey(const Subscribe& wish) {
  const auto& channels = server_->channels;
  const bool known =
      std::any_of(channels.begin(), channels.end(), [&](const Channel& channel) { return channel.id == wish.channel; });
  if (!known) return send_text(status(2, fmt::format("subscribe: there is no channel {}", wish.channel)));
  if (subscriptions_.size() >= kMostSubscriptions)
    return send_text(status(2, fmt::format("subscribe: accepted at most {} subscriptions", kMostSubscriptions)));
  if (!subscriptions_.emplace(wish.subscription, wish.channel).second)
    send_text(status(1, fmt::format("subscribe: subscription {} exists already", wish.subscription)));
}

void Session::obey(const ServiceCall& wish) {
  const auto fail = [weak = weak_from_this(), wish](const std::string& reason) {
    if (const auto self = weak.lock()) self->send_text(service_failure(wish.service, wish.call, reason));
  };
  if (!own_page_) return fail("pages of other web sites may watch, but not command");
  for (const auto& service : server_->services) {
    if (service.id != wish.service) continue;
    return server_->on_call({service.name, wish.request,
                             [weak = weak_from_this(), wish](const std::string& text) {
                               const nlohmann::json answer{{"text", text}};
                               if (const auto self = weak.lock())
                                 self->send_frame(service_response(wish.service, wish.call, answer.dump()));
                             },
                             fail});
  }
  fail(fmt::format("there is no service {}", wish.service));
}

void Session::send_news() {
  if (const auto news = parameters_.news(server_->parameters); !news.empty()) send_text(parameter_values(news, {}));
}

void Session::send_values(const std::vector<ParameterValue>& values, const std::string& id) {
  parameters_.sent(values);
  send_text(parameter_values(values, id));
}

void Session::obey(const GetParameters& wish) {
  std::vector<std::string> missing;
  const auto values = values_of(wish.names, server_->parameters, missing);
  if (!missing.empty())
    send_text(status(1, fmt::format("getParameters: there is no parameter {}", fmt::join(missing, ", "))));
  send_values(values, wish.id);
}

void Session::obey(const SetParameters& wish) {
  if (!own_page_) {
    const WebServer::Change::Result refused{{}, "pages of other web sites may watch, but not command"};
    return answer(wish, std::vector(wish.values.size(), refused));
  }
  server_->on_change({wish.values, [weak = weak_from_this(), wish](const auto& results) {
                        if (const auto self = weak.lock()) self->answer(wish, results);
                      }});
}

void Session::answer(const SetParameters& wish, const std::vector<WebServer::Change::Result>& results) {
  std::vector<ParameterValue> values;
  bool refused = false;
  for (std::size_t i = 0; i < std::min(results.size(), wish.values.size()); ++i) {
    const std::string& name = wish.values[i].name;
    const auto known = server_->parameters.find(name);
    if (known != server_->parameters.end()) values.push_back(known->second);
    if (results[i].refusal.empty() && known != server_->parameters.end()) values.back().value = results[i].value;
    if (results[i].refusal.empty()) continue;
    refused = true;
    send_text(status(2, named(name, results[i].refusal)));
  }
  // Viewers show the wanted value at once. After a refusal they need the true value, also if they have not asked for
  // it.
  if (refused || !wish.id.empty()) send_values(values, wish.id);
}

void Session::push(Outgoing message) {
  if (closed_) return;
  if (message.droppable) {
    // The message that is being sent is not in the queue.
    while (queued_bytes_ + message.bytes.size() > kMostQueuedBytes) {
      const auto oldest =
          std::find_if(queue_.begin(), queue_.end(), [](const Outgoing& waiting) { return waiting.droppable; });
      if (oldest == queue_.end()) break;
      queued_bytes_ -= oldest->bytes.size();
      queue_.erase(oldest);
      ++server_->dropped;
    }
  } else if (queued_bytes_ > 2 * kMostQueuedBytes) {
    return close();  // it asks for answers and does not read them
  }
  queued_bytes_ += message.bytes.size();
  queue_.push_back(std::move(message));
  if (!writing_) write();
}

void Session::write() {
  if (queue_.empty() || closed_) return;
  writing_ = true;
  current_ = std::move(queue_.front());
  queue_.pop_front();
  queued_bytes_ -= current_.bytes.size();
  stream_.text(current_.text);
  stream_.async_write(asio::buffer(current_.bytes), [self = shared_from_this()](ErrorCode error, std::size_t) {
    self->writing_ = false;
    if (error) return self->close();
    self->write();
  });
}

void Session::close() {
  if (closed_) return;
  closed_ = true;
  queue_.clear();
  queued_bytes_ = 0;
  subscriptions_.clear();
  ErrorCode ignored;
  stream_.next_layer().socket().close(ignored);
  server_->sessions.erase(shared_from_this());
}

}  // namespace constrictor::dashboard
