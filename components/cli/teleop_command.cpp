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
#include "cli/usage.hpp"
#include "robot/drive_gait.hpp"
#include "runtime/domain_claim.hpp"
#include "runtime/host.hpp"

namespace constrictor::cli {
namespace {

using namespace std::chrono_literals;
using Clock = std::chrono::steady_clock;

/// If this process does not say for so long that it lives, the robot stops: long enough for a busy host, short enough for a hand.
constexpr auto kLease = 500ms;
constexpr auto kTurn = 50ms;      // of the loop
constexpr auto kRedraw = 100ms;
constexpr auto kEscape = 400ms;   // an escape that is followed by nothing for so long is no part of a sequence
constexpr auto kClaimEvery = 200ms;

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

/// Looks whether the run that it began with is still there.
class RunWatch {
 public:
  RunWatch(const RunNote& run, std::int32_t participant)
      : domain_(run.domain), observer_(participant, run.plant) {}
  void look() {
    const auto now = Clock::now();
    if (now - claim_seen_ > kClaimEvery) {
      claim_seen_ = now;
      launcher_ = domain_claimed(domain_);
    }
    observer_.poll();
    RunSigns signs = observer_.signs();
    signs.launcher = launcher_;
    attachment_.look(signs, now);
  }
  [[nodiscard]] const RunAttachment& attachment() const { return attachment_; }
  [[nodiscard]] const TeleopView& view() const { return observer_.view(); }

 private:
  std::uint32_t domain_;
  TeleopObserver observer_;
  RunAttachment attachment_;
  Clock::time_point claim_seen_{};
  bool launcher_ = true;
};

/// `--drive V,W --for T`: drives, stands, releases. 1 if it was refused or lost authority on the way.
int drive(const Options& options) {
  double speed_m_s = 0.0;
  double turn_rad_s = 0.0;
  char rest = 0;
  const int count = std::sscanf(options.drive.c_str(), "%lf,%lf%c", &speed_m_s, &turn_rad_s, &rest);
  if (count != 2 || !(std::abs(speed_m_s) <= 2.0) || !(std::abs(turn_rad_s) <= 4.0)) {
    throw UsageError(fmt::format("--drive: found '{}', accepted SPEED,TURN in m/s (to 2) and rad/s (to 4), as 0.3,0.5", options.drive));
  }
  const auto bound = options.duration.empty() ? std::chrono::milliseconds(24h * 365) : parse_duration("--for", options.duration);
  const RunNote run = find_run(options.run);
  for (const int number : {SIGINT, SIGTERM, SIGHUP}) std::signal(number, on_signal);
  OperatorClient client(run.domain, unique_source("teleop"), kLease);
  if (!client.connect(5s)) return no_input(run);
  RunWatch watch(run, client.participant());
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
    watch.look();
    if (!watch.attachment().over().empty()) {
      std::fprintf(stderr, "teleop: %s\n", watch.attachment().over().c_str());
      return exit_status::kMissionFailed;
    }
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
  explicit Teleop(const RunNote& run)
      : terminal_(), client_(run.domain, unique_source("teleop"), kLease), watch_(run, client_.participant()) {
    screen_.run = fmt::format("{} {}", run.domain, run.scenario);
    screen_.source = client_.source();
  }

  /// Why it ended, if the operator did not want it.
  [[nodiscard]] const std::string& over() const { return watch_.attachment().over(); }

  int loop() {
    if (!client_.connect(5s)) return exit_status::kWaitedTooLong;
    auto drawn = Clock::now() - kRedraw;
    auto heard = Clock::now();
    std::string typed;
    while (!Terminal::interrupted()) {
      if (!terminal_.read(typed, kTurn)) break;
      watch_.look();
      if (!over().empty()) return exit_status::kMissionFailed;  // before poll(), which says again what was not answered
      client_.poll();
      client_.assert_alive();
      if (!typed.empty()) heard = Clock::now();
      keys_.add(typed);
      const bool quiet = Clock::now() - heard > kEscape;
      for (std::string key = keys_.next(quiet); !key.empty(); key = keys_.next(quiet)) {
        if (screen_.prompt) type(key);
        else if (!act(action_of(key))) return leave();
      }
      note_refusal();
      if (Clock::now() - drawn < kRedraw && typed.empty()) continue;
      drawn = Clock::now();
      screen_.authority = client_.authority();
      screen_.view = watch_.view();
      screen_.view.silent_s = watch_.attachment().silent_s();
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
    if (action == TeleopAction::kQuit) return false;
    const RunAttachment& run = watch_.attachment();
    if (action == TeleopAction::kEmergencyStop ? !run.may_stop() : !run.may_send()) {
      if (action != TeleopAction::kNone) screen_.notice = "nothing is sent: `input` is away, and may come back";
      return true;
    }
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
      default: break;
    }
    return true;
  }

  /// Takes keys for the task line.
  void type(const std::string& typed) {
    if (typed.size() != 1) return;  // arrows and the like
    const char key = typed.front();
    if (key == '\033' || key == '\003') {
      screen_.prompt.reset();
    } else if (key == '\r' || key == '\n') {
      msg::Request request{};
      request.kind = msg::kRequestTask;
      request.command = msg::kCommandStart;  // goal_id 0: input numbers it
      request.parameters = no_parameters();
      number_ = 0;
      screen_.notice = parse_task(*screen_.prompt, request.task, request.parameters, request.path);
      screen_.prompt.reset();
      if (screen_.notice.empty() && !watch_.attachment().may_send()) screen_.notice = "nothing is sent: `input` is away, and may come back";
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
  RunWatch watch_;
  KeyReader keys_;
  TeleopScreen screen_;
  std::uint64_t number_ = 0;   ///< request whose answer is awaited
  std::string wish_;           ///< what it asks for
};

int teleop(const Options& options) {
  if (!options.drive.empty()) return drive(options);
  if (!options.duration.empty()) throw UsageError("--for: accepted together with --drive");
  const RunNote run = find_run(options.run);
  int status = exit_status::kOk;
  std::string over;
  {
    Teleop client(run);
    status = client.loop();
    over = client.over();
  }
  // The terminal is itself again: what is said now stays.
  if (!over.empty()) std::fprintf(stderr, "teleop: %s\n", over.c_str());
  else if (status != exit_status::kOk) no_input(run);
  return status;
}

}  // namespace

void add_teleop(CLI::App& app, std::function<int()>& action) {
  const auto options = std::make_shared<Options>();
  auto* sub = app.add_subcommand("teleop", "drive the robot by hand: a full-screen terminal client; with --drive for scripts");
  add_run_option(*sub, options->run);
  sub->add_option("--drive", options->drive, "SPEED,TURN in m/s and rad/s (0.3,0.5): drive without a screen, then stand and release");
  sub->add_option("--for", options->duration, "how long to drive, wall time: 5s, 500ms, 2m (default: until Ctrl-C)");
  sub->footer(help_footer("Takes authority with the first key that moves something; gives it back at the end (q). The keys stand on its screen, an emergency\n"
                          "stop is the space bar. If this program or its terminal dies, the robot holds within half a second.",
                          {"constrictor teleop", "constrictor teleop --run 3", "constrictor teleop --drive 0.3,0.2 --for 5s"},
                          fmt::format("0 done; 1 refused, authority lost, or the run is gone; {}, or no terminal;\n"
                                      "  75 no `input` that listens; 130 --drive ended by Ctrl-C", kRunStatuses)));
  sub->callback([&action, options] { action = [options] { return teleop(*options); }; });
}

}  // namespace constrictor::cli
