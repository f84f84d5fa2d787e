#include "cli/param_command.hpp"

#include <fmt/format.h>

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <variant>

#include "cli/introspection/domain_view.hpp"
#include "cli/operator_client.hpp"
#include "cli/parameter_view.hpp"
#include "constrictor/json.hpp"
#include "runtime/dds/domain.hpp"
#include "runtime/dds/endpoint.hpp"
#include "runtime/host.hpp"
#include "runtime/topics.hpp"

namespace constrictor::cli {
namespace {

using namespace std::chrono_literals;
using Clock = std::chrono::steady_clock;
using Json = nlohmann::ordered_json;
constexpr auto kBound = 5s;

struct Options {
  ViewOptions view;
  bool names = false;
  bool changed = false;
  std::string name;                  ///< of get; of list: what names begin with
  std::vector<std::string> changes;  ///< of set: NAME VALUE NAME VALUE ...
  std::int64_t at_tick = 0;
};

std::string pending_text(const msg::Parameter& p) {
  return p.pending_tick < 0 ? "" : fmt::format("  -> {} at tick {}", value_text(p, p.pending_value), p.pending_tick);
}

void tell_silent(const ParameterView& view) {
  for (const auto& owner : view.silent) std::fprintf(stderr, "param: %s has not told its parameters yet (has the run begun?)\n", owner.c_str());
}

int list(const Options& options) {
  const dds::Domain domain(chosen_domain(options.view));
  const ParameterView view = read_parameters(domain.participant());
  Json json = Json::array();
  bool begins = false;  // any of them with the prefix
  std::size_t shown = 0;
  if (!options.view.json && !options.names) fmt::print("  {:<38} {:>9} {:>9} {:<11} {:<18} {}\n", "name", "value", "default", "unit", "accepted", "what");
  for (const auto& [name, owned] : view.parameters) {
    const msg::Parameter& p = owned.parameter;
    if (name.rfind(options.name, 0) != 0) continue;
    begins = true;
    if (options.changed && p.changed_tick < 0 && p.pending_tick < 0) continue;
    ++shown;
    if (options.view.json) json.push_back(to_json(owned));
    else if (options.names) fmt::print("{}\n", name);
    else
      fmt::print("{} {:<38} {:>9g} {:>9g} {:<11} {:<18} {}{}\n", p.changed_tick < 0 ? ' ' : '*', name, p.value, p.default_value, p.unit,
                 fmt::format("{:g} to {:g}", p.minimum, p.maximum), p.doc, pending_text(p));
  }
  if (options.view.json) fmt::print("{}\n", json_text(json, 2));
  tell_silent(view);
  if (!begins && !view.parameters.empty()) std::fprintf(stderr, "param: no parameter begins with '%s' (constrictor param list)\n", options.name.c_str());
  else if (begins && shown == 0 && !options.view.json) std::fprintf(stderr, "param: none of them was changed\n");
  return begins ? exit_status::kOk : exit_status::kMissionFailed;
}

int get(const Options& options) {
  const dds::Domain domain(chosen_domain(options.view));
  const ParameterView view = read_parameters(domain.participant());
  const auto found = view.parameters.find(options.name);
  if (found == view.parameters.end()) {
    tell_silent(view);
    std::fprintf(stderr, "param: no parameter '%s' (constrictor param list)\n", options.name.c_str());
    return exit_status::kMissionFailed;
  }
  const msg::Parameter& p = found->second.parameter;
  if (options.view.json) {
    fmt::print("{}\n", json_text(to_json(found->second), 2));
    return exit_status::kOk;
  }
  fmt::print("{}: {}{}\n  {}, of {}\n  accepted: {}; default: {}{}\n", p.name, value_text(p, p.value), pending_text(p), p.doc, found->second.owner,
             accepted_text(p), value_text(p, p.default_value), p.changed_tick < 0 ? "" : fmt::format("; changed at tick {}", p.changed_tick));
  return exit_status::kOk;
}

/// What `input` says to one change: the change as it was passed on, or why it was refused; nothing if it said nothing.
using Answer = std::variant<std::monostate, msg::ParameterChange, std::string>;

Answer ask(OperatorClient& client, const dds::Reader<msg::ParameterChange>& changes, const std::string& name, double value, std::int64_t tick) {
  changes.take([](const msg::ParameterChange&) {});  // earlier ones
  msg::Request request{};
  request.kind = msg::kRequestParameter;
  dds::set_text(request.parameter, name);
  request.parameter_value = value;
  request.effective_tick = tick;
  const std::uint64_t number = client.ask(request);
  Answer answer;
  for (const auto end = Clock::now() + kBound; Clock::now() < end && answer.index() == 0;) {
    const auto ruled = client.wait_for_answer(number, 20ms);
    if (ruled == OperatorClient::Answer::kRefused) return client.refusal();
    changes.take([&](const msg::ParameterChange& change) {
      if (client.source() == change.source && name == change.name) answer = change;
    });
  }
  return answer;
}

int set(const Options& options) {
  if (options.changes.size() % 2 != 0) {
    std::fprintf(stderr, "param: %s has no value\n", options.changes.back().c_str());
    return exit_status::kUsage;
  }
  const std::size_t count = options.changes.size() / 2;
  std::vector<double> values;
  for (std::size_t i = 0; i < count; ++i) {
    const std::string& text = options.changes[2 * i + 1];
    char* end = nullptr;
    values.push_back(std::strtod(text.c_str(), &end));
    if (text.empty() || *end != '\0' || !std::isfinite(values.back())) {
      std::fprintf(stderr, "param: VALUE of %s: found '%s', accepted a number\n", options.changes[2 * i].c_str(), text.c_str());
      return exit_status::kUsage;
    }
    if (options.changes[2 * i].size() >= sizeof(msg::Request::parameter)) {
      std::fprintf(stderr, "param: no parameter '%s' (constrictor param list)\n", options.changes[2 * i].c_str());
      return exit_status::kMissionFailed;
    }
  }
  OperatorClient client(chosen_domain(options.view), unique_source("param"), 0ms, /*detached=*/true);
  const auto changes = dds::Reader<msg::ParameterChange>::member(client.participant(), std::string(topics::kParameterChange.name));
  if (!client.connect(kBound)) {
    std::fprintf(stderr, "param: the run has no `input` that listens\n");
    return exit_status::kWaitedTooLong;
  }
  Json json = Json::array();
  int status = exit_status::kOk;
  for (std::size_t i = 0; i < count && status == exit_status::kOk; ++i) {
    const std::string& name = options.changes[2 * i];
    const Answer answer = ask(client, changes, name, values[i], options.at_tick);
    if (const auto* change = std::get_if<msg::ParameterChange>(&answer)) {
      json.push_back({{"name", name}, {"value", change->value}, {"effective_tick", change->effective_tick}, {"accepted_tick", change->header.tick}});
      if (!options.view.json) fmt::print("{}: {:g} from tick {} on\n", name, change->value, change->effective_tick);
    } else if (const auto* refusal = std::get_if<std::string>(&answer)) {
      json.push_back({{"name", name}, {"value", values[i]}, {"refused", *refusal}});
      if (!options.view.json) std::fprintf(stderr, "param: refused: %s\n", refusal->c_str());
      status = exit_status::kMissionFailed;
    } else {
      std::fprintf(stderr, "param: no answer within 5 s; is the run paused? It is told as soon as the run goes on\n");
      client.flush();
      status = exit_status::kWaitedTooLong;
    }
  }
  if (options.view.json) fmt::print("{}\n", json_text(json, 2));
  return status;
}

}  // namespace

void add_param(CLI::App& app, std::function<int()>& action) {
  auto options = std::make_shared<Options>();
  auto* param = app.add_subcommand("param", "look at and change the parameters of a run while it runs");
  param->require_subcommand(1);
  param->footer(
      "A parameter's name is its component's and the keys of its configuration file: navigation.travel.frequency_hz is `travel:\n"
      "frequency_hz:` of navigation.yaml. Components tell which of theirs may change, with unit and bounds.\n\n"
      "A change takes effect at a tick: the next one, or the one that --at-tick names. It is written into the run's report, and a run with\n"
      "the same changes at the same ticks is the same run, bit for bit (to repeat one: `parameter_changes` in a copy of\n"
      "components/input/input.yaml, with `constrictor run --config input=FILE`). A reset brings the defaults back. Setting takes no\n"
      "authority from anybody; while an operator has authority only operators may set, as this command does.\n\n"
      "EXAMPLES\n"
      "  constrictor param list\n"
      "  constrictor param list navigation.follow_line\n"
      "  constrictor param get navigation.travel.frequency_hz\n"
      "  constrictor param set navigation.travel.frequency_hz 0.9\n"
      "  constrictor param set navigation.follow_line.steering.kp 5 navigation.follow_line.steering.ki 0.5 --at-tick 2000\n"
      "  constrictor param list --changed --json\n\n"
      "EXIT STATUS\n"
      "  0 done; 1 refused, or no such parameter; 64 wrong usage; 70 no run, or several and none chosen; 75 nobody answered\n\n"
      "ENVIRONMENT\n  CONSTRICTOR_DOMAIN  the run, like --run");
  const auto add = [&](const char* name, const char* what, int (*run)(const Options&)) {
    auto* sub = param->add_subcommand(name, what);
    add_view_options(*sub, options->view);
    sub->callback([&action, options, run] { action = [options, run] { return run(*options); }; });
    return sub;
  };
  auto* list_app = add("list", "every parameter with value, default, unit, accepted values and meaning; * marks those that were changed", list);
  list_app->add_option("PREFIX", options->name, "only names that begin with this: a component, or component.section");
  list_app->add_flag("--changed", options->changed, "only those that were changed, or will be");
  list_app->add_flag("--names", options->names, "only the names, one a line")->excludes("--json");
  add("get", "one parameter", get)->add_option("NAME", options->name, "the parameter")->required();
  auto* set_app = add("set", "give parameters other values", set);
  set_app->add_option("CHANGES", options->changes, "NAME VALUE, as often as you like; in this order, and none after one that is refused")
      ->required()->expected(2, 64)->option_text("NAME VALUE...");
  set_app->add_option("--at-tick", options->at_tick, "take effect at this tick, which is still to come (default: as soon as possible)")
      ->check(CLI::Range(std::int64_t{1}, std::int64_t{9'000'000'000'000'000}));
}

}  // namespace constrictor::cli
