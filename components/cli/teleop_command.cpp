#include "cli/teleop_command.hpp"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <chrono>
#include <cmath>
#include <csignal>
#include <cstdio>
#include <memory>
#include <thread>

#include "cli/operator_client.hpp"
#include "cli/run_registry.hpp"
#include "cli/task_command.hpp"
#include "cli/task_names.hpp"
#include "cli/teleop_screen.hpp"
#include "cli/terminal.hpp"
#include "configuration/configuration.hpp"
#include "robot/drive_gait.hpp"
#include "runtime/host.hpp"

namespace constrictor::cli {
namespace {

using namespace std::chrono_literals;
using Clock = std::chrono::steady_clock;

/// If this process does not say for so long that it lives, the robot stops: long enough for a busy host, short enough for a hand.
constexpr auto kLease = 500ms;
constexpr auto kTurn = 50ms;      // of the loop
constexpr auto kRedraw = 100ms;

struct Options {
  std::optional<std::uint32_t> run;
  std::string drive;
  std::string duration;
};

volatile std::sig_atomic_t g_interrupted = 0;
void on_signal(int) { g_interrupted = 1; }

int no_input(const RunNote& run) {
  std::fprintf(stderr, "teleop: run %u has no `input` that listens\n", run.domain);
  return exit_status::kWaitedTooLong;
}

/// `--drive V,W --for T`: drives, stands, releases. 1 if it was refused or lost authority on the way.
int drive(const RunNote& run, const std::string& text, const std::string& duration) {
  double speed_m_s = 0.0;
  double turn_rad_s = 0.0;
  char rest = 0;
  const int count = std::sscanf(text.c_str(), "%lf,%lf%c", &speed_m_s, &turn_rad_s, &rest);
  if (count != 2 || !(std::abs(speed_m_s) <= 2.0) || !(std::abs(turn_rad_s) <= 4.0)) {
    throw ConfigurationError(fmt::format("--drive: found '{}', accepted SPEED,TURN in m/s (to 2) and rad/s (to 4), as 0.3,0.5", text));
  }
  const auto bound = duration.empty() ? std::chrono::milliseconds(24h * 365) : parse_duration("--for", duration);
  for (const int number : {SIGINT, SIGTERM, SIGHUP}) std::signal(number, on_signal);
  OperatorClient client(run.domain, unique_source("teleop"), kLease);
  if (!client.connect(5s)) return no_input(run);
  const DriveGait gait = drive_gait(speed_m_s, turn_rad_s);
  const std::uint64_t number = client.move(msg::kMotionDrive, gait.frequency_hz, gait.curvature_1_m);
  const auto answer = client.wait_for_answer(number, 5s);
  if (answer != OperatorClient::Answer::kGranted) {
    std::fprintf(stderr, "teleop: %s\n", answer == OperatorClient::Answer::kRefused ? client.refusal().c_str() : "no answer; is the run paused?");
    return answer == OperatorClient::Answer::kRefused ? exit_status::kMissionFailed : exit_status::kWaitedTooLong;
  }
  fmt::print("driving as {}\n", client.source());
  std::fflush(stdout);
  const auto start = Clock::now();
  while (Clock::now() - start < bound && g_interrupted == 0) {
    std::this_thread::sleep_for(kTurn);
    client.assert_alive();
    client.poll();
    if (client.holds_authority()) continue;
    std::fprintf(stderr, "teleop: lost authority to %s %s\n", authority_name(client.authority()->level), client.authority()->source);
    return exit_status::kMissionFailed;
  }
  client.move(msg::kMotionStand);
  client.wait_for_answer(client.ask(msg::kRequestRelease), 2s);
  return g_interrupted != 0 ? 128 + SIGINT : exit_status::kOk;
}

/// The full-screen client.
class Teleop {
 public:
  explicit Teleop(const RunNote& run) : terminal_(), client_(run.domain, unique_source("teleop"), kLease), observer_(client_.participant()) {
    screen_.run = fmt::format("{} {} seed {}", run.domain, run.scenario, run.seed);
    screen_.source = client_.source();
  }

  int loop() {
    if (!client_.connect(5s)) return exit_status::kWaitedTooLong;
    std::string typed;
    auto drawn = Clock::now() - kRedraw;
    while (!Terminal::interrupted()) {
      if (!terminal_.read(typed, kTurn)) break;
      client_.assert_alive();
      client_.poll();
      observer_.poll();
      for (std::string_view rest = typed; !rest.empty();) {
        if (screen_.prompt) type(rest);
        else if (!act(next_action(rest))) return leave();
      }
      note_refusal();
      if (Clock::now() - drawn < kRedraw && typed.empty()) continue;
      drawn = Clock::now();
      screen_.authority = client_.authority();
      screen_.view = observer_.view();
      terminal_.draw(render(screen_));
    }
    return leave();
  }

