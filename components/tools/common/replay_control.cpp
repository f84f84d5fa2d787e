#include "common/replay_control.hpp"

#include <fmt/format.h>
#include <poll.h>
#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <stdexcept>
#include <utility>

#include "client/command_error.hpp"
#include "cyclone/domain_claim.hpp"

namespace constrictor {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;
using Kind = ReplayRequest::Kind;

constexpr int kBound_ms = 60'000;  // a seek reads the recording from its beginning
constexpr std::size_t kMostBytes = 4096;
constexpr std::size_t kMostClients = 8;

struct Named {
  const char* name;
  Kind kind;
  double low, high;  ///< accepted values
};
constexpr std::array kKinds = {Named{"state", Kind::kState, 0, 0},   Named{"pause", Kind::kPause, 0, 0},
                               Named{"resume", Kind::kResume, 0, 0}, Named{"step", Kind::kStep, 1, 1e6},
                               Named{"speed", Kind::kSpeed, 0, 1e3}, Named{"seek", Kind::kSeek, 0, 1e9}};

fs::path socket_file(std::uint32_t domain) { return run_directory() / fmt::format("replay-{}.sock", domain); }

sockaddr_un address_of(const fs::path& path) {
  sockaddr_un address{};
  address.sun_family = AF_UNIX;
  if (path.native().size() >= sizeof(address.sun_path))
    throw std::runtime_error(
        fmt::format("{}: too long for a socket; set XDG_RUNTIME_DIR to a shorter folder", path.string()));
  std::memcpy(address.sun_path, path.c_str(), path.native().size() + 1);
  return address;
}

/// Empty: the other side has closed its socket, or has sent nothing that fits.
std::string receive(int socket) {
  std::string packet(kMostBytes, '\0');
  const ssize_t size = ::recv(socket, packet.data(), packet.size(), 0);
  packet.resize(size > 0 ? static_cast<std::size_t>(size) : 0);
  return packet;
}

bool send(int socket, const json& packet) {
  const std::string text = packet.dump(-1, ' ', false, json::error_handler_t::replace);
  return ::send(socket, text.data(), text.size(), MSG_NOSIGNAL | MSG_DONTWAIT) == static_cast<ssize_t>(text.size());
}

/// A socket that is connected to the replay in `domain`; -1 with errno if nobody listens.
int connected(std::uint32_t domain, int flags = 0) {
  const sockaddr_un address = address_of(socket_file(domain));
  const int socket = ::socket(AF_UNIX, SOCK_SEQPACKET | SOCK_CLOEXEC | flags, 0);
  if (socket < 0 || ::connect(socket, reinterpret_cast<const sockaddr*>(&address), sizeof address) == 0) return socket;
  const int error = errno;
  ::close(socket);
  errno = error;
  return -1;
}

/// Whether a replay listens in `domain`. A replay that was killed leaves its socket file, and a run may use its domain.
bool listens(std::uint32_t domain) {
  const int socket = connected(domain, SOCK_NONBLOCK);
  if (socket >= 0) ::close(socket);
  return socket >= 0 || errno == EAGAIN;  // so many programs connect that one more would have to wait
}

}  // namespace

ReplayRequest replay_request_of(const json& packet) {
  const std::string name = packet.is_object() ? packet.value("do", json()).dump() : "nothing";
  for (const Named& one : kKinds) {
    if (name != fmt::format("\"{}\"", one.name)) continue;
    if (one.high == 0) return {one.kind, 0};
    const json value = packet.value("value", json());
    if (!value.is_number() || !(value.get<double>() >= one.low && value.get<double>() <= one.high))
      throw std::invalid_argument(
          fmt::format("{}: found {}, accepted {} to {}", one.name, value.dump().substr(0, 40), one.low, one.high));
    if (one.kind == Kind::kSpeed && value.get<double>() != 0 && value.get<double>() < 1e-3)
      throw std::invalid_argument(fmt::format("speed: found {}, accepted 0, or 0.001 to 1000", value.dump()));
    return {one.kind, value.get<double>()};
  }
  throw std::invalid_argument(
      fmt::format("found {}, accepted state, pause, resume, step, speed, seek", name.substr(0, 40)));
}

json to_json(const ReplayState& state) {
  return {{"position_s", state.position_s}, {"length_s", state.length_s}, {"speed", state.speed},
          {"paused", state.paused},         {"ended", state.ended},       {"file", state.file}};
}

