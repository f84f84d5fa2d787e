// The commands of viewers to a replay.
#pragma once

#include <chrono>
#include <cstdint>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "common/replay_control.hpp"
#include "cyclone/domain.hpp"
#include "dashboard/controls.hpp"
#include "dashboard/lane.hpp"

namespace constrictor::dashboard {

/// The services are those of a run that command its time, with the time of the recording: `pause`, `resume`, `step`
/// {"ticks": N}, `pace` {"pace": X} (times the recorded speed; 0: as fast as possible), and `seek` {"time_s": T}, the
/// seconds after the first message.
class ReplayControls : public Controls {
 public:
  /// `log`: of the program, for errors that answer no call. Throws std::runtime_error if there is no replay in this
  /// domain.
  ReplayControls(std::uint32_t domain, const Log& log);

  [[nodiscard]] std::vector<std::string> services() const override {
    return {"pause", "resume", "step", "pace", "seek"};
  }
  [[nodiscard]] std::int32_t participant() const override { return domain_.participant(); }
  void add(WebServer::Call call) override { lane_.add(std::move(call)); }
  void poll() override { answers_.deliver(); }
  [[nodiscard]] std::string over() const override;
  [[nodiscard]] std::optional<nlohmann::json> replay() const override;
  /// The recording that is replayed.
  [[nodiscard]] std::string file() const;

 private:
  std::string obey(const WebServer::Call& call);
  void look();
  void keep(const ReplayState& state);

  dds::Domain domain_;
  ReplayClient client_;  ///< used by the constructor and then by the lane's thread
  std::chrono::steady_clock::time_point looked_{};
  mutable std::mutex mutex_;
  ReplayState state_;
  bool over_ = false;
  Answers answers_;
  Lane lane_;  ///< last: its thread uses the others
};

}  // namespace constrictor::dashboard
