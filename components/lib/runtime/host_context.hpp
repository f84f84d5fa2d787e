// The state that the member side and the conductor side of a process share.
#pragma once

#include <chrono>
#include <optional>
#include <string>
#include <utility>

#include "log/log.hpp"
#include "runtime/host.hpp"

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
  const Log log;
  std::optional<int> exit_status;  ///< set as soon as the process has to end

  /// To be called when the run makes progress: the patience of this process starts again.
  void note_progress() { last_progress_ = Clock::now(); }
  /// [s] since the last progress.
  [[nodiscard]] double waited_s() const { return std::chrono::duration<double>(Clock::now() - last_progress_).count(); }

 private:
  Clock::time_point last_progress_ = Clock::now();
};

}  // namespace constrictor
