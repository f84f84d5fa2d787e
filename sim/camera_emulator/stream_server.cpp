#include "sim/camera_emulator/stream_server.hpp"

#include <fmt/format.h>

#include <boost/asio.hpp>
#include <boost/beast/core.hpp>
#include <boost/beast/http.hpp>
#include <deque>
#include <set>
#include <stdexcept>
#include <utility>

namespace constrictor::camera_emulator {
namespace {

namespace asio = boost::asio;
namespace http = boost::beast::http;
using tcp = asio::ip::tcp;
using ErrorCode = boost::beast::error_code;

constexpr std::size_t kMostClients = 8;
constexpr std::size_t kMostWaiting = 2;        // frames for a client
constexpr std::size_t kLongestRequest = 8192;  // bytes
constexpr auto kRequestBound = std::chrono::seconds(10);
constexpr int kSendBuffer = 64 * 1024;  // a longer one would only hold older frames
constexpr const char* kBoundary = "frame";

}  // namespace

struct StreamServer::Impl : std::enable_shared_from_this<Impl> {
  explicit Impl(tcp::endpoint at) : endpoint(std::move(at)), acceptor(context) {}
  void listen();
  void accept();

  asio::io_context context{1};
  tcp::endpoint endpoint;
  tcp::acceptor acceptor;
  std::set<std::shared_ptr<Session>> sessions;
  Jpeg newest;
};

/// One connection.
class StreamServer::Session : public std::enable_shared_from_this<Session> {
 public:
  Session(tcp::socket socket, std::weak_ptr<Impl> server) : stream_(std::move(socket)), server_(std::move(server)) {
    ErrorCode ignored;
    stream_.socket().set_option(tcp::no_delay(true), ignored);
    stream_.socket().set_option(asio::socket_base::send_buffer_size(kSendBuffer), ignored);
  }

  void begin() {
    parser_.body_limit(kLongestRequest);
    parser_.header_limit(kLongestRequest);
    stream_.expires_after(kRequestBound);
    http::async_read(stream_, buffer_, parser_, [self = shared_from_this()](ErrorCode error, std::size_t) {
      if (error) return self->close();
      self->answer();
    });
  }

  void send(const Jpeg& frame) {
    if (!streams_) return;
    if (waiting_.size() >= kMostWaiting) waiting_.pop_front();
    waiting_.push_back(frame);
    write_next();
  }

  void close() {
    ErrorCode ignored;
    stream_.socket().shutdown(tcp::socket::shutdown_both, ignored);
    stream_.socket().close(ignored);
    if (const auto server = server_.lock()) server->sessions.erase(shared_from_this());
  }

 private:
  void answer() {
    const auto server = server_.lock();
    if (!server) return;
    const auto& request = parser_.get();
    const std::string target(request.target());
    if (request.method() != http::verb::get) return finish("405 Method Not Allowed", "text/plain", "only GET\n");
    if (target == "/snapshot.jpg" && server->newest)
      return finish("200 OK", "image/jpeg", {server->newest->begin(), server->newest->end()});
    if (target != "/stream")
      return finish("404 Not Found", "text/plain", "accepted: /stream (multipart JPEG), /snapshot.jpg\n");
    text_ = fmt::format(
        "HTTP/1.1 200 OK\r\nCache-Control: no-store\r\nConnection: close\r\n"
        "Content-Type: multipart/x-mixed-replace; boundary={}\r\n\r\n",
        kBoundary);
    stream_.expires_never();
    writing_ = true;
    asio::async_write(stream_, asio::buffer(text_), [self = shared_from_this()](ErrorCode error, std::size_t) {
      if (error) return self->close();
      self->streams_ = true;
      self->writing_ = false;
      self->watch();
      self->write_next();
    });
  }

  /// Notices that the client has gone, although there may be nothing to send.
  void watch() {
    stream_.async_read_some(asio::buffer(ignored_), [self = shared_from_this()](ErrorCode error, std::size_t) {
      if (error) return self->close();
      self->watch();
    });
  }

