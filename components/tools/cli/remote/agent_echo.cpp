// What `constrictor doctor` asks of agents: whether UDP packets pass between two hosts.
#include <arpa/inet.h>
#include <netinet/in.h>
#include <sys/socket.h>

#include <array>
#include <cerrno>
#include <cstring>

#include "cli/remote/agent.hpp"

namespace constrictor::cli {
namespace {

using namespace std::chrono_literals;

constexpr auto kProbeEvery = 100ms;  // packets are repeated, because a link may lose some
constexpr auto kProbeBound = 3s;

sockaddr_in address_of(const std::string& ip, std::uint16_t port) {
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_port = htons(port);
  ::inet_pton(AF_INET, ip.c_str(), &address.sin_addr);
  return address;
}

}  // namespace

void Agent::open_echo(const nlohmann::json& message) {
  echo_ = Descriptor(::socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0));
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_addr.s_addr = htonl(INADDR_ANY);
  address.sin_port = htons(field<std::uint16_t>(message, "port"));
  const bool bound = ::bind(echo_.get(), reinterpret_cast<const sockaddr*>(&address), sizeof(address)) == 0;
  channel_->send({{"op", "echoing"}, {"error", bound ? "" : ::strerrordesc_np(errno)}});
}

void Agent::answer_echo() const {
  if (!echo_.open()) return;
  std::array<char, 64> bytes{};
  sockaddr_in from{};
  socklen_t size = sizeof(from);
  for (ssize_t count = 0; (count = ::recvfrom(echo_.get(), bytes.data(), bytes.size(), 0,
                                              reinterpret_cast<sockaddr*>(&from), &size)) > 0;) {
    ::sendto(echo_.get(), bytes.data(), static_cast<std::size_t>(count), 0, reinterpret_cast<const sockaddr*>(&from),
             size);
  }
}

void Agent::open_probe(const nlohmann::json& message) {
  probe_ = Descriptor(::socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0));
  const sockaddr_in from = address_of(field<std::string>(message, "from"), 0);
  const sockaddr_in to = address_of(field<std::string>(message, "to"), field<std::uint16_t>(message, "port"));
  // Only packets of the other end are received then, and its error if nothing reads at the port.
  if (::bind(probe_.get(), reinterpret_cast<const sockaddr*>(&from), sizeof(from)) != 0 ||
      ::connect(probe_.get(), reinterpret_cast<const sockaddr*>(&to), sizeof(to)) != 0)
    return end_probe(false);
  probe_until_ = Clock::now() + kProbeBound;
  next_probe_ = {};
}

void Agent::probe() {
  if (!probe_.open()) return;
  std::array<char, 64> bytes{};
  if (::recv(probe_.get(), bytes.data(), bytes.size(), 0) > 0) return end_probe(true);
  const auto now = Clock::now();
  if (now > probe_until_) return end_probe(false);
  if (now < next_probe_) return;
  next_probe_ = now + kProbeEvery;
  static_cast<void>(::send(probe_.get(), "echo", 4, MSG_NOSIGNAL));
}

void Agent::end_probe(bool passed) {
  probe_ = Descriptor();
  if (channel_) channel_->send({{"op", "probed"}, {"passed", passed}});
}

}  // namespace constrictor::cli
