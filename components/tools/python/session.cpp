#include "python/session.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <thread>

#include "client/components.hpp"
#include "client/parameters.hpp"
#include "client/polling.hpp"
#include "client/task_names.hpp"
#include "component/task_parameters.hpp"
#include "constrictor/constants.hpp"
#include "constrictor/json.hpp"
#include "cyclone/run_token.hpp"
#include "python/turn.hpp"
#include "robot/drive_motion.hpp"

namespace constrictor::python {
namespace {

using namespace std::chrono_literals;
using Json = nlohmann::ordered_json;
constexpr auto kStateBound = 3s;

RunNote run_in_directory(const std::string& directory) {
  namespace fs = std::filesystem;
  std::string list;
  std::error_code ignored;
  const fs::path wanted = fs::weakly_canonical(directory, ignored);
  for (const auto& run : live_runs()) {
    if (fs::weakly_canonical(run.report_dir, ignored) == wanted) return run;
    list += fmt::format("\n  {}", run.report_dir.string());
  }
  throw CommandError(
      fmt::format("no run on this host writes its report into {}{}{}", directory,
                  list.empty() ? "; no run on this host (start one with `constrictor run`)" : "; choose one of:", list),
      CommandError::Cause::kNoRun);
}

std::uint8_t constant(const ConstantGroup& group, const std::string& what, const std::string& name,
                      std::uint8_t first) {
  const auto value = value_of(group, name);
  if (!value || *value < first)
    throw std::invalid_argument(fmt::format("{}: found '{}', accepted {}", what, name, listed(group, first)));
  return *value;
}

double finite(const char* what, double value, double most, const char* unit) {
  if (!(std::abs(value) <= most))
    throw std::invalid_argument(fmt::format("{}: found {}, accepted -{} to {} {}", what, value, most, most, unit));
  return value;
}

}  // namespace

Session::Session(const SessionOptions& options, std::function<bool()> interrupted)
    : interrupted_(std::move(interrupted)), source_(unique_source(options.name)), detached_(options.detached) {
  if (options.observe) {
    domain_ = find_domain(options.domain);
  } else {
    note_ = options.directory.empty() ? join_run(options.domain) : run_in_directory(options.directory);
    domain_ = note_->domain;
  }
  request_options_.source = source_;
  request_options_.level = options.as_operator ? msg::kAuthorityOperator : msg::kAuthorityExternal;
  request_options_.detached = options.detached;
  request_options_.interrupted = [this] { return pass(); };
  if (!options.token.empty()) request_options_.key = RunKey{0, options.token};
  else if (!options.token_file.empty()) request_options_.key = RunKey{0, read_token_file(options.token_file)};
  else if (note_) request_options_.key = run_key(domain_);
  participant_ = std::make_shared<dds::Domain>(domain_);
  if (note_) monitor_ = std::make_unique<RunMonitor>(*note_, participant_->participant());
}

Session::~Session() {
  try {
    close();
  } catch (const std::exception& error) {
    std::fprintf(stderr, "constrictor: while leaving the run: %s\n", error.what());
  }
}

void Session::close() {
  if (closing_.exchange(true)) return;
  while (users_ > 0) std::this_thread::sleep_for(1ms);  // the others see closing_ within 10 ms
  const Turn turn(*this, true);
  leave_run();
  monitor_.reset();
  control_.reset();
  client_.reset();
  // A thread that waits for a sample has it for up to 50 ms more; until then this process cannot join again.
  const std::weak_ptr<dds::Domain> left = std::exchange(participant_, nullptr);
  for (const auto end = WaitClock::now() + 1s; !left.expired() && WaitClock::now() < end;)
    std::this_thread::sleep_for(1ms);
}

void Session::leave_run() {
  if (!client_ || detached_) return;
  try {
    client_->poll();
    if (!client_->holds_authority()) return;
    client_->move(msg::kMotionStand);
    static_cast<void>(client_->release(2s));
  } catch (const std::exception&) {
    // The run has gone, or DDS fails: `input` takes the authority of a source whose writer disappears.
  }
}

std::shared_ptr<dds::Domain> Session::participant() {
  const Turn turn(*this);
  return participant_;
}

void Session::need_run() const {
  if (!note_)
    throw CommandError(
        fmt::format("domain {}: it was opened by observe(), so that nothing in it can be commanded; "
                    "use join()",
                    domain_));
}

/// Gives the other threads their turn. Returns whether the wait must end.
bool Session::pass() {
  turns_.unlock();
  const bool stop = interrupted_();
  turns_.lock();
  return stop || closing_;
}

void Session::next_poll() {
  turns_.unlock();
  std::this_thread::sleep_for(kPoll);
  const bool stop = interrupted_();
  turns_.lock();
  if (stop || closing_)
    throw CommandError(closing_ ? "the run was left during this call" : "interrupted",
                       CommandError::Cause::kInterrupted);
}

RequestClient& Session::client() {
  need_run();
  if (!client_) client_ = std::make_unique<RequestClient>(participant_->participant(), domain_, request_options_);
  if (!client_->connected() || !client_->authority()) client_->connect_or_throw();
  static_cast<void>(client_->goals());  // from now on it follows the goals
  return *client_;
}

void Session::expect_going_on() {
  monitor_->poll();
  if (const std::string& over = monitor_->attachment().over(); !over.empty())
    throw CommandError(fmt::format("run {}: {}", domain_, over));
}

/// Returns if a request was granted, and throws the reason otherwise.
void Session::granted(RequestClient::Answer answer) {
  switch (answer) {
    case RequestClient::Answer::kGranted:
      return;
    case RequestClient::Answer::kRefused: {
      const auto& authority = client_->authority();
      const bool stopped = authority && authority->emergency_stop;
      throw CommandError(
          "refused: " + client_->refusal() + (stopped ? " (clear_stop() clears the emergency stop)" : ""),
          CommandError::Cause::kRefused);
    }
    case RequestClient::Answer::kInterrupted:
      throw CommandError("interrupted before the answer; the request was sent and may still be obeyed",
                         CommandError::Cause::kInterrupted);
    case RequestClient::Answer::kNone:
      break;
  }
  expect_going_on();
  throw CommandError(
      "no answer within 5 s. If the run is paused, the request is obeyed when the run resumes; "
      "otherwise see `constrictor status`",
      CommandError::Cause::kNoAnswer);
}

std::string Session::over() {
  const Turn turn(*this, true);
  if (closing_) return "the run was left";
  if (!monitor_) return {};
  monitor_->poll();
  return monitor_->attachment().over();
}

msg::RunState Session::state() {
  const Turn turn(*this);
  need_run();
  for (const auto end = WaitClock::now() + kStateBound;; next_poll()) {
    monitor_->poll();
    if (monitor_->state()) return *monitor_->state();
    if (WaitClock::now() > end) {
      throw WaitTimeout(fmt::format("run {}: no message on topic \"run_state\" within {} s (see `constrictor status`)",
                                    domain_, kStateBound.count()));
    }
  }
}

msg::Authority Session::authority() {
  const Turn turn(*this);
  client().poll();
  return *client_->authority();
}

Json Session::components() {
  const Turn turn(*this);
  need_run();
  Json json = Json::object();
  for (const auto& [name, status] : read_components(participant_->participant())) {
    json[name] = to_json(status);
    json[name]["state"] = name_of(constants::kComponent, status.state);
  }
  return json;
}

void Session::take() {
  const Turn turn(*this);
  granted(client().ask(msg::kRequestTake));
}

bool Session::release() {
  const Turn turn(*this);
  return client().release();
}

void Session::move(const std::string& motion, double speed_m_s, double curvature_1_m, double angle_rad) {
  const std::uint8_t value = constant(constants::kMotion, "motion", motion, 0);
  finite("speed_m_s", speed_m_s, 2.0, "m/s");
  finite("curvature_1_m", curvature_1_m, 5.0, "1/m");
  finite("angle_rad", angle_rad, 4.0, "rad");
  const Turn turn(*this);
  granted(client().move(value, speed_m_s, curvature_1_m, angle_rad));
}

void Session::drive(double speed_m_s, double turn_rad_s) {
  const DriveMotion motion =
      drive_motion(finite("speed_m_s", speed_m_s, 2.0, "m/s"), finite("turn_rad_s", turn_rad_s, 4.0, "rad/s"));
  const Turn turn(*this);
  granted(client().move(msg::kMotionDrive, motion.speed_m_s, motion.curvature_1_m));
}

std::uint64_t Session::start(const std::string& task, const TaskArguments& given) {
  msg::Request request = task_request(constant(constants::kTask, "task", task, 1));
  const auto colour = [](const char* what, const std::optional<std::string>& name, std::uint8_t& field) {
    if (name) field = constant(constants::kColour, what, *name, 1);
  };
  colour("line_colour", given.line_colour, request.parameters.line_colour);
  colour("object_colour", given.object_colour, request.parameters.object_colour);
  colour("drop_zone_colour", given.drop_zone_colour, request.parameters.drop_zone_colour);
  if (given.direction) request.parameters.direction = constant(constants::kDirection, "direction", *given.direction, 1);
  if (given.object_handle) request.parameters.object_handle = *given.object_handle;
  for (const auto& [name, number] : given.numbers) {
    const auto rows = task_numbers();
    const auto row =
        std::find_if(rows.begin(), rows.end(), [&wanted = name](const TaskNumber& r) { return r.info.name == wanted; });
    if (row == rows.end()) throw std::invalid_argument("unknown parameter " + name);
    if (!row->accepts(number))
      throw std::invalid_argument(fmt::format("{}: found {}, accepted {}", name, number, row->accepted()));
    request.parameters.*row->field = number;
  }
  std::string problem = given.path.empty() ? std::string{} : path_size_refusal(given.path.size());
  if (!problem.empty()) throw std::invalid_argument("path: " + problem);
  for (const auto& [x_m, y_m] : given.path) {
    request.path.x_m[request.path.point_count] = x_m;
    request.path.y_m[request.path.point_count] = y_m;
    ++request.path.point_count;
  }
  problem = request_refusal(request);
  if (!problem.empty()) throw std::invalid_argument(problem);
  const Turn turn(*this);
  return client().start_goal(request);
}

}  // namespace constrictor::python
