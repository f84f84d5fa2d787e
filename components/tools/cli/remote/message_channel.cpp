#include "cli/remote/message_channel.hpp"

#include <fcntl.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <utility>

#include "constrictor/json.hpp"

namespace constrictor::cli {

Descriptor::Descriptor(Descriptor&& other) noexcept : number_(std::exchange(other.number_, -1)) {}
Descriptor& Descriptor::operator=(Descriptor&& other) noexcept {
  std::swap(number_, other.number_);
  return *this;
}
Descriptor::~Descriptor() {
  if (number_ >= 0) ::close(number_);
}

MessageChannel::MessageChannel(Descriptor socket) : socket_(std::move(socket)) {
  ::fcntl(socket_.get(), F_SETFL, ::fcntl(socket_.get(), F_GETFL) | O_NONBLOCK);
}

void MessageChannel::send(const nlohmann::json& message) {
  if (!closed_) output_ += json_text(message) + "\n";
}

void MessageChannel::exchange() {
  while (!output_.empty() && !closed_) {
    const ssize_t count = ::send(socket_.get(), output_.data(), output_.size(), MSG_NOSIGNAL);
    if (count < 0 && errno == EINTR) continue;
    if (count < 0 && errno == EAGAIN) break;
    if (count < 0) closed_ = true;
    else output_.erase(0, static_cast<std::size_t>(count));
  }
  std::array<char, 65536> bytes{};
  while (input_.size() <= kLongestLine) {
    const ssize_t count = ::recv(socket_.get(), bytes.data(), bytes.size(), 0);
    if (count < 0 && errno == EINTR) continue;
    if (count < 0 && errno == EAGAIN) return;
    if (count <= 0) {
      closed_ = true;
      return;
    }
    input_.append(bytes.data(), static_cast<std::size_t>(count));
  }
}

std::optional<nlohmann::json> MessageChannel::receive() {
  while (true) {
    const auto end = input_.find('\n', searched_);
    if (end == std::string::npos) {
      searched_ = input_.size();
      if (searched_ > kLongestLine) throw ProtocolError("a message is longer than 16 MiB");
      return std::nullopt;
    }
    auto message =
        nlohmann::json::parse(input_.begin(), input_.begin() + static_cast<std::ptrdiff_t>(end), nullptr, false);
    const std::string line = message.is_object() ? "" : input_.substr(0, std::min<std::size_t>(end, 80));
    input_.erase(0, end + 1);
    searched_ = 0;
    if (message.is_object()) {
      begun_ = true;
      return message;
    }
    if (begun_) throw ProtocolError("found the line \"" + line + "\", accepted a JSON object");
  }
}

bool is_plain_name(const std::string& name) {
  return !name.empty() && name.size() <= 200 && name.front() != '.' &&
         std::all_of(name.begin(), name.end(), [](unsigned char c) {
           return c < 128 && (std::isalnum(c) != 0 || c == '.' || c == '_' || c == '-' || c == '+');
         });
}

bool is_plain_path(const std::string& path) {
  const auto slash = path.find('/');
  if (slash == std::string::npos) return is_plain_name(path);
  return is_plain_name(path.substr(0, slash)) && is_plain_path(path.substr(slash + 1));
}

}  // namespace constrictor::cli
