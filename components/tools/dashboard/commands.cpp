#include "dashboard/commands.hpp"

#include <fmt/format.h>

#include <chrono>
#include <stdexcept>

#include "client/source.hpp"

namespace constrictor::dashboard {
namespace {

using namespace std::chrono_literals;

constexpr std::size_t kMostWaiting = 16;  // in one lane

RequestClientOptions client_options(const std::atomic<bool>& ending) {
  RequestClientOptions options;
  options.source = unique_source("dashboard");
  options.level = msg::kAuthorityOperator;
  options.lease = {};
  options.interrupted = [&ending] { return ending.load(); };
  return options;
}

/// A number of the request from `low` to `high`.
double number_of(const WebServer::Call& call, const char* key, double low, double high) {
  const auto found = call.request.find(key);
  const bool good =
      found != call.request.end() && found->is_number() && found->get<double>() >= low && found->get<double>() <= high;
  if (!good)
    throw std::invalid_argument(fmt::format("{}: accepted {{\"{}\": {} to {}}}", call.service, key, low, high));
  return found->get<double>();
}

std::string describe(const msg::RunState& state) {
  return state.paused ? fmt::format("paused, next tick {}", state.tick) : "running";
}

}  // namespace

std::vector<std::string> Commands::services() {
  return {"pause", "resume", "step", "pace", "stop", "clear_stop", "release"};
}

Commands::Commands(std::uint32_t domain)
    : requests_(domain, client_options(ending_)),
      run_(requests_.participant(), domain, 10s, [this] { return ending_.load(); }),
      control_lane_(*this, [this](const WebServer::Call& call) { return control(call); }),
      request_lane_(*this, [this](const WebServer::Call& call) { return request(call); }) {}

Commands::~Commands() { ending_ = true; }

void Commands::add(WebServer::Call call) {
  const auto& name = call.service;
  const bool control = name == "pause" || name == "resume" || name == "step" || name == "pace";
  (control ? control_lane_ : request_lane_).add(std::move(call));
}

std::string Commands::control(const WebServer::Call& call) {
  if (call.service == "pause") return describe(run_.pause());
  if (call.service == "resume") return describe(run_.resume());
  if (call.service == "step") return describe(run_.step(static_cast<std::uint32_t>(number_of(call, "ticks", 1, 1e6))));
  const double pace = number_of(call, "pace", 0, 1000);
  if (pace != 0 && pace < 0.001) throw std::invalid_argument("pace: accepted 0, or 0.001 to 1000");
  return describe(run_.set_pace(pace));
}

std::string Commands::request(const WebServer::Call& call) {
  using Answer = RequestClient::Answer;
  const bool stops = call.service == "stop";
  if (!(stops ? requests_.connect_to_stop(5s) : requests_.connect(5s)))
    throw std::runtime_error(call.service + ": the run does not answer");
  if (call.service == "release") {
    if (requests_.wait_for_answer(requests_.ask(msg::kRequestTake), 5s) == Answer::kRefused)
      throw std::runtime_error("release: " + requests_.refusal());
  }
  const auto kind = stops                          ? msg::kRequestEmergencyStop
                    : call.service == "clear_stop" ? msg::kRequestClearStop
                                                   : msg::kRequestRelease;
  const auto answer = requests_.wait_for_answer(requests_.ask(kind), 5s);
  if (answer == Answer::kGranted) {
    return stops                       ? "emergency stop: the robot holds its posture"
           : call.service == "release" ? "authority released"
                                       : "emergency stop cleared";
  }
  if (answer == Answer::kRefused) throw std::runtime_error(call.service + ": " + requests_.refusal());
  if (stops && requests_.plant_has_received_stop())
    throw std::runtime_error(
        "the plant has received the stop and obeys it at its next tick, but the run makes none now");
  throw std::runtime_error(call.service + ": no answer within 5 s");
}

void Commands::answered(std::function<void()> deliver) {
  const std::lock_guard lock(mutex_);
  answers_.push_back(std::move(deliver));
}

void Commands::poll() {
  std::vector<std::function<void()>> due;
  {
    const std::lock_guard lock(mutex_);
    due.swap(answers_);
  }
  for (const auto& deliver : due) deliver();
}

Commands::Lane::Lane(Commands& owner, Do what) : owner_(owner), do_(std::move(what)), thread_([this] { work(); }) {}

Commands::Lane::~Lane() {
  {
    const std::lock_guard lock(mutex_);
    ending_ = true;
  }
  changed_.notify_all();
  thread_.join();
}

void Commands::Lane::add(WebServer::Call call) {
  {
    const std::lock_guard lock(mutex_);
    if (waiting_.size() < kMostWaiting) {
      waiting_.push_back(std::move(call));
      changed_.notify_all();
      return;
    }
  }
  call.fail("too many commands are waiting for their answers");
}

void Commands::Lane::work() {
  for (;;) {
    WebServer::Call call;
    {
      std::unique_lock lock(mutex_);
      changed_.wait(lock, [this] { return ending_ || !waiting_.empty(); });
      if (ending_) return;
      call = std::move(waiting_.front());
      waiting_.pop_front();
    }
    try {
      owner_.answered([text = do_(call), call] { call.answer(text); });
    } catch (const std::exception& error) {
      owner_.answered([text = std::string(error.what()), call] { call.fail(text); });
    }
  }
}

}  // namespace constrictor::dashboard
