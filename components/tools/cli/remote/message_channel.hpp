// Messages between the launcher and the agent of another host: one JSON object on each line.
#pragma once

#include <cstddef>
#include <deque>
#include <nlohmann/json.hpp>
#include <optional>
#include <stdexcept>
#include <string>

namespace constrictor::cli {

/// A message that violates the protocol between launcher and agent. The text names the field.
class ProtocolError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// Number of this protocol. Launcher and agent must have the same.
inline constexpr int kAgentProtocol = 2;

/// A file descriptor that is closed when its owner is destroyed.
class Descriptor {
 public:
  Descriptor() = default;
  explicit Descriptor(int number) : number_(number) {}
  Descriptor(Descriptor&& other) noexcept;
  Descriptor& operator=(Descriptor&& other) noexcept;
  Descriptor(const Descriptor&) = delete;
  ~Descriptor();
  [[nodiscard]] int get() const { return number_; }
  [[nodiscard]] bool open() const { return number_ >= 0; }

 private:
  int number_ = -1;
};

/// Sends and receives messages on a socket without ever waiting.
class MessageChannel {
 public:
  static constexpr std::size_t kLongestLine = 16 << 20;  ///< [byte]

  explicit MessageChannel(Descriptor socket);
  /// Queues a message. exchange() sends it.
  void send(const nlohmann::json& message);
  /// Sends and receives what is possible without waiting.
  void exchange();
  /// The next received message; empty: none has arrived completely. Lines that are not JSON objects are skipped before
  /// the first message, because a login shell may print a greeting. Throws ProtocolError if a later line is not a JSON
  /// object, or is too long.
  std::optional<nlohmann::json> receive();
  /// The other side closed the connection, or it broke. Messages that have been received can still be read.
  [[nodiscard]] bool closed() const { return closed_; }
  /// [byte] queued and not sent yet.
  [[nodiscard]] std::size_t unsent() const { return output_.size(); }
  [[nodiscard]] int descriptor() const { return socket_.get(); }

 private:
  Descriptor socket_;
  std::string input_;
  std::size_t searched_ = 0;  ///< [byte] beginning of input_ that contains no end of a line
  std::string output_;
  bool closed_ = false;
  bool begun_ = false;  ///< a message has been received
};

/// A field of a message. Throws ProtocolError if it is missing or has another type.
template <class T>
T field(const nlohmann::json& message, const char* name) {
  const auto found = message.find(name);
  if (found == message.end()) throw ProtocolError(std::string("a message lacks the field \"") + name + "\"");
  try {
    return found->template get<T>();
  } catch (const nlohmann::json::exception&) {
    throw ProtocolError(std::string("a message has a field \"") + name + "\" of another type");
  }
}

/// What is_plain_name() accepts, for messages to people.
inline constexpr const char* kPlainName = "1 to 200 letters, digits and . _ - +, not beginning with a dot";
/// Whether a text may name a file of a run or a process: neither a path nor a hidden file.
[[nodiscard]] bool is_plain_name(const std::string& name);
/// Whether a text is a relative path of plain names.
[[nodiscard]] bool is_plain_path(const std::string& path);

}  // namespace constrictor::cli
