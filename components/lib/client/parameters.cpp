#include "client/parameters.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <nlohmann/json.hpp>
#include <optional>
#include <thread>

#include "client/polling.hpp"
#include "component/parameters.hpp"
#include "constrictor/topics.hpp"
#include "cyclone/discovery.hpp"
#include "cyclone/endpoint.hpp"

namespace constrictor {
namespace {

using namespace std::chrono_literals;
/// Writers keep several lists for late readers. The lists arrive one after the other; the last one is valid.
constexpr auto kQuiet = 300ms;

/// The name of a value; null if the parameter is a number.
std::optional<std::string> name_of(const msg::Parameter& parameter, double value) {
  const auto names = choices_of(parameter);
  if (!(value >= 0.0 && value < static_cast<double>(names.size()))) return std::nullopt;
  return names[static_cast<std::size_t>(value)];
}

}  // namespace

ParameterView read_parameters(std::int32_t participant, std::chrono::milliseconds bound) {
  struct Source {
    const TopicInfo* topic;
    dds::Reader<msg::ParameterList> reader;
    std::optional<msg::ParameterList> newest;
  };
  std::vector<Source> sources;
  for (const auto& topic : topics::kInfos) {
    if (topic.type == topics::kNavigationParameters.type) {
      sources.push_back(
          {&topic, dds::Reader<msg::ParameterList>::member(participant, std::string(topic.name)), std::nullopt});
    }
  }
  const dds::Discovery discovery(participant);
  const auto has_writer = [&](const Source& source) {
    const auto endpoints = discovery.endpoints();
    return std::any_of(endpoints.begin(), endpoints.end(),
                       [&](const auto& e) { return e.writer && e.topic == source.topic->name; });
  };
  const auto start = WaitClock::now();
  auto heard = start;
  for (;;) {
    for (auto& source : sources) {
      source.reader.take([&](const msg::ParameterList& list) {
        source.newest = list;
        heard = WaitClock::now();
      });
    }
    const auto waited = WaitClock::now() - start;
    const bool all = std::all_of(sources.begin(), sources.end(), [](const auto& s) { return s.newest.has_value(); });
    // A component whose list has no writer after discovery has settled is not part of this run.
    const bool rest = waited > 700ms && std::none_of(sources.begin(), sources.end(),
                                                     [&](const auto& s) { return !s.newest && has_writer(s); });
    if (((all || rest) && WaitClock::now() - heard > kQuiet) || waited > bound) break;
    std::this_thread::sleep_for(kPoll);
  }
  ParameterView view;
  for (const auto& source : sources) {
    const std::string owner(source.topic->writer);
    if (!source.newest && has_writer(source)) view.silent.push_back(owner);
    const auto count = source.newest ? std::min<std::size_t>(source.newest->count, msg::kMaxParameters) : 0;
    for (std::size_t i = 0; i < count; ++i) {
      const auto& parameter = source.newest->parameters[i];
      view.parameters[parameter.name] = {owner, parameter};
    }
  }
  return view;
}

ParameterSetter::ParameterSetter(RequestClient& client)
    : client_(client),
      changes_(dds::Reader<msg::ParameterChange>::member(client.participant(),
                                                         std::string(topics::kParameterChange.name))) {}

msg::ParameterChange ParameterSetter::set(const std::string& name, double value, std::int64_t tick,
                                          std::chrono::milliseconds bound) {
  if (name.size() >= sizeof(msg::Request::parameter))
    throw CommandError("no parameter '" + name + "'", CommandError::Cause::kRefused);
  changes_.take([](const msg::ParameterChange&) {});  // earlier changes do not answer this request
  msg::Request request{};
  request.kind = msg::kRequestParameter;
  request.parameters = no_parameters();
  dds::set_text(request.parameter, name);
  request.parameter_value = value;
  request.effective_tick = tick;
  const std::uint64_t number = client_.ask(request);
  std::optional<msg::ParameterChange> change;
  for (const auto end = WaitClock::now() + bound; WaitClock::now() < end;) {
    const auto answer = client_.wait_for_answer(number, 20ms);
    if (answer == RequestClient::Answer::kRefused) throw CommandError(client_.refusal(), CommandError::Cause::kRefused);
    changes_.take([&](const msg::ParameterChange& each) {
      if (client_.source() == each.source && name == each.name) change = each;
    });
    if (change) return *change;
    if (answer == RequestClient::Answer::kInterrupted)
      throw CommandError("interrupted while waiting for the answer of `input`", CommandError::Cause::kInterrupted);
  }
  throw CommandError(
      "no answer within 5 s; if the run is paused, the change is made when the run resumes (constrictor resume)",
      CommandError::Cause::kNoAnswer);
}

std::optional<double> value_from(const msg::Parameter& parameter, const std::string& text) {
  const auto names = choices_of(parameter);
  if (const auto found = std::find(names.begin(), names.end(), text); found != names.end())
    return static_cast<double>(found - names.begin());
  char* end = nullptr;
  const double value = std::strtod(text.c_str(), &end);
  if (text.empty() || *end != '\0' || !std::isfinite(value)) return std::nullopt;
  return value;
}

std::string value_text(const msg::Parameter& parameter, double value) {
  if (const auto name = name_of(parameter, value)) return *name;
  return *parameter.unit ? fmt::format("{:g} {}", value, parameter.unit) : fmt::format("{:g}", value);
}

std::string accepted_text(const msg::Parameter& parameter) {
  if (const auto names = choices_of(parameter); !names.empty()) return fmt::format("one of {}", fmt::join(names, ", "));
  return fmt::format("{}{:g} to {}", parameter.is_integer ? "whole, " : "", parameter.minimum,
                     value_text(parameter, parameter.maximum));
}

nlohmann::ordered_json to_json(const OwnedParameter& owned) {
  using Json = nlohmann::ordered_json;
  const msg::Parameter& p = owned.parameter;
  const auto number = [&](double value) {
    if (const auto name = name_of(p, value)) return Json(*name);
    return p.is_integer ? Json(static_cast<std::int64_t>(value)) : Json(value);
  };
  return {{"name", std::string(p.name)},
          {"owner", owned.owner},
          {"value", number(p.value)},
          {"default", number(p.default_value)},
          {"unit", std::string(p.unit)},
          {"minimum", number(p.minimum)},
          {"maximum", number(p.maximum)},
          {"whole", p.is_integer},
          {"choices", choices_of(p)},
          {"changed_tick", p.changed_tick < 0 ? Json(nullptr) : Json(p.changed_tick)},
          {"pending",
           p.pending_tick < 0 ? Json(nullptr) : Json{{"tick", p.pending_tick}, {"value", number(p.pending_value)}}},
          {"doc", std::string(p.doc)}};
}

}  // namespace constrictor