  void finish(const std::string& status, const std::string& type, const std::string& body) {
    text_ = fmt::format("HTTP/1.1 {}\r\nConnection: close\r\nContent-Type: {}\r\nContent-Length: {}\r\n\r\n", status,
                        type, body.size()) +
            body;
    asio::async_write(stream_, asio::buffer(text_),
                      [self = shared_from_this()](ErrorCode, std::size_t) { self->close(); });
  }

  void write_next() {
    if (writing_ || waiting_.empty()) return;
    writing_ = true;
    frame_ = std::move(waiting_.front());
    waiting_.pop_front();
    text_ = fmt::format("--{}\r\nContent-Type: image/jpeg\r\nContent-Length: {}\r\n\r\n", kBoundary, frame_->size());
    const std::array<asio::const_buffer, 3> parts = {asio::buffer(text_), asio::buffer(*frame_),
                                                     asio::buffer("\r\n", 2)};
    asio::async_write(stream_, parts, [self = shared_from_this()](ErrorCode error, std::size_t) {
      if (error) return self->close();
      self->writing_ = false;
      self->write_next();
    });
  }

  boost::beast::tcp_stream stream_;
  std::weak_ptr<Impl> server_;
  boost::beast::flat_buffer buffer_;
  http::request_parser<http::string_body> parser_;
  std::array<char, 256> ignored_{};
  std::string text_;
  Jpeg frame_;
  std::deque<Jpeg> waiting_;
  bool streams_ = false;
  bool writing_ = false;
};

void StreamServer::Impl::listen() {
  ErrorCode error;
  acceptor.open(endpoint.protocol(), error);
  if (!error) acceptor.set_option(asio::socket_base::reuse_address(true), error);
  if (!error) acceptor.bind(endpoint, error);
  if (!error) acceptor.listen(asio::socket_base::max_listen_connections, error);
  if (error)
    throw std::runtime_error(fmt::format("cannot open port {} of {}: {}; choose another one with --port",
                                         endpoint.port(), endpoint.address().to_string(), error.message()));
  endpoint = acceptor.local_endpoint();
  accept();
}

void StreamServer::Impl::accept() {
  acceptor.async_accept([self = shared_from_this()](ErrorCode error, tcp::socket socket) {
    if (error == asio::error::operation_aborted || !self->acceptor.is_open()) return;
    if (!error && self->sessions.size() < kMostClients) {
      const auto session = std::make_shared<Session>(std::move(socket), self);
      self->sessions.insert(session);
      session->begin();
    }
    self->accept();
  });
}

StreamServer::StreamServer(const std::string& address, std::uint16_t port) {
  ErrorCode error;
  const auto at = asio::ip::make_address(address, error);
  if (error) throw std::runtime_error(fmt::format("--address: found '{}', accepted an IP address", address));
  impl_ = std::make_shared<Impl>(tcp::endpoint(at, port));
  impl_->listen();
}

StreamServer::~StreamServer() {
  switch_on(false);
  impl_->context.stop();
}

std::uint16_t StreamServer::port() const { return impl_->endpoint.port(); }
std::size_t StreamServer::clients() const { return impl_->sessions.size(); }

void StreamServer::send(const Jpeg& frame) {
  impl_->newest = frame;
  const auto sessions = impl_->sessions;  // a client that cannot be served is removed meanwhile
  for (const auto& session : sessions) session->send(frame);
}

void StreamServer::switch_on(bool on) {
  if (on == impl_->acceptor.is_open()) return;
  if (on) return impl_->listen();
  ErrorCode ignored;
  impl_->acceptor.close(ignored);
  const auto sessions = impl_->sessions;
  for (const auto& session : sessions) session->close();
}

void StreamServer::serve_until(std::chrono::steady_clock::time_point end) {
  impl_->context.restart();
  asio::steady_timer timer(impl_->context, end);
  timer.async_wait([this](ErrorCode) { impl_->context.stop(); });
  impl_->context.run();
}

}  // namespace constrictor::camera_emulator