ReplayState replay_state_of(const json& packet) {
  try {
    return {packet.at("position_s"), packet.at("length_s"), packet.at("speed"),
            packet.at("paused"),     packet.at("ended"),    packet.at("file")};
  } catch (const json::exception& error) {
    throw std::invalid_argument(fmt::format("the answer of the replay is not a state: {}", error.what()));
  }
}

ReplayServer::ReplayServer(std::uint32_t domain)
    : path_(socket_file(domain)), listener_(::socket(AF_UNIX, SOCK_SEQPACKET | SOCK_CLOEXEC | SOCK_NONBLOCK, 0)) {
  const sockaddr_un address = address_of(path_);
  fs::remove(path_);  // of a replay that was killed: this process holds the claim of the domain
  if (listener_ < 0 || ::bind(listener_, reinterpret_cast<const sockaddr*>(&address), sizeof address) != 0 ||
      ::listen(listener_, static_cast<int>(kMostClients)) != 0) {
    const int error = errno;
    if (listener_ >= 0) ::close(listener_);
    throw std::runtime_error(fmt::format("{}: {}", path_.string(), std::strerror(error)));
  }
}

ReplayServer::~ReplayServer() {
  for (const int client : clients_) ::close(client);
  ::close(listener_);
  std::error_code ignored;
  fs::remove(path_, ignored);
}

void ReplayServer::poll(const std::function<ReplayState(const ReplayRequest&)>& obey) {
  for (int client; (client = ::accept4(listener_, nullptr, nullptr, SOCK_CLOEXEC | SOCK_NONBLOCK)) >= 0;) {
    if (clients_.size() < kMostClients) clients_.push_back(client);
    else ::close(client);
  }
  for (const int client : std::vector<int>(clients_)) {
    pollfd ready{client, POLLIN, 0};
    if (::poll(&ready, 1, 0) <= 0) continue;
    const std::string text = receive(client);
    bool open = !text.empty();
    if (open) {
      try {
        open = send(client, to_json(obey(replay_request_of(json::parse(text, nullptr, false)))));
      } catch (const std::invalid_argument& refusal) {
        open = send(client, {{"refused", refusal.what()}});
      }
    }
    if (open) continue;
    ::close(client);
    clients_.erase(std::find(clients_.begin(), clients_.end(), client));
  }
}

ReplayClient::ReplayClient(std::uint32_t domain) : socket_(connected(domain)) {
  if (socket_ >= 0) return;
  const int error = errno;
  throw std::runtime_error(
      fmt::format("no replay in DDS domain {}: {}: {}", domain, socket_file(domain).string(), std::strerror(error)));
}

ReplayClient::~ReplayClient() { ::close(socket_); }

ReplayState ReplayClient::ask(const ReplayRequest& request) {
  const auto named =
      std::find_if(kKinds.begin(), kKinds.end(), [&](const Named& one) { return one.kind == request.kind; });
  pollfd ready{socket_, POLLIN, 0};
  std::string text;
  if (send(socket_, {{"do", named->name}, {"value", request.value}}) && ::poll(&ready, 1, kBound_ms) > 0)
    text = receive(socket_);
  if (text.empty()) {
    gone_ = true;  // an answer that comes later would be taken for that of another request
    throw std::runtime_error("the replay has ended, or does not answer");
  }
  const json answer = json::parse(text, nullptr, false);
  if (answer.is_object() && answer.value("refused", json()).is_string())
    throw std::runtime_error(answer["refused"].get<std::string>());
  return replay_state_of(answer);
}

std::vector<std::uint32_t> live_replays() {
  std::vector<std::uint32_t> domains;
  for (const auto& entry : fs::directory_iterator(run_directory())) {
    std::uint32_t domain = 0;
    if (std::sscanf(entry.path().filename().c_str(), "replay-%u.sock", &domain) == 1 &&
        entry.path() == socket_file(domain) && listens(domain))
      domains.push_back(domain);
  }
  std::sort(domains.begin(), domains.end());
  return domains;
}

bool is_replay(std::optional<std::uint32_t> domain) {
  const auto replays = domain ? live_replays() : std::vector<std::uint32_t>();
  return std::find(replays.begin(), replays.end(), domain) != replays.end();
}

void refuse_replay(std::optional<std::uint32_t> domain) {
  if (!is_replay(domain)) return;
  throw CommandError(fmt::format("--run: found {0}, a replay, accepted a run; the keys of `constrictor replay` and "
                                 "`constrictor dashboard --run {0}` pause and end it",
                                 *domain),
                     CommandError::Cause::kNoRun);
}

}  // namespace constrictor
