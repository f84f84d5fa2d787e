// The commands of viewers that need authority: to drive, and to start tasks.
#pragma once

#include <atomic>
#include <chrono>
#include <cstdint>
#include <optional>
#include <string>

#include "client/request_client.hpp"
#include "dashboard/web_server.hpp"

namespace constrictor::dashboard {

/// Options of a client with the level of an operator. `name` begins the name of its source; each client of a process
/// needs one of its own. Waits end when `ending` becomes true.
RequestClientOptions operator_client(const char* name, const std::atomic<bool>& ending);

/// Waits for the answer to a request. Throws std::runtime_error with the reason if it is not granted.
void expect_granted(RequestClient& client, std::uint64_t number, const std::string& service);

/// One source with the level of an operator, which all viewers share. The first drive or task takes authority, as in
/// `constrictor teleop`. All functions are for one thread.
class Driver {
 public:
  /// A drive ends when no viewer has repeated it for this time: the page was closed, or its network is gone.
  static constexpr std::chrono::milliseconds kSilence{500};

  /// Joins the DDS domain of the run.
  Driver(std::uint32_t domain, const std::atomic<bool>& ending)
      : client_(domain, operator_client("dashboard", ending)) {}
  [[nodiscard]] std::int32_t participant() const { return client_.participant(); }

  /// Carries out `drive` {"speed_m_s", "turn_rad_s"} (both 0: let go), `stand`, `task` {"task": "rotate
  /// direction=left"}, `take`, `release`. Returns the answer; throws std::exception with the reason of a refusal.
  std::string obey(const WebServer::Call& call);
  /// To be called at least every 50 ms: ends a drive that no viewer repeats.
  void watch();

 private:
  struct Drive {
    double speed_m_s, turn_rad_s;
    bool held;  ///< this source has been seen with authority since the drive began
  };
  std::string drive(double speed_m_s, double turn_rad_s);
  std::string task(const std::string& line);
  std::string release();
  void check_authority();

  RequestClient client_;
  std::optional<Drive> drive_;  ///< empty: no viewer drives
  std::chrono::steady_clock::time_point until_{};
};

/// JSON for the page: every task with its parameters, [{"task": "rotate", "parameters": [{"name": "direction",
/// "values": ["left", "right"], "optional": false}]}, ...]. No values: points.
std::string task_forms();

}  // namespace constrictor::dashboard
