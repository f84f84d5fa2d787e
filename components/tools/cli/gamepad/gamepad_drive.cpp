#include "cli/gamepad/gamepad_drive.hpp"

#include <fmt/format.h>
#include <poll.h>

#include <chrono>
#include <cmath>
#include <cstdio>
#include <map>
#include <memory>
#include <stdexcept>
#include <utility>

#include "cli/gamepad/device.hpp"
#include "cli/gamepad/gamepad.hpp"
#include "cli/teleop_drive.hpp"
#include "cli/teleop_request.hpp"
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

constexpr auto kTurn = 20ms;            // longest wait for events; much shorter than the lease
constexpr auto kShortest = 50ms;        // between two requests for another speed
constexpr auto kLookAgain = 500ms;      // for a gamepad that is gone
constexpr double kSmallest_m_s = 0.02;  // a smaller change of the stick is noise
constexpr double kSmallest_rad_s = 0.03;

/// Turns the input of the gamepad into requests.
class GamepadTeleop {
 public:
  GamepadTeleop(std::string wanted, std::string mapping_file, GamepadMapping mapping, const RunNote& run)
      : wanted_(std::move(wanted)),
        mapping_file_(std::move(mapping_file)),
        mapping_(std::move(mapping)),
        gamepad_(mapping_, {}),
        client_(run.domain, operator_options(unique_source("gamepad"), kTeleopLease)),
        monitor_(run, client_.participant()) {}

  int loop() {
    open();  // throws if it cannot be used at all
    if (const int status = connect(client_, "teleop"); status != exit_status::kOk) return status;
    say(fmt::format("{}: hold {} to move; {}", device_->name(), event_code_name(EV_KEY, mapping_.dead_man),
                    authority_text(client_.authority())));
    while (interrupt_signal() == 0) {
      wait();
      monitor_.poll();
      if (!monitor_.attachment().over().empty()) {
        std::fprintf(stderr, "teleop: %s; the robot holds its posture\n", monitor_.attachment().over().c_str());
        return exit_status::kFailed;
      }
      client_.poll();
      look_at_device();
      for (const TeleopAction action : gamepad_.take_actions()) act(action);
      drive();
      show_answers();
    }
    leave();
    return exit_status::kOk;
  }

 private:
  void say(const std::string& line) {
    fmt::print("{}\n", line);
    std::fflush(stdout);
  }

  void open() {
    device_ = std::make_unique<GamepadDevice>(
        choose_gamepad(wanted_, wanted_ == "auto" ? find_gamepads() : std::vector<GamepadCandidate>()), mapping_,
        mapping_file_);
    gamepad_ = Gamepad(mapping_, device_->ranges());
  }
  void wait() const {
    pollfd descriptor{device_ ? device_->descriptor() : -1, POLLIN, 0};
    ::poll(&descriptor, 1, static_cast<int>(kTurn.count()));
    // Without a writer, a FIFO is always readable.
    if (descriptor.revents & POLLHUP) ::poll(nullptr, 0, static_cast<int>(kTurn.count()));
  }
  /// Reads events. A gamepad that is gone is looked for until it is back.
  void look_at_device() {
    if (device_) {
      if (device_->read(gamepad_)) return greet();
      gamepad_.lost();
      away_ = true;
      say(fmt::format("{} is gone: the robot stands until it is back", device_->name()));
      device_.reset();
      looked_ = Clock::now();
      return;
    }
    if (Clock::now() - looked_ < kLookAgain) return;
    looked_ = Clock::now();
    try {
      open();
    } catch (const std::exception&) {
      // It is still away, or there are two now.
    }
  }
  void greet() {
    if (away_ && device_->present()) {
      away_ = false;
      say(device_->name() + " is back");
    }
  }

