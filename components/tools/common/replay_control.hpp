// How other programs of this user control a replay: a Unix socket, run_directory()/replay-DOMAIN.sock. Each packet is a
// JSON object, and each request gets one answer.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

namespace constrictor {

/// A request to a replay.
struct ReplayRequest {
  enum class Kind { kState, kPause, kResume, kStep, kSpeed, kSeek } kind = Kind::kState;
  /// kStep: number of ticks. kSpeed: times the recorded speed, 0: as fast as possible. kSeek: [s] after the first
  /// message.
  double value = 0;
};

/// The position and state of a replay.
struct ReplayState {
  double position_s = 0;  ///< [s] after the first message
  double length_s = 0;    ///< [s] from the first to the last message
  double speed = 1;       ///< times the recorded speed; 0: as fast as possible
  bool paused = false;
  bool ended = false;  ///< all messages have been published
  std::string file;
};

/// The socket of a replay. The process must hold the claim of the domain.
class ReplayServer {
 public:
  /// Throws std::runtime_error if the socket cannot be made.
  explicit ReplayServer(std::uint32_t domain);
  ~ReplayServer();
  ReplayServer(const ReplayServer&) = delete;
  ReplayServer& operator=(const ReplayServer&) = delete;

  /// Calls `obey` for each request that has arrived, and answers with the state that it returns. Never waits.
  void poll(const std::function<ReplayState(const ReplayRequest&)>& obey);
  /// True while a program is connected.
  [[nodiscard]] bool watched() const { return !clients_.empty(); }

 private:
  std::filesystem::path path_;
  int listener_;
  std::vector<int> clients_;
};

/// A program that controls a replay. For one thread.
class ReplayClient {
 public:
  /// Connects to the replay in `domain`. Throws std::runtime_error if there is none.
  explicit ReplayClient(std::uint32_t domain);
  ~ReplayClient();
  ReplayClient(const ReplayClient&) = delete;
  ReplayClient& operator=(const ReplayClient&) = delete;
  /// Asks and waits for the answer, at most 60 s. Throws std::runtime_error with the reason of a refusal, or if the
  /// replay has ended.
  ReplayState ask(const ReplayRequest& request);
  /// True when the replay's process is gone.
  [[nodiscard]] bool gone() const { return gone_; }

 private:
  int socket_;
  bool gone_ = false;
};

/// The domains of the replays on this host.
std::vector<std::uint32_t> live_replays();
/// Whether this domain is that of a replay on this host.
bool is_replay(std::optional<std::uint32_t> domain);
/// For commands to a run. Throws CommandError (kNoRun) if the domain is that of a replay.
void refuse_replay(std::optional<std::uint32_t> domain);

[[nodiscard]] nlohmann::json to_json(const ReplayState& state);
/// Both throw std::invalid_argument with what was found and what is accepted.
[[nodiscard]] ReplayRequest replay_request_of(const nlohmann::json& packet);
[[nodiscard]] ReplayState replay_state_of(const nlohmann::json& packet);

}  // namespace constrictor
