#include "cli/teleop_drive.hpp"

#include <fmt/format.h>

#include <cmath>
#include <cstdio>
#include <thread>

#include "cli/task_command.hpp"
#include "cli/usage.hpp"
#include "client/run_monitor.hpp"
#include "client/run_registry.hpp"
#include "common/interrupt.hpp"
#include "common/operator.hpp"
#include "robot/drive_motion.hpp"
#include "runtime/host.hpp"

namespace constrictor::cli {
namespace {

using namespace std::chrono_literals;
using Clock = std::chrono::steady_clock;

DriveMotion parse_drive(const std::string& text) {
  double speed_m_s = 0.0;
  double turn_rad_s = 0.0;
  char rest = 0;
  const int count = std::sscanf(text.c_str(), "%lf,%lf%c", &speed_m_s, &turn_rad_s, &rest);
  if (count != 2 || !(std::abs(speed_m_s) <= 2.0) || !(std::abs(turn_rad_s) <= 4.0)) {
    throw UsageError(
        fmt::format("--drive: found '{}', accepted SPEED,TURN in m/s (to 2) and rad/s (to 4), as 0.3,0.5", text));
  }
  return drive_motion(speed_m_s, turn_rad_s);
}

/// Ends a drive: makes the robot stand and releases authority. Prints whether `input` has confirmed the release.
void stand_and_release(RequestClient& client) {
  client.move(msg::kMotionStand);
  if (client.release(2s)) {
    fmt::print("the robot stands, authority was released\n");
  } else {
    // `input` takes authority away when the lease ends, half a second after the end of this process.
    fmt::print(
        "no answer within 2 s: the robot holds and loses this program's authority 0.5 s after its end, or when "
        "the run resumes\n");
  }
}

}  // namespace

int teleop_drive(const std::string& speed_and_turn, const std::string& duration, std::optional<std::uint32_t> run) {
  const DriveMotion motion = parse_drive(speed_and_turn);
  const auto bound = duration.empty() ? std::chrono::milliseconds(24h * 365) : parse_duration("--for", duration);
  const RunNote note = join_run(run);
  RequestClient client(note.domain, operator_options(unique_source("teleop"), kTeleopLease));
  if (const int status = connect(client, "teleop"); status != exit_status::kOk) return status;
  RunMonitor monitor(note, client.participant());
  const auto answer =
      client.wait_for_answer(client.move(msg::kMotionDrive, motion.speed_m_s, motion.curvature_1_m), 5s);
  if (answer == RequestClient::Answer::kInterrupted) stand_and_release(client);
  if (answer != RequestClient::Answer::kGranted) return report_not_granted(client, answer, "teleop");
  fmt::print("driving as {}\n", client.source());
  std::fflush(stdout);
  for (const auto start = Clock::now(); Clock::now() - start < bound && interrupt_signal() == 0;) {
    std::this_thread::sleep_for(kTeleopTurn);
    monitor.poll();
    if (!monitor.attachment().over().empty()) {
      std::fprintf(stderr, "teleop: %s\n", monitor.attachment().over().c_str());
      return exit_status::kFailed;
    }
    client.poll();
    if (client.holds_authority()) continue;
    std::fprintf(stderr, "teleop: authority was lost: %s\n",
                 no_authority_text(client.authority(), client.source()).c_str());
    return exit_status::kFailed;
  }
  stand_and_release(client);
  return interrupt_signal() != 0 ? interrupt_status() : exit_status::kOk;
}

}  // namespace constrictor::cli
