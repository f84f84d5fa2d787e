#include "dashboard/driver.hpp"

#include <fmt/format.h>

#include <stdexcept>

#include "client/task_names.hpp"
#include "common/operator.hpp"
#include "component/task_parameters.hpp"
#include "dashboard/lane.hpp"
#include "dashboard/protocol.hpp"
#include "robot/drive_motion.hpp"

namespace constrictor::dashboard {
namespace {

using namespace std::chrono_literals;
using Clock = std::chrono::steady_clock;

}  // namespace

RequestClientOptions operator_client(const char* name, const std::atomic<bool>& ending) {
  RequestClientOptions options;
  options.source = unique_source(name);
  options.level = msg::kAuthorityOperator;  // the lease is that of `constrictor teleop`
  options.interrupted = [&ending] { return ending.load(); };
  return options;
}

void expect_granted(RequestClient& client, std::uint64_t number, const std::string& service) {
  using Answer = RequestClient::Answer;
  const Answer answer = client.wait_for_answer(number, 5s);
  if (answer == Answer::kGranted) return;
  if (answer == Answer::kRefused) throw std::runtime_error(service + ": " + client.refusal());
  throw std::runtime_error(service +
                           ": no answer within 5 s; if the run is paused, the request is obeyed when it resumes");
}

std::string Driver::obey(const WebServer::Call& call) {
  if (call.service == "drive") {
    const double speed_m_s = request_number(call, "speed_m_s", -2, 2);
    return drive(speed_m_s, request_number(call, "turn_rad_s", -4, 4));
  }
  const std::string line = call.service == "task" ? request_text(call, "task") : "";
  client_.connect_or_throw(5s);
  drive_.reset();  // whatever follows ends a drive
  if (call.service == "task") return task(line);
  if (call.service == "release") return release();
  const bool takes = call.service == "take";
  expect_granted(client_, takes ? client_.ask(msg::kRequestTake) : client_.move(msg::kMotionStand), call.service);
  return takes ? "authority taken: the robot holds its posture" : "the robot stands";
}

std::string Driver::drive(double speed_m_s, double turn_rad_s) {
  if (speed_m_s == 0 && turn_rad_s == 0) {
    if (!drive_) return "the robot stands already, or is not driven from here";  // a stand would take authority
    drive_.reset();
    expect_granted(client_, client_.move(msg::kMotionStand), "drive");
    return "the robot stands";
  }
  client_.connect_or_throw(5s);
  check_authority();
  if (!drive_ || drive_->speed_m_s != speed_m_s || drive_->turn_rad_s != turn_rad_s) {
    const DriveMotion motion = drive_motion(speed_m_s, turn_rad_s);
    const bool held = drive_ && drive_->held;
    drive_.reset();
    expect_granted(client_, client_.move(msg::kMotionDrive, motion.speed_m_s, motion.curvature_1_m), "drive");
    drive_ = Drive{speed_m_s, turn_rad_s, held};
  }
  until_ = Clock::now() + kSilence;
  return fmt::format("{:.2f} m/s, {:.2f} rad/s", speed_m_s, turn_rad_s);
}

/// A drive that lost authority, to an emergency stop or to another operator, must not take it back by itself.
void Driver::check_authority() {
  client_.poll();
  if (!drive_) return;
  if (client_.holds_authority()) {
    drive_->held = true;
  } else if (drive_->held) {
    drive_.reset();
    throw std::runtime_error("drive: authority was lost: " + no_authority_text(client_.authority(), client_.source()));
  }
}

std::string Driver::task(const std::string& line) {
  msg::Request request = task_request(msg::kTaskNone);
  std::string problem = parse_task(line, request.task, request.parameters, request.path);
  if (problem.empty()) problem = request_refusal(request);
  if (!problem.empty()) throw std::invalid_argument(named("task", problem));
  client_.start_goal(request);
  return fmt::format("{} was accepted", task_word(request.task));
}

std::string Driver::release() {
  // Taken first, so that authority is also taken back from a script that has not released it.
  expect_granted(client_, client_.ask(msg::kRequestTake), "release");
  expect_granted(client_, client_.ask(msg::kRequestRelease), "release");
  return "authority released";
}

std::string task_forms() {
  nlohmann::json forms = nlohmann::json::array();
  for (std::uint8_t task = msg::kTaskNone + 1; task < msg::kTaskCount; ++task) {
    nlohmann::json parameters = nlohmann::json::array();
    for (const auto& [name, values, optional] : task_parameters_of(task))
      parameters.push_back({{"name", name}, {"values", values}, {"optional", optional}});
    forms.push_back({{"task", task_word(task)}, {"parameters", parameters}});
  }
  return forms.dump();
}

void Driver::watch() {
  client_.poll();
  if (!drive_ || Clock::now() < until_) return;
  drive_.reset();
  client_.move(msg::kMotionStand);
}

}  // namespace constrictor::dashboard
