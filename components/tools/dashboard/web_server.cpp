#include "dashboard/web_server.hpp"

#include <fmt/format.h>

#include <stdexcept>

#include "dashboard/web_session.hpp"

namespace constrictor::dashboard {
namespace {

namespace asio = boost::asio;
using tcp = asio::ip::tcp;
using ErrorCode = boost::beast::error_code;

std::string host_without_port(std::string host) {
  const auto bracket = host.rfind(']');
  const auto colon = host.rfind(':');
  if (colon != std::string::npos && (bracket == std::string::npos || colon > bracket)) host.resize(colon);
  return host;
}

}  // namespace

std::string wrong_address(const std::string& text) {
  ErrorCode error;
  asio::ip::make_address(text, error);
  return error ? fmt::format("found '{}', accepted an IP address, such as 127.0.0.1 or 0.0.0.0", text) : "";
}

WebServer::Impl::Impl(WebOptions given, std::string given_name, const std::vector<std::string>& names, OnCall call,
                      OnChange change)
    : options(std::move(given)),
      name(std::move(given_name)),
      acceptor(context),
      on_call(std::move(call)),
      on_change(std::move(change)) {
  for (const auto& service : names) services.push_back({static_cast<std::uint32_t>(services.size() + 1), service});
  // Only the files that are there now are served: no request can lead to another place.
  std::error_code error;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(options.page, error)) {
    if (entry.is_regular_file())
      files.emplace("/" + entry.path().lexically_relative(options.page).generic_string(), entry.path());
  }
}

bool WebServer::Impl::knows_host(const std::string& host) const {
  const std::string plain = host_without_port(host);
  if (!acceptor.local_endpoint().address().is_loopback()) return true;
  return plain == "localhost" || plain == "127.0.0.1" || plain == "[::1]" || plain == options.address;
}

void WebServer::Impl::listen() {
  ErrorCode error;
  const tcp::endpoint endpoint(asio::ip::make_address(options.address), options.port);
  acceptor.open(endpoint.protocol());
  acceptor.set_option(asio::socket_base::reuse_address(true));
  acceptor.bind(endpoint, error);
  if (!error) acceptor.listen(asio::socket_base::max_listen_connections, error);
  if (error) {
    throw std::runtime_error(fmt::format(
        "cannot open port {} of {}: {}; choose another one with --port (with `constrictor run --view`: --view-port)",
        options.port, options.address, error.message()));
  }
  acceptor.non_blocking(true);
  accept();
}

void WebServer::Impl::accept() {
  acceptor.async_accept([self = shared_from_this()](ErrorCode error, tcp::socket socket) {
    if (error == asio::error::operation_aborted) return;
    // Requests for files end by themselves or after kRequestBound.
    if (!error && self->connections < 4 * kMostClients) std::make_shared<Session>(std::move(socket), self)->begin();
    self->accept();
  });
}

WebServer::WebServer(WebOptions options, std::string name, const std::vector<std::string>& services, OnCall on_call,
                     OnChange on_change)
    : impl_(std::make_shared<Impl>(std::move(options), std::move(name), services, std::move(on_call),
                                   std::move(on_change))) {
  impl_->listen();
}

WebServer::~WebServer() {
  ErrorCode ignored;
  impl_->acceptor.close(ignored);
  for (const auto& session : std::set(impl_->sessions)) session->close();
  impl_->context.stop();
}

std::uint32_t WebServer::add_channel(Channel channel) {
  channel.id = static_cast<std::uint32_t>(impl_->channels.size() + 1);
  impl_->channels.push_back(std::move(channel));
  const std::string text = advertise({impl_->channels.back()});
  const auto sessions = impl_->sessions;  // as in send()
  for (const auto& session : sessions) session->send_text(text);
  return impl_->channels.back().id;
}

bool WebServer::wanted(std::uint32_t channel) const {
  return std::any_of(impl_->sessions.begin(), impl_->sessions.end(),
                     [&](const auto& session) { return session->wants(channel); });
}

void WebServer::send(std::uint32_t channel, std::uint64_t time_ns, std::string_view payload) {
  const auto sessions = impl_->sessions;  // a client that cannot be served is removed meanwhile
  for (const auto& session : sessions) session->send_data(channel, time_ns, payload);
}

void WebServer::set_parameters(const std::vector<ParameterValue>& values) {
  for (const auto& value : values) impl_->parameters.insert_or_assign(value.name, value);
  const auto sessions = impl_->sessions;  // as in send()
  for (const auto& session : sessions) session->send_news();
}

void WebServer::tell_end(const std::string& why) {
  const auto sessions = impl_->sessions;  // as in send()
  const std::string text = status(0, why, "end");
  for (const auto& session : sessions) session->send_text(text);
}

void WebServer::poll() {
  impl_->context.restart();
  impl_->context.poll();
}

std::uint16_t WebServer::port() const { return impl_->acceptor.local_endpoint().port(); }
bool WebServer::on_this_host_only() const { return impl_->acceptor.local_endpoint().address().is_loopback(); }
std::uint64_t WebServer::dropped() const { return impl_->dropped; }

}  // namespace constrictor::dashboard