 private:
  /// Stands still and gives authority back, if it is ours. Whatever is not said here DDS says when the writer is gone.
  int leave() {
    if (client_.holds_authority()) client_.ask(msg::kRequestRelease);
    client_.flush();
    return exit_status::kOk;
  }

  /// False: quit.
  bool act(TeleopAction action) {
    if (screen_.drive.apply(action)) {
      const bool moves = screen_.drive.forward != 0.0 || screen_.drive.turn != 0.0;
      const DriveGait gait = drive_gait(screen_.drive.drive_m_s(), screen_.drive.turn_rad_s());
      if (moves) asked("drive", client_.move(msg::kMotionDrive, gait.frequency_hz, gait.curvature_1_m));
      else if (action == TeleopAction::kStand) asked("stand", client_.move(msg::kMotionStand));
      return true;
    }
    const auto still = [this] { screen_.drive.forward = screen_.drive.turn = 0.0; };
    switch (action) {
      case TeleopAction::kLookLeft:
      case TeleopAction::kLookAhead:
      case TeleopAction::kLookRight:
        still();
        asked("look", client_.move(msg::kMotionLook, 0.0, 0.0, screen_.drive.look_rad));
        break;
      case TeleopAction::kWrapLeft:
      case TeleopAction::kWrapRight:
        still();
        asked("wrap", client_.move(msg::kMotionWrap, 0.0, 0.0, action == TeleopAction::kWrapLeft ? 1.0 : -1.0));
        break;
      case TeleopAction::kSqueeze: still(); asked("squeeze", client_.move(msg::kMotionSqueeze)); break;
      case TeleopAction::kOpen: still(); asked("open", client_.move(msg::kMotionOpen)); break;
      case TeleopAction::kEmergencyStop: still(); asked("emergency stop", client_.ask(msg::kRequestEmergencyStop)); break;
      case TeleopAction::kClearStop: asked("clear stop", client_.ask(msg::kRequestClearStop)); break;
      case TeleopAction::kRelease: still(); asked("release", client_.ask(msg::kRequestRelease)); break;
      case TeleopAction::kCancel: still(); asked("cancel: stand", client_.move(msg::kMotionStand)); break;
      case TeleopAction::kTask: screen_.prompt = ""; break;
      case TeleopAction::kQuit: return false;
      default: break;
    }
    return true;
  }

  /// Takes keys for the task line.
  void type(std::string_view& rest) {
    const char key = rest.front();
    rest.remove_prefix(1);
    if (key == '\033' || key == '\003') {
      rest = {};
      screen_.prompt.reset();
    } else if (key == '\r' || key == '\n') {
      msg::Request request{};
      request.kind = msg::kRequestTask;
      request.command = msg::kCommandStart;  // goal_id 0: input numbers it
      request.parameters = no_parameters();
      number_ = 0;
      screen_.notice = parse_task(*screen_.prompt, request.task, request.parameters, request.path);
      screen_.prompt.reset();
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
    wish_ = what;
    number_ = number;
  }
  void note_refusal() {
    if (number_ == 0) return;
    const auto answer = client_.wait_for_answer(number_, 0ms);
    if (answer == OperatorClient::Answer::kRefused) screen_.notice = "REFUSED: " + client_.refusal();
    if (answer == OperatorClient::Answer::kGranted) screen_.notice = "granted: " + wish_;
    if (answer != OperatorClient::Answer::kNone) number_ = 0;
  }

  Terminal terminal_;  // first: it forks, and DDS has threads
  OperatorClient client_;
  TeleopObserver observer_;
  TeleopScreen screen_;
  std::uint64_t number_ = 0;   ///< request whose answer is awaited
  std::string wish_;           ///< what it asks for
};

int teleop(const Options& options) {
  const RunNote run = find_run(options.run);
  if (!options.drive.empty()) return drive(run, options.drive, options.duration);
  if (!options.duration.empty()) throw ConfigurationError("--for: accepted together with --drive");
  const int status = Teleop(run).loop();
  if (status != exit_status::kOk) no_input(run);
  return status;
}

}  // namespace

void add_teleop(CLI::App& app, std::function<int()>& action) {
  const auto options = std::make_shared<Options>();
  auto* sub = app.add_subcommand("teleop", "drive the robot by hand: a full-screen terminal client; with --drive for scripts");
  sub->add_option("--run", options->run, "the run, by its DDS domain (default: the only one there is)")->envname("CONSTRICTOR_DOMAIN");
  sub->add_option("--drive", options->drive, "SPEED,TURN in m/s and rad/s (0.3,0.5): drive without a screen, then stand and release");
  sub->add_option("--for", options->duration, "how long to drive, wall time: 5s, 500ms, 2m (default: until Ctrl-C)");
  sub->callback([&action, options] { action = [options] { return teleop(*options); }; });
}

}  // namespace constrictor::cli
