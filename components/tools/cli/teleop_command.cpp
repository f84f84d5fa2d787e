// `constrictor teleop`: drive the robot by hand, in a terminal or from a script.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <chrono>
#include <cstdio>
#include <memory>

#include "cli/gamepad/gamepad_drive.hpp"
#include "cli/subcommands.hpp"
#include "cli/teleop_drive.hpp"
#include "cli/teleop_request.hpp"
#include "cli/teleop_screen.hpp"
#include "cli/terminal.hpp"
#include "cli/usage.hpp"
#include "client/run_monitor.hpp"
#include "client/run_registry.hpp"
#include "client/task_names.hpp"
#include "common/interrupt.hpp"
#include "common/operator.hpp"
#include "component/task_parameters.hpp"
#include "robot/drive_motion.hpp"
#include "runtime/host.hpp"

namespace constrictor::cli {
namespace {

using namespace std::chrono_literals;
using Clock = std::chrono::steady_clock;

constexpr auto kRedraw = 100ms;
constexpr auto kEscape = 400ms;  // if no byte follows an escape character for this time, it was the escape key
constexpr const char* kInputMissing = "not sent: `input` is missing; the launcher restarts it";

struct TeleopOptions {
  std::optional<std::uint32_t> run;
  std::string drive;
  std::string duration;
  GamepadOptions gamepad;
};

/// The full-screen client.
class Teleop {
 public:
  explicit Teleop(const RunNote& run)
      : client_(run.domain, operator_options(unique_source("teleop"), kTeleopLease)),
        monitor_(run, client_.participant()),
        observer_(client_.participant(), monitor_) {
    screen_.run = fmt::format("{} {}", run.domain, run.scenario);
    screen_.source = client_.source();
  }

  /// Why the program had to leave the run; empty: the user left it.
  [[nodiscard]] const std::string& over() const { return monitor_.attachment().over(); }
  /// Why no request can be sent; empty: requests could be sent.
  [[nodiscard]] const std::string& missing() const { return missing_; }
  /// The text for the user that describes the authority at the end.
  [[nodiscard]] const std::string& farewell() const { return farewell_; }

  int loop() {
    try {
      client_.connect_or_throw(5s);
    } catch (const CommandError& error) {
      if (error.cause() == CommandError::Cause::kInterrupted) return interrupt_status();
      missing_ = error.what();
      return exit_status::kWaitedTooLong;
    }
    auto drawn = Clock::now() - kRedraw;
    auto heard = Clock::now();
    std::string typed;
    while (interrupt_signal() == 0) {
      if (!terminal_.read(typed, kTeleopTurn)) break;
      monitor_.poll();
      observer_.poll();
      if (!over().empty()) return exit_status::kFailed;  // before poll(), which would repeat unanswered requests
      client_.poll();
      if (!typed.empty()) heard = Clock::now();
      keys_.add(typed);
      const bool quiet = Clock::now() - heard > kEscape;
      for (std::string key = keys_.next(quiet); !key.empty(); key = keys_.next(quiet)) {
        if (screen_.prompt) type(key);
        else if (!act(action_of(key))) return leave();
      }
      show_answer();
      const ScreenSize size = screen_size();
      if (Clock::now() - drawn < kRedraw && typed.empty() && size == drawn_size_) continue;
      drawn = Clock::now();
      drawn_size_ = size;
      screen_.authority = client_.authority();
      screen_.view = observer_.view();
      terminal_.draw(render(screen_, size), size);
    }
    return leave();
  }

 private:
  /// Releases authority if this program has it; the robot then stands. If no answer arrives, DDS reports the end of
  /// this program to `input`, which takes authority back half a second later.
  int leave() {
    const bool asks = client_.holds_authority() || number_ != 0;  // a request without an answer may be granted yet
    const bool left = !asks || client_.release(2s);
    const bool stopped = client_.authority() && client_.authority()->emergency_stop;
    if (left && (stopped || !asks)) farewell_ = no_authority_text(client_.authority(), client_.source());
    else if (left) farewell_ = "authority was released, the robot stands";
    else farewell_ = "no answer within 2 s; authority ends with this program, at the latest when the run resumes";
    return exit_status::kOk;
  }

  /// Returns false if the program must quit.
  bool act(TeleopAction action) {
    if (action == TeleopAction::kQuit) return false;
    const RunAttachment& run = monitor_.attachment();
    if (action == TeleopAction::kEmergencyStop ? !run.may_stop() : !run.may_send()) {
      if (action != TeleopAction::kNone) screen_.notice = kInputMissing;
      return true;
    }
    if (screen_.drive.apply(action)) {
      const bool moves = screen_.drive.forward != 0.0 || screen_.drive.turn != 0.0;
      const DriveMotion motion = drive_motion(screen_.drive.drive_m_s(), screen_.drive.turn_rad_s());
      if (moves) asked("drive", client_.move(msg::kMotionDrive, motion.speed_m_s, motion.curvature_1_m));
      else if (action == TeleopAction::kStand) asked("stand", client_.move(msg::kMotionStand));
      return true;
    }
    if (action == TeleopAction::kTask) screen_.prompt = "";
    else if (action != TeleopAction::kNone) request(action);
    return true;
  }

  /// Sends the request of an action that is neither a drive nor a task. All but one also end the drive.
  void request(TeleopAction action) {
    if (action != TeleopAction::kClearStop) screen_.drive.forward = screen_.drive.turn = 0.0;
    if (const auto sent = send_request(client_, action, screen_.drive.look_rad)) asked(sent->what, sent->number);
  }

