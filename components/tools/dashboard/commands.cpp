#include "dashboard/commands.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <nlohmann/json.hpp>
#include <stdexcept>

#include "dashboard/protocol.hpp"

namespace constrictor::dashboard {
namespace {

using namespace std::chrono_literals;

const std::vector<std::string> kControls = {"pause", "resume", "step", "pace"};
const std::vector<std::string> kStops = {"stop", "clear_stop"};
const std::vector<std::string> kParameters = {kParameterList, "param_set"};
constexpr const char* kChange = "(change of parameters)";  // no service: viewers cannot call it
const std::vector<std::string> kDrives = {"take", "release", "drive", "stand", "task"};

bool contains(const std::vector<std::string>& names, const std::string& name) {
  return std::find(names.begin(), names.end(), name) != names.end();
}

std::string describe(const msg::RunState& state) {
  return state.paused ? fmt::format("paused, next tick {}", state.tick) : "running";
}

}  // namespace

std::string parameters_text(const std::map<std::string, OwnedParameter>& parameters) {
  nlohmann::ordered_json list = nlohmann::ordered_json::array();
  for (const auto& [name, owned] : parameters) list.push_back(to_json(owned));
  return list.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
}

std::vector<std::string> Commands::services() const {
  std::vector<std::string> all;
  for (const auto* names : {&kControls, &kStops, &kParameters, &kDrives})
    all.insert(all.end(), names->begin(), names->end());
  return all;
}

Commands::Commands(const RunNote& run, const Log& log)
    : driver_(run.domain, ending_),
      run_(driver_.participant(), run.domain, 10s, [this] { return ending_.load(); }),
      stops_(driver_.participant(), run.domain, operator_client("dash-stop", ending_)),
      parameters_(driver_.participant(), run.domain, operator_client("dash-param", ending_)),
      setter_(parameters_),
      monitor_(run, driver_.participant()),
      control_lane_(answers_, [this](const WebServer::Call& call) { return control(call); }),
      stop_lane_(answers_, [this](const WebServer::Call& call) { return stop(call); }),
      driver_lane_(
          answers_, [this](const WebServer::Call& call) { return driver_.obey(call); }, "drive",
          [this] { driver_.watch(); }, log),
      parameter_lane_(answers_, [this](const WebServer::Call& call) { return parameter(call); }) {}

Commands::~Commands() { ending_ = true; }

void Commands::poll() {
  monitor_.poll();
  answers_.deliver();
}

void Commands::add(WebServer::Call call) {
  const std::string name = call.service;
  (contains(kControls, name)     ? control_lane_
   : contains(kStops, name)      ? stop_lane_
   : contains(kParameters, name) ? parameter_lane_
                                 : driver_lane_)
      .add(std::move(call));
}

void Commands::change(WebServer::Change change) {
  nlohmann::json wishes = nlohmann::json::array();
  for (const auto& wish : change.values) wishes.push_back({{"name", wish.name}, {"value", wish.value}});
  const auto done = [change](const std::string& text) {
    std::vector<WebServer::Change::Result> results;
    for (const auto& result : nlohmann::json::parse(text)) results.push_back({result[0], result[1]});
    change.done(results);
  };
  const auto fail = [change](const std::string& reason) {
    change.done(std::vector(change.values.size(), WebServer::Change::Result{{}, reason}));
  };
  parameter_lane_.add({kChange, std::move(wishes), done, fail});
}

/// Returns the results as JSON: a list of [value, refusal].
std::string Commands::change_all(const nlohmann::json& wishes) {
  parameters_.connect_or_throw(5s);
  nlohmann::json results = nlohmann::json::array();
  std::string silence;  // why no further parameter is requested
  for (const auto& wish : wishes) {
    std::string refusal = silence;
    nlohmann::json value;
    try {
      if (silence.empty()) value = setter_.set(wish["name"].get<std::string>(), wish["value"].get<double>()).value;
    } catch (const CommandError& error) {
      refusal = error.what();
      if (error.cause() != CommandError::Cause::kRefused) silence = refusal;
    }
    results.push_back({value, refusal});
  }
  return results.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
}

std::string Commands::control(const WebServer::Call& call) {
  if (call.service == "pause") return describe(run_.pause());
  if (call.service == "resume") return describe(run_.resume());
  if (call.service == "step")
    return describe(run_.step(static_cast<std::uint32_t>(request_number(call, "ticks", 1, 1e6))));
  const double pace = request_number(call, "pace", 0, 1000);
  if (pace != 0 && pace < 0.001) throw std::invalid_argument("pace: accepted 0, or 0.001 to 1000");
  return describe(run_.set_pace(pace));
}

std::string Commands::stop(const WebServer::Call& call) {
  using Answer = RequestClient::Answer;
  const bool stops = call.service == "stop";
  if (!(stops ? stops_.connect_to_stop(5s) : stops_.connect(5s)))
    throw std::runtime_error(call.service + ": the run does not answer");
  const auto number = stops_.ask(stops ? msg::kRequestEmergencyStop : msg::kRequestClearStop);
  const auto answer = stops_.wait_for_answer(number, 5s);
  if (answer == Answer::kGranted)
    return stops ? "emergency stop: the robot holds its posture" : "emergency stop cleared";
  if (answer == Answer::kRefused) throw std::runtime_error(call.service + ": " + stops_.refusal());
  if (stops && stops_.plant_has_received_stop())
    throw std::runtime_error(
        "the plant has received the stop and obeys it at its next tick, but the run makes none now");
  throw std::runtime_error(call.service + ": no answer within 5 s");
}

std::string Commands::parameter(const WebServer::Call& call) {
  if (call.service == kChange) return change_all(call.request);
  if (call.service == kParameterList) return parameters_text(read_parameters(parameters_.participant()).parameters);
  const std::string name = request_text(call, "name");
  const double value = request_number(call, "value", -1e12, 1e12);
  parameters_.connect_or_throw(5s);
  try {
    const msg::ParameterChange change = setter_.set(name, value);
    return fmt::format("{}: {:g} from tick {} on", name, change.value, change.effective_tick);
  } catch (const CommandError& error) {
    throw std::runtime_error(named(name, error.what()));
  }
}

}  // namespace constrictor::dashboard
