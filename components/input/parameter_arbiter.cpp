#include "input/parameter_arbiter.hpp"

#include <algorithm>

#include "component/parameters.hpp"
#include "configuration/configuration.hpp"
#include "constrictor/text.hpp"

namespace constrictor {
namespace {

// The earliest tick of `parameter_changes`: each component has announced its parameters before it.
constexpr std::int64_t kFirstPlannedTick = 10;
constexpr std::size_t kMostInATick = topics::kParameterChange.max_per_tick;

/// A name as people may read it on a terminal.
std::string readable_name(const std::string& name) {
  const bool readable = std::all_of(name.begin(), name.end(), [](char c) { return c > ' ' && c <= '~'; });
  return readable ? name : "?";
}

}  // namespace

std::vector<PlannedChange> load_planned_changes(const std::filesystem::path& file) {
  std::vector<PlannedChange> changes;
  Configuration root = Configuration::load(file);
  for (auto& entry : root.list("parameter_changes", false)) {
    PlannedChange change;
    change.tick = entry.integer("tick", kFirstPlannedTick, 1'000'000'000);
    change.name = entry.text("name");
    change.value = entry.number("value", {-1e12, 1e12});
    if (change.name.size() >= sizeof(msg::Request::parameter))
      throw entry.error("name", "found '" + change.name + "', accepted the name of a parameter");
    entry.finish();
    changes.push_back(std::move(change));
  }
  root.finish();
  std::stable_sort(changes.begin(), changes.end(), [](const auto& a, const auto& b) { return a.tick < b.tick; });
  for (std::size_t i = kMostInATick; i < changes.size(); ++i) {
    if (changes[i].tick != changes[i - kMostInATick].tick) continue;
    throw root.error("parameter_changes", "found more than " + std::to_string(kMostInATick) + " at tick " +
                                              std::to_string(changes[i].tick) + ", accepted " +
                                              std::to_string(kMostInATick));
  }
  return changes;
}

std::variant<msg::ParameterChange, std::string> ParameterArbiter::decide(
    const msg::Request& request, const std::vector<const msg::ParameterList*>& lists, std::int64_t now) {
  std::erase_if(state_.waiting, [now](std::int64_t tick) { return tick <= now; });
  const std::string name = text_of(request.parameter);
  const msg::Parameter* parameter = nullptr;
  bool all_announced = true;
  for (const msg::ParameterList* list : lists) {
    all_announced = all_announced && list;
    const auto count = list ? std::min<std::size_t>(list->count, msg::kMaxParameters) : 0;
    for (std::size_t i = 0; i < count; ++i) {
      if (name == text_of(list->parameters[i].name)) parameter = &list->parameters[i];
    }
  }
  if (!parameter) {
    return "no component announces a parameter '" + readable_name(name) + "' (constrictor param list)" +
           (all_announced ? "" : "; not every component has announced its own yet");
  }
  if (auto refusal = parameter_refusal(*parameter, request.parameter_value); !refusal.empty()) return refusal;
  const std::int64_t soonest = now + 1;
  if (request.effective_tick != 0 && request.effective_tick < soonest) {
    return "tick of " + name + ": found " + std::to_string(request.effective_tick) + ", accepted " +
           std::to_string(soonest) + " or later (0: as soon as possible)";
  }
  msg::ParameterChange change{};
  change.effective_tick = request.effective_tick == 0 ? soonest : request.effective_tick;
  if (change.effective_tick > soonest) {
    if (state_.waiting.size() >= msg::kMaxParameterChanges) {
      return name + ": " + std::to_string(state_.waiting.size()) + " changes wait for their tick already";
    }
    state_.waiting.push_back(change.effective_tick);
  }
  std::copy_n(request.source, sizeof change.source, change.source);
  std::copy_n(request.parameter, sizeof change.name, change.name);
  change.value = request.parameter_value;
  return change;
}

}  // namespace constrictor
