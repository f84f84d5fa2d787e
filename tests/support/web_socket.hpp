// A WebSocket client (RFC 6455) for tests, over plain sockets: it can also do what a proper client never does.
#pragma once

#include <arpa/inet.h>
#include <netinet/in.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <chrono>
#include <cstdint>
#include <optional>
#include <string>

namespace constrictor::testing {

class WebSocket {
 public:
  struct Request {
    std::string protocol = "foxglove.sdk.v1";
    std::string origin;  ///< empty: none
    std::string host;    ///< empty: the server's
  };
  struct Message {
    bool text = false;
    std::string bytes;
  };

  /// Connects to a port of this host. `status` and `headers` then have the server's answer.
  explicit WebSocket(std::uint16_t port) : WebSocket(port, Request()) {}
  WebSocket(std::uint16_t port, const Request& request) : socket_(::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0)) {
    sockaddr_in to{};
    to.sin_family = AF_INET;
    to.sin_port = htons(port);
    to.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    if (::connect(socket_, reinterpret_cast<sockaddr*>(&to), sizeof to) != 0) return;
    std::string text =
        "GET / HTTP/1.1\r\nHost: " + (request.host.empty() ? "127.0.0.1:" + std::to_string(port) : request.host) +
        "\r\nUpgrade: websocket\r\nConnection: Upgrade\r\nSec-WebSocket-Version: 13\r\n"
        "Sec-WebSocket-Key: dGhlIHNhbXBsZSBub25jZQ==\r\nSec-WebSocket-Protocol: " +
        request.protocol + "\r\n";
    if (!request.origin.empty()) text += "Origin: " + request.origin + "\r\n";
    send_raw(text + "\r\n");
    while (headers.find("\r\n\r\n") == std::string::npos) {
      const auto byte = take(1);
      if (!byte) break;
      headers += *byte;
    }
    if (headers.size() > 12) status = std::stoi(headers.substr(9, 3));
  }
  ~WebSocket() { ::close(socket_); }
  WebSocket(const WebSocket&) = delete;
  WebSocket& operator=(const WebSocket&) = delete;

  /// Whatever bytes. False if the server has closed the connection.
  bool send_raw(const std::string& bytes) const {
    return ::send(socket_, bytes.data(), bytes.size(), MSG_NOSIGNAL) == static_cast<ssize_t>(bytes.size());
  }
  bool send_text(const std::string& text) const { return send_raw(frame(1, text)); }
  bool send_binary(const std::string& bytes) const { return send_raw(frame(2, bytes)); }

  /// The next message; empty if none arrives within `bound`, or if the connection is closed.
  std::optional<Message> receive(std::chrono::milliseconds bound = std::chrono::seconds(10)) {
    bound_ = bound;
    Message message;
    for (;;) {
      const auto head = take(2);
      if (!head) return {};
      const auto byte = [](char c) { return static_cast<std::uint8_t>(c); };
      const int kind = byte((*head)[0]) & 15;
      std::uint64_t size = byte((*head)[1]) & 127;
      if (size >= 126) {
        const auto more = take(size == 126 ? 2 : 8);
        if (!more) return {};
        size = 0;
        for (const char c : *more) size = size << 8 | byte(c);
      }
      const auto payload = take(size);
      if (!payload || kind == 8) return {};
      if (kind > 8) continue;  // ping
      if (kind != 0) message.text = kind == 1;
      message.bytes += *payload;
      if ((byte((*head)[0]) & 128) != 0) return message;
    }
  }

  int status = 0;  ///< 101: it is a WebSocket now; 0: no answer
  std::string headers;

 private:
  static std::string frame(int kind, const std::string& payload) {
    std::string bytes{static_cast<char>(128 | kind)};
    if (payload.size() < 126) {
      bytes += static_cast<char>(128 | payload.size());
    } else {
      bytes += static_cast<char>(128 | 126);
      bytes += static_cast<char>(payload.size() >> 8);
      bytes += static_cast<char>(payload.size() & 255);
    }
    const std::string mask = "\x12\x34\x56\x78";
    bytes += mask;
    for (std::size_t i = 0; i < payload.size(); ++i) bytes += static_cast<char>(payload[i] ^ mask[i % 4]);
    return bytes;
  }
  std::optional<std::string> take(std::size_t count) {
    while (waiting_.size() < count) {
      pollfd descriptor{socket_, POLLIN, 0};
      char bytes[65536];
      if (::poll(&descriptor, 1, static_cast<int>(bound_.count())) != 1) return {};
      const ssize_t size = ::recv(socket_, bytes, sizeof bytes, 0);
      if (size <= 0) return {};
      waiting_.append(bytes, static_cast<std::size_t>(size));
    }
    std::string taken = waiting_.substr(0, count);
    waiting_.erase(0, count);
    return taken;
  }

  int socket_;
  std::string waiting_;
  std::chrono::milliseconds bound_{10000};
};

}  // namespace constrictor::testing