  /// Sends a motion when the sticks ask for another one than the robot has, and a stand at once when the dead-man
  /// button is released.
  void drive() {
    const double drive_m_s = gamepad_.drive_m_s();
    const double turn_rad_s = gamepad_.turn_rad_s();
    if (client_.holds_authority()) had_authority_ = true;
    else if (std::exchange(had_authority_, false) && driving_) {
      driving_ = false;
      blocked_ = true;
      say("authority was lost: " + no_authority_text(client_.authority(), client_.source()));
    }
    // After a stop or a refusal the robot must not move because the user still holds the button.
    if (gamepad_.take_released() || !gamepad_.held()) blocked_ = false;
    const bool moves = !blocked_ && (drive_m_s != 0.0 || turn_rad_s != 0.0);
    if (!moves) {
      if (driving_) ask("stand", client_.move(msg::kMotionStand));
      driving_ = false;
      sent_drive_m_s_ = sent_turn_rad_s_ = 0.0;
      return;
    }
    const bool other = !driving_ || std::abs(drive_m_s - sent_drive_m_s_) > kSmallest_m_s ||
                       std::abs(turn_rad_s - sent_turn_rad_s_) > kSmallest_rad_s;
    if (!other || (driving_ && Clock::now() - sent_ < kShortest)) return;
    if (!monitor_.attachment().may_send()) return;
    const DriveMotion motion = drive_motion(drive_m_s, turn_rad_s);
    const bool first = !driving_;
    const std::uint64_t number = client_.move(msg::kMotionDrive, motion.speed_m_s, motion.curvature_1_m);
    if (first) ask("drive", number);
    driving_ = true;
    sent_ = Clock::now();
    sent_drive_m_s_ = drive_m_s;
    sent_turn_rad_s_ = turn_rad_s;
  }

  void act(TeleopAction action) {
    using enum TeleopAction;
    const RunAttachment& run = monitor_.attachment();
    if (action == kEmergencyStop ? !run.may_stop() : !run.may_send())
      return say("not sent: `input` is missing; the launcher restarts it");
    static_cast<void>(look_.apply(action));  // keeps the angle of the head
    if (const auto sent = send_request(client_, action, look_.look_rad)) ask(sent->what, sent->number);
    if (action == kEmergencyStop) {
      driving_ = false;
      blocked_ = true;
    }
  }
  void ask(const std::string& what, std::uint64_t number) { asked_[number] = what; }
  void show_answers() {
    for (auto at = asked_.begin(); at != asked_.end();) {
      const msg::RequestAnswer* answer = client_.answer(at->first);
      if (!answer) {
        ++at;
        continue;
      }
      say(answer->granted ? at->second : fmt::format("{} refused: {}", at->second, answer->reason));
      if (!answer->granted && at->second == "drive") {
        driving_ = false;
        blocked_ = true;
      }
      at = asked_.erase(at);
    }
  }

  /// Makes the robot stand and gives authority back. If no answer comes, `input` takes authority back when the lease of
  /// this process ends.
  void leave() {
    if (!client_.holds_authority()) return say(no_authority_text(client_.authority(), client_.source()));
    client_.move(msg::kMotionStand);
    say(client_.release(2s) ? "the robot stands, authority was released"
                            : "no answer within 2 s; authority ends with this program");
  }

  std::string wanted_;
  std::string mapping_file_;
  GamepadMapping mapping_;
  Gamepad gamepad_;
  std::unique_ptr<GamepadDevice> device_;  ///< null: it is gone
  RequestClient client_;
  RunMonitor monitor_;
  TeleopDrive look_;
  std::map<std::uint64_t, std::string> asked_;  ///< requests without an answer, by number
  bool away_ = false;           ///< the gamepad was gone, and the user does not know yet that it is back
  bool driving_ = false;        ///< the last motion that was sent is a drive
  bool blocked_ = false;        ///< the dead-man button must be released first
  bool had_authority_ = false;  ///< at the last look
  double sent_drive_m_s_ = 0;
  double sent_turn_rad_s_ = 0;
  Clock::time_point sent_{};
  Clock::time_point looked_{};
};

}  // namespace

int gamepad_drive(const GamepadOptions& options, std::optional<std::uint32_t> run) {
  const std::string file = options.mapping.empty() ? GamepadMapping::default_file().string() : options.mapping;
  GamepadMapping mapping = GamepadMapping::load(file);  // its mistakes are reported also if there is no run
  return GamepadTeleop(options.device, file, std::move(mapping), join_run(run)).loop();
}

}  // namespace constrictor::cli
