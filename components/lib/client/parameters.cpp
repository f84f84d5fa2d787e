#include "client/parameters.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <nlohmann/json.hpp>
#include <optional>

#include "client/polling.hpp"
#include "component/parameters.hpp"
#include "configuration/closest_name.hpp"
#include "constrictor/topics.hpp"
#include "cyclone/discovery.hpp"
#include "cyclone/endpoint.hpp"

namespace constrictor {
namespace {

using namespace std::chrono_literals;
/// After this time all writers of the run are known.
constexpr auto kDiscovery = 700ms;

/// The name of a value; null if the parameter is a number.
std::optional<std::string> name_of(const msg::Parameter& parameter, double value) {
  const auto names = choices_of(parameter);
  if (!(value >= 0.0 && value < static_cast<double>(names.size()))) return std::nullopt;
  return names[static_cast<std::size_t>(value)];
}

}  // namespace

ParameterReader::ParameterReader(std::int32_t participant)
    : changes_(dds::Reader<msg::ParameterChange>::member(participant, std::string(topics::kParameterChange.name))) {
  for (const auto& topic : topics::kInfos) {
    if (topic.type == topics::kNavigationParameters.type) {
      sources_.push_back(
          {&topic, dds::Reader<msg::ParameterList>::member(participant, std::string(topic.name)), std::nullopt});
    }
  }
}

bool ParameterReader::poll() {
  bool any = false;
  for (auto& source : sources_) {
    source.reader.take([&](const msg::ParameterList& list) {
      source.newest = list;
      any = true;
    });
  }
  changes_.take([&](const msg::ParameterChange& change) {
    const std::string name = change.name;
    // Any process can write this topic, so the number of names is limited.
    if (newest_changes_.size() < msg::kMaxParameterChanges || newest_changes_.contains(name))
      newest_changes_.insert_or_assign(name, change);
  });
  return any;
}

std::map<std::string, OwnedParameter> ParameterReader::parameters() const {
  std::map<std::string, OwnedParameter> parameters;
  for (const auto& source : sources_) {
    const auto count = source.newest ? std::min<std::size_t>(source.newest->count, msg::kMaxParameters) : 0;
    for (std::size_t i = 0; i < count; ++i) {
      const auto& parameter = source.newest->parameters[i];
      parameters[parameter.name] = {std::string(source.topic->writer), parameter};
    }
  }
  return parameters;
}

std::vector<std::string> ParameterReader::silent(const std::function<bool(std::string_view)>& has_writer) const {
  std::vector<std::string> silent;
  for (const auto& source : sources_) {
    if (!source.newest && has_writer(source.topic->name)) silent.emplace_back(source.topic->writer);
  }
  return silent;
}

bool ParameterReader::complete() const {
  return std::all_of(sources_.begin(), sources_.end(), [](const auto& source) { return source.newest.has_value(); });
}

bool ParameterReader::up_to_date() const {
  if (WaitClock::now() - start_ < kDiscovery) return false;
  const auto waiting = [](const Source& source) { return !source.newest && source.reader.writers() > 0; };
  if (std::any_of(sources_.begin(), sources_.end(), waiting)) return false;
  return std::all_of(newest_changes_.begin(), newest_changes_.end(), [&](const auto& entry) {
    return std::all_of(sources_.begin(), sources_.end(),
                       [&](const auto& source) { return !source.newest || has_taken(*source.newest, entry.second); });
  });
}

bool has_taken(const msg::ParameterList& list, const msg::ParameterChange& change) {
  const auto* const end = list.parameters + std::min<std::size_t>(list.count, msg::kMaxParameters);
  const auto* const found = std::find_if(list.parameters, end, [&](const msg::Parameter& each) {
    return std::string_view(each.name) == std::string_view(change.name);
  });
  if (found == end) return true;
  if (list.header.epoch != change.header.epoch) return list.header.epoch > change.header.epoch;
  return found->changed_tick >= change.effective_tick ||
         (found->pending_tick >= 0 && found->pending_tick <= change.effective_tick);
}

ParameterView read_parameters(std::int32_t participant, std::chrono::milliseconds bound) {
  ParameterReader reader(participant);
  const dds::Discovery discovery(participant);
  const auto has_writer = [&](std::string_view topic) {
    const auto endpoints = discovery.endpoints();
    return std::any_of(endpoints.begin(), endpoints.end(), [&](const auto& e) { return e.writer && e.topic == topic; });
  };
  const auto discovered_at = WaitClock::now() + kDiscovery;
  // A component whose list has no writer after discovery has settled is not part of this run.
  const auto all = [&] {
    return reader.complete() || (WaitClock::now() > discovered_at && reader.silent(has_writer).empty());
  };
  // Writers keep several lists for late readers. The lists arrive one after the other; the last one is valid.
  wait_until_quiet(
      kQuiet, bound, [&] { return reader.poll(); }, all);
  return {reader.parameters(), reader.silent(has_writer)};
}

std::string did_you_mean(const std::string& name, const std::map<std::string, OwnedParameter>& known) {
  constexpr std::size_t kMost = 6;  // as many motions of control have a method
  if (known.contains(name)) return {};
  const std::string component = name.substr(0, name.find('.') + 1);
  const std::string last_part = name.substr(std::min(name.rfind('.'), name.size()));
  std::vector<std::string> names, slips, same_last_part;
  for (const auto& [each, owned] : known) {
    names.push_back(each);
    if (is_slip_of(name, each)) slips.push_back(each);
    if (!component.empty() && each.starts_with(component) && each.ends_with(last_part)) same_last_part.push_back(each);
  }
  if (!slips.empty()) return did_you_mean(std::string_view(name), slips);
  if (same_last_part.empty()) return did_you_mean(std::string_view(name), names);
  const std::size_t shown = std::min(same_last_part.size(), kMost);
  const std::string more =
      same_last_part.size() > shown ? fmt::format(" or {} more", same_last_part.size() - shown) : "";
  same_last_part.resize(shown);
  return fmt::format(", did you mean {}'{}'{}?", shown > 1 ? "one of " : "", fmt::join(same_last_part, "', '"), more);
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
    if (answer == RequestClient::Answer::kRefused) {
      const std::string reason = client_.refusal();  // reading the parameters takes time
      const auto known = read_parameters(client_.participant()).parameters;
      throw CommandError(reason + did_you_mean(name, known), CommandError::Cause::kRefused);
    }
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

double coming_value(const msg::Parameter& parameter) {
  return parameter.pending_tick < 0 ? parameter.value : parameter.pending_value;
}

std::optional<double> value_from_json(const msg::Parameter& parameter, const nlohmann::json& value) {
  if (value.is_string()) return value_from(parameter, value.get<std::string>());
  if (!value.is_number() || !std::isfinite(value.get<double>())) return std::nullopt;
  return value.get<double>();
}

nlohmann::json value_json(const msg::Parameter& parameter, double value) {
  if (const auto name = name_of(parameter, value)) return *name;
  constexpr double kMostWhole = 9e15;  // every whole number below it has a double of its own
  if (parameter.is_integer && std::abs(value) < kMostWhole) return static_cast<std::int64_t>(value);
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
  const auto number = [&](double value) { return Json(value_json(p, value)); };
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
