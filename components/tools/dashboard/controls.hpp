// The interface to the source that viewers watch and command: a run, or a replay of a recording.
#pragma once

#include <cstdint>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "constrictor/messages.hpp"
#include "dashboard/web_server.hpp"

namespace constrictor::dashboard {

/// All functions are for the thread of the server.
class Controls {
 public:
  Controls() = default;
  virtual ~Controls() = default;
  Controls(const Controls&) = delete;
  Controls& operator=(const Controls&) = delete;

  /// The names of the services that viewers can call.
  [[nodiscard]] virtual std::vector<std::string> services() const = 0;
  /// DDS participant in the domain, for readers of this process.
  [[nodiscard]] virtual std::int32_t participant() const = 0;
  /// Carries out a call, in another thread if it must wait.
  virtual void add(WebServer::Call call) = 0;
  /// Why parameters cannot be changed; empty: they can be, by change().
  [[nodiscard]] virtual std::string frozen() const { return "a recording cannot be changed"; }
  /// Changes parameters to these numbers, in another thread.
  virtual void change(WebServer::Change) {}  // NOLINT(performance-unnecessary-value-param): overriders keep it
  /// Delivers the answers that have arrived, and looks at the state. Never waits.
  virtual void poll() = 0;
  /// Why there is nothing to show any more; empty while there is.
  [[nodiscard]] virtual std::string over() const = 0;
  /// The newest state of a run; empty for a replay.
  [[nodiscard]] virtual std::optional<msg::RunState> run() const { return {}; }
  /// The position of a replay, for the page; empty for a run.
  [[nodiscard]] virtual std::optional<nlohmann::json> replay() const { return {}; }
};

}  // namespace constrictor::dashboard
