#include "component/parameters.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <sstream>
#include <stdexcept>

#include "constrictor/text.hpp"

namespace constrictor {
namespace {

/// At most this many changes wait for their tick. `input` lets at most kMaxParameterChanges wait for a later tick;
/// there is room for as many changes that take effect at the next tick.
constexpr std::size_t kMostWaiting = std::size_t{2} * msg::kMaxParameterChanges;

/// `what` the text is, of which parameter: for the message.
template <std::size_t N>
void set_whole_text(char (&field)[N], const std::string& text, const std::string& what) {
  if (text.size() >= N)
    throw std::logic_error(what + ": found " + std::to_string(text.size()) + " characters, accepted at most " +
                           std::to_string(N - 1) + ": " + text);
  set_text(field, text);
}

std::string number(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.6g", value);
  return text;
}

}  // namespace

std::vector<std::string> choices_of(const msg::Parameter& parameter) {
  std::vector<std::string> names;
  std::istringstream words(text_of(parameter.choices));
  for (std::string word; words >> word;) names.push_back(word);
  return names;
}

std::string parameter_refusal(const msg::Parameter& parameter, double value) {
  const bool whole = !parameter.is_integer || value == std::trunc(value);
  if (std::isfinite(value) && whole && value >= parameter.minimum && value <= parameter.maximum) return {};
  if (const auto names = choices_of(parameter); !names.empty()) {
    std::string accepted;
    for (const auto& name : names) accepted += (accepted.empty() ? "" : ", ") + name;
    return text_of(parameter.name) + ": found " + number(value) + ", accepted the number of one of " + accepted +
           " (from 0)";
  }
  const std::string unit = text_of(parameter.unit);
  return text_of(parameter.name) + ": found " + number(value) + ", accepted " +
         (parameter.is_integer ? "whole numbers from " : "") + number(parameter.minimum) + " to " +
         number(parameter.maximum) + (unit.empty() ? "" : " " + unit);
}

Parameters::Parameters(Wiring& wiring, const Topic<msg::ParameterList>& topic)
    : wiring_(wiring),
      owner_(topic.writer),
      changes_(wiring.events(topics::kParameterChange)),
      list_(wiring.output(topic)) {}

Parameters::Parameters(Wiring& wiring, const Topic<msg::ParameterList>& topic, ParameterSet& config)
    : Parameters(wiring, topic) {
  for (const auto& described : config.rows()) {
    if (described.text.changes != Changes::kWhileRunning) continue;
    Row row;
    row.field = config.field(described);
    row.get = described.get;
    row.set = described.set;
    const auto& names = described.text.names;
    row.facts.is_integer = described.text.is_integer || !names.empty();
    std::string choices;
    for (const auto& name : names) choices += (choices.empty() ? "" : " ") + name;
    set_whole_text(row.facts.choices, choices, "parameter " + described.text.key + ", names of its values");
    add(row, described.text.key, described.text.unit, {described.text.bounds.min, described.text.bounds.max},
        described.text.meaning);
  }
}

template <class Number>
void Parameters::add_field(Number& field, std::string_view key, std::string_view unit, ParameterBounds bounds,
                           std::string_view doc) {
  Row row;
  row.field = &field;
  row.get = [](const void* at) { return static_cast<double>(*static_cast<const Number*>(at)); };
  row.set = [](void* at, double value) { *static_cast<Number*>(at) = static_cast<Number>(value); };
  row.facts.is_integer = std::is_integral_v<Number>;
  add(row, key, unit, bounds, doc);
}

void Parameters::add(double& field, std::string_view key, std::string_view unit, ParameterBounds bounds,
                     std::string_view doc) {
  add_field(field, key, unit, bounds, doc);
}

void Parameters::add(int& field, std::string_view key, std::string_view unit, ParameterBounds bounds,
                     std::string_view doc) {
  add_field(field, key, unit, bounds, doc);
}

void Parameters::add(Row row, std::string_view key, std::string_view unit, ParameterBounds bounds,
                     std::string_view doc) {
  const std::string name = owner_ + "." + std::string(key);
  set_whole_text(row.facts.name, name, "name of a parameter");
  set_whole_text(row.facts.unit, std::string(unit), "parameter " + name + ", unit");
  set_whole_text(row.facts.doc, std::string(doc), "parameter " + name + ", meaning");
  row.facts.default_value = row.get(row.field);
  row.facts.minimum = bounds.min;
  row.facts.maximum = bounds.max;
  if (const auto refusal = parameter_refusal(row.facts, row.facts.default_value); !refusal.empty())
    throw std::logic_error(refusal);
  const auto at = std::lower_bound(rows_.begin(), rows_.end(), name,
                                   [](const Row& r, const std::string& n) { return r.facts.name < n; });
  if (at != rows_.end() && name == at->facts.name) throw std::logic_error("parameter " + name + " exists twice");
  if (rows_.size() >= msg::kMaxParameters)
    throw std::logic_error(owner_ + " declares more parameters that may change during a run than the " +
                           std::to_string(msg::kMaxParameters) +
                           " that its list can hold: declare one kAtStart, or raise kMaxParameters in "
                           "idl/constrictor/parameter.idl");
  rows_.insert(at, row);
}

bool Parameters::take_in(const msg::ParameterChange& change, ParameterState& state) {
  const std::string name = text_of(change.name);
  if (name.rfind(owner_ + ".", 0) != 0) return false;
  const auto row = std::find_if(rows_.begin(), rows_.end(), [&](const Row& r) { return name == r.facts.name; });
  const std::string refusal = row == rows_.end() ? "no such parameter" : parameter_refusal(row->facts, change.value);
  if (!refusal.empty() || state.waiting.size() >= kMostWaiting) {
    wiring_.count_refusal("parameter/change: " + (refusal.empty() ? "too many changes wait for their tick" : refusal));
    return false;
  }
  auto& waiting = state.waiting;
  std::erase_if(waiting, [&](const auto& w) { return w.tick == change.effective_tick && w.name == name; });
  const auto at = std::upper_bound(waiting.begin(), waiting.end(), change.effective_tick,
                                   [](std::int64_t tick, const auto& w) { return tick < w.tick; });
  waiting.insert(at, {name, change.value, change.effective_tick});
  return true;
}

bool Parameters::set_fields(const ParameterState& state) {
  bool changed = false;
  for (auto& row : rows_) {
    const auto found = std::find_if(state.in_force.begin(), state.in_force.end(),
                                    [&](const auto& c) { return c.name == row.facts.name; });
    const double value = found == state.in_force.end() ? row.facts.default_value : found->value;
    const double before = row.get(row.field);
    row.set(row.field, value);
    changed = changed || value != before;
  }
  fields_set_ = true;
  return changed;
}

bool Parameters::step(const Tick& tick, ParameterState& state) {
  bool publish = !state.announced;
  for (const auto& change : changes_) publish = take_in(change, state) || publish;
  while (!state.waiting.empty() && state.waiting.front().tick <= tick.index) {
    auto due = state.waiting.front();
    state.waiting.erase(state.waiting.begin());
    due.tick = tick.index;
    std::erase_if(state.in_force, [&](const auto& old) { return old.name == due.name; });
    state.in_force.push_back(std::move(due));
    fields_set_ = false;
    publish = true;
  }
  const bool changed = !fields_set_ && set_fields(state);
  if (publish) {
    state.announced = true;
    list_.write(list(state));
  }
  return changed;
}

msg::ParameterList Parameters::list(const ParameterState& state) const {
  msg::ParameterList list{};
  for (const auto& row : rows_) {
    msg::Parameter& parameter = list.parameters[list.count++];
    parameter = row.facts;
    parameter.value = row.get(row.field);
    const auto of_row = [&](const auto& change) { return change.name == row.facts.name; };
    const auto changed = std::find_if(state.in_force.begin(), state.in_force.end(), of_row);
    parameter.changed_tick = changed == state.in_force.end() ? -1 : changed->tick;
    const auto next = std::find_if(state.waiting.begin(), state.waiting.end(), of_row);
    parameter.pending_value = next == state.waiting.end() ? std::nan("") : next->value;
    parameter.pending_tick = next == state.waiting.end() ? -1 : next->tick;
  }
  return list;
}

}  // namespace constrictor