  /// Takes keys for the task line.
  void type(const std::string& typed) {
    if (typed.size() != 1) return;  // arrows and other special keys
    const char key = typed.front();
    if (key == '\033' || key == '\003') {
      screen_.prompt.reset();
    } else if (key == '\r' || key == '\n') {
      msg::Request request = task_request(msg::kTaskNone);
      number_ = 0;
      screen_.notice = parse_task(*screen_.prompt, request.task, request.parameters, request.path);
      if (screen_.notice.empty()) screen_.notice = request_refusal(request);
      screen_.prompt.reset();
      if (screen_.notice.empty() && !monitor_.attachment().may_send()) screen_.notice = kInputMissing;
      if (!screen_.notice.empty()) return;
      screen_.drive.forward = screen_.drive.turn = 0.0;
      asked(task_word(request.task), client_.ask(request));
    } else if (key == '\177' || key == '\b') {
      if (!screen_.prompt->empty()) screen_.prompt->pop_back();
    } else if (key >= ' ' && screen_.prompt->size() < 70) {
      *screen_.prompt += key;
    }
  }

  void asked(const std::string& what, std::uint64_t number) {
    screen_.notice = "asked: " + what;
    request_ = what;
    number_ = number;
  }
  void show_answer() {
    if (number_ == 0) return;
    const msg::RequestAnswer* answer = client_.answer(number_);
    if (!answer) return;
    screen_.notice = answer->granted ? "granted: " + request_ : std::string("REFUSED: ") + answer->reason;
    number_ = 0;
  }

  Terminal terminal_;  // first, because it forks: the client starts threads, which must not exist at the fork
  RequestClient client_;
  RunMonitor monitor_;
  TeleopObserver observer_;
  KeyReader keys_;
  TeleopScreen screen_;
  ScreenSize drawn_size_{0, 0};
  std::uint64_t number_ = 0;  ///< number of the request that is not answered yet; 0: none
  std::string request_;       ///< the name of this request on the screen
  std::string missing_;
  std::string farewell_;
};

int teleop(const TeleopOptions& options) {
  if (!options.drive.empty()) return teleop_drive(options.drive, options.duration, options.run);
  if (!options.duration.empty()) throw UsageError("--for: accepted only together with --drive");
  if (!options.gamepad.device.empty()) return gamepad_drive(options.gamepad, options.run);
  if (!options.gamepad.mapping.empty()) throw UsageError("--mapping: accepted only together with --gamepad");
  const RunNote run = join_run(options.run);
  int status = exit_status::kOk;
  std::string over;
  std::string missing;
  std::string farewell;
  {
    Teleop client(run);
    status = client.loop();
    over = client.over();
    missing = client.missing();
    farewell = client.farewell();
  }
  // The terminal is restored: what is printed now stays on it.
  if (!over.empty()) std::fprintf(stderr, "teleop: %s; the robot holds its posture\n", over.c_str());
  else if (!missing.empty()) std::fprintf(stderr, "teleop: %s\n", missing.c_str());
  else if (!farewell.empty()) fmt::print("teleop: {}\n", farewell);
  return status;
}

}  // namespace

void add_teleop(CLI::App& app, Action& action) {
  const auto options = std::make_shared<TeleopOptions>();
  auto* sub = add_subcommand(app, "teleop", "drive the robot by hand in a terminal; with --drive from a script", action,
                             options, teleop);
  add_run_option(*sub, options->run);
  sub->add_option(
      "--drive", options->drive,
      "SPEED,TURN in m/s and rad/s, for example 0.3,0.5: drive without a screen for the time of --for, then make "
      "the robot stand and release authority");
  sub->add_option("--for", options->duration,
                  "duration of --drive in wall time, for example 5s, 500ms, 2m (default: until Ctrl-C)");
  sub->add_option("--gamepad", options->gamepad.device,
                  "drive with a gamepad, without a screen: `auto`, or the path of an event device "
                  "(/dev/input/event5), or of a FIFO with its events")
      ->excludes("--drive");
  sub->add_option("--mapping", options->gamepad.mapping,
                  "which stick and button does what (YAML; default: components/tools/cli/gamepad/gamepad.yaml)")
      ->check(existing_file());
  sub->footer(help_footer(
      "The first key that moves the robot takes authority; q or Ctrl-C releases it. The screen shows the keys; the "
      "space bar is the emergency\nstop. If this program or its terminal dies, the robot holds its posture within half "
      "a second. The terminal needs 40x10 characters; a larger one shows more.\n\nWith --gamepad the robot moves only "
      "while "
      "the dead-man button is held (left shoulder), and stands when it is released. A gamepad\nthat is unplugged "
      "counts "
      "as released; when it is back, press the button anew. The button of the emergency stop always works.",
      {"constrictor teleop", "constrictor teleop --run 3", "constrictor teleop --drive 0.3,0.2 --for 5s",
       "constrictor teleop --gamepad auto", "constrictor teleop --gamepad /dev/input/event5 --mapping my_pad.yaml"},
      fmt::format("0 done; 1 refused, authority lost, or the run is gone; {}, or no terminal;\n"
                  "  75 no answer from `input`; 130 --drive ended by Ctrl-C",
                  kRunStatuses)));
}

}  // namespace constrictor::cli
