// The state that the member side and the conductor side of a process share.
#pragma once

#include <algorithm>
#include <chrono>
#include <cstdint>
#include <optional>
#include <string>
#include <utility>

#include "cyclone/run_token.hpp"
#include "log/log.hpp"
#include "runtime/awake_clock.hpp"
#include "runtime/host.hpp"
#include "scheduling/scheduling.hpp"

namespace constrictor {

class HostContext {
 public:
  using Clock = std::chrono::steady_clock;

  HostContext(HostOptions host_options, const std::string& identity_of_process, std::string hash, std::string name)
      : options(std::move(host_options)),
        identity(identity_of_process),
        config_hash(std::move(hash)),
        host_name(std::move(name)),
        log(identity_of_process) {}

  const HostOptions options;
  const std::string identity;     ///< names of the components of this process, comma separated
  const std::string config_hash;  ///< run_config_hash()
  const std::string host_name;
  const std::string scheduling = scheduling_in_force();  ///< of this process, for people
  const Log log;
  std::optional<int> exit_status;  ///< set as soon as the process has to end

  /// Why a client with this token that names this run (0: any) may not command it; empty if it may. `run_id`: the run;
  /// 0: it has not begun.
  [[nodiscard]] std::string stranger(const char* token, std::uint64_t named_run_id, std::uint64_t run_id) const {
    if (!options.token.empty() && !same_token(token, options.token)) {
      return *token == '\0' ? "token: found none, accepted the run's token (see --token-file)"
                            : "token: found another one than the run's (see --token-file)";
    }
    if (named_run_id != 0 && run_id != 0 && named_run_id != run_id) return "run_id: of another run";
    return {};
  }

  /// To be called when the run makes progress: the patience of this process starts again.
  void note_progress() {
    waited_ = {};
    progress_ = awake_.now();
  }
  /// To be called several times a second while this process waits.
  void note_waiting() { waited_ = awake_.now() - progress_; }
  /// [s] of waiting since the last progress, at the last note_waiting().
  [[nodiscard]] double waited_s() const { return std::chrono::duration<double>(waited_).count(); }

 private:
  AwakeClock awake_;
  Clock::duration waited_{};
  Clock::time_point progress_ = awake_.now();  ///< in the time of awake_
};

}  // namespace constrictor
