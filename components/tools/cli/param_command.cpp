// `constrictor param`: lists, prints, changes, keeps and loads the parameters of a run while it runs.
#include <fmt/format.h>

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <set>

#include "cli/introspection/domain_view.hpp"
#include "cli/param_file.hpp"
#include "cli/subcommands.hpp"
#include "cli/usage.hpp"
#include "client/parameters.hpp"
#include "client/run_registry.hpp"
#include "common/interrupt.hpp"
#include "common/operator.hpp"
#include "component/parameters.hpp"
#include "configuration/closest_name.hpp"
#include "configuration/configuration.hpp"
#include "configuration/whole_file.hpp"
#include "constrictor/json.hpp"
#include "constrictor/topics.hpp"
#include "cyclone/domain.hpp"
#include "runtime/host.hpp"

namespace constrictor::cli {
namespace {

using namespace std::chrono_literals;
using Json = nlohmann::ordered_json;

struct ParamOptions {
  ViewOptions view;
  bool names = false;
  bool changed = false;
  std::string name;                  ///< get: the parameter's name; list: prefix of the names to print
  std::vector<std::string> changes;  ///< set: NAME VALUE NAME VALUE ...
  std::int64_t at_tick = 0;
  std::string file;    ///< dump, load
  bool force = false;  ///< dump: replace the file
};

std::string pending_text(const msg::Parameter& p) {
  return p.pending_tick < 0 ? "" : fmt::format("  -> {} at tick {}", value_text(p, p.pending_value), p.pending_tick);
}

/// A value without its unit, which has a column of its own.
std::string cell(const msg::Parameter& p, double value) {
  return *p.choices ? value_text(p, value) : fmt::format("{:g}", value);
}

std::string accepted_cell(const msg::Parameter& p) {
  return *p.choices ? fmt::format("one of {} names", choices_of(p).size())
                    : fmt::format("{:g} to {:g}", p.minimum, p.maximum);
}

void report_silent(const ParameterView& view) {
  for (const auto& owner : view.silent) {
    std::fprintf(stderr,
                 "param: %s has not published its parameters yet (has the run begun? see `constrictor status`)\n",
                 owner.c_str());
  }
}

/// The names of the parameters, and those of their components and sections.
std::vector<std::string> prefixes_of(const ParameterView& view) {
  std::set<std::string> prefixes;
  for (const auto& [name, owned] : view.parameters) {
    for (std::size_t dot = name.find('.'); dot != std::string::npos; dot = name.find('.', dot + 1))
      prefixes.insert(name.substr(0, dot));
    prefixes.insert(name);
  }
  return {prefixes.begin(), prefixes.end()};
}

int list_parameters(const ParamOptions& options) {
  const dds::Domain domain(join_run(options.view.domain).domain);
  const ParameterView view = read_parameters(domain.participant());
  Json json = Json::array();
  bool begins = false;  // whether any name begins with the prefix
  std::size_t shown = 0;
  std::size_t width = 0;
  std::size_t value_width = 9;
  for (const auto& [name, owned] : view.parameters) {
    width = std::max(width, name.size());
    for (const double value : {owned.parameter.value, owned.parameter.default_value})
      value_width = std::max(value_width, cell(owned.parameter, value).size());
  }
  for (const auto& [name, owned] : view.parameters) {
    const msg::Parameter& p = owned.parameter;
    if (name.rfind(options.name, 0) != 0) continue;
    begins = true;
    if (options.changed && p.changed_tick < 0 && p.pending_tick < 0) continue;
    if (shown++ == 0 && !options.view.json && !options.names)
      fmt::print("  {:<{}} {:>{}} {:>{}} {:<11} {:<18} {}\n", "name", width, "value", value_width, "default",
                 value_width, "unit", "accepted", "meaning");
    if (options.view.json) json.push_back(to_json(owned));
    else if (options.names) fmt::print("{}\n", name);
    else
      fmt::print("{} {:<{}} {:>{}} {:>{}} {:<11} {:<18} {}{}\n", p.changed_tick < 0 ? ' ' : '*', name, width,
                 cell(p, p.value), value_width, cell(p, p.default_value), value_width, p.unit, accepted_cell(p), p.doc,
                 pending_text(p));
  }
  if (options.view.json) fmt::print("{}\n", json_text(json, 2));
  report_silent(view);
  if (!begins && !view.parameters.empty())
    fmt::print(stderr, "param: no parameter begins with '{}'{} (`constrictor param list` lists all)\n", options.name,
               did_you_mean(options.name, prefixes_of(view)));
  else if (begins && shown == 0 && !options.view.json)
    std::fprintf(stderr, "param: none of these parameters was changed\n");
  return begins ? exit_status::kOk : exit_status::kFailed;
}

/// Thrown when nothing was done and the reason is in the message: exit status 1.
class Refused : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// With --json, a script reads from standard output why nothing was done, in the form of a refusal of `param set`.
void print_nothing_done(const std::string& name, const ParamOptions& options, const std::string& why) {
  if (!options.view.json) return;
  Json refusal;
  if (name == "get") refusal["name"] = options.name;
  refusal["refused"] = why;
  fmt::print("{}\n", json_text(name == "get" ? refusal : Json::array({refusal}), 2));
}

/// Runs `param NAME`. With --json, it also prints the reason of an exception as JSON, for example of wrong usage or
/// of a missing run.
int with_json(const std::string& name, const ParamOptions& options, int (*run)(const ParamOptions&)) {
  try {
    return run(options);
  } catch (const Refused& error) {
    print_nothing_done(name, options, error.what());
    if (!options.view.json) fmt::print(stderr, "param: {}\n", error.what());
    return exit_status::kFailed;
  } catch (const std::exception& error) {
    print_nothing_done(name, options, error.what());
    throw;  // main() prints it, and knows the exit status
  }
}

/// What to do about a name that no component announces; empty for one that is announced.
std::string advice_for_unknown(const std::string& name, const ParameterView& view) {
  if (view.parameters.empty() || view.parameters.contains(name)) return {};
  return is_in_configuration(name) ? fmt::format("; it {}", why_fixed(name)) : did_you_mean(name, view.parameters);
}

Refused no_such_parameter(const std::string& name, const ParameterView& view) {
  if (is_in_configuration(name)) return Refused(fmt::format("{} {}", name, why_fixed(name)));
  return Refused(fmt::format("no parameter '{}'{} (`constrictor param list` lists all)", name,
                             did_you_mean(name, view.parameters)));
}

int get_parameter(const ParamOptions& options) {
  const dds::Domain domain(join_run(options.view.domain).domain);
  const ParameterView view = read_parameters(domain.participant());
  const auto found = view.parameters.find(options.name);
  if (found == view.parameters.end()) {
    report_silent(view);
    throw no_such_parameter(options.name, view);
  }
  const msg::Parameter& p = found->second.parameter;
  if (options.view.json) {
    fmt::print("{}\n", json_text(to_json(found->second), 2));
    return exit_status::kOk;
  }
  fmt::print("{}: {}{}\n  {}, of {}\n  accepted: {}; default: {}{}\n", p.name, value_text(p, p.value), pending_text(p),
             p.doc, found->second.owner, accepted_text(p), value_text(p, p.default_value),
             p.changed_tick < 0 ? "" : fmt::format("; changed at tick {}", p.changed_tick));
  return exit_status::kOk;
}

/// Sets the parameters one after the other, until one is refused.
int set_all(const ParamOptions& options, std::uint32_t domain, const std::vector<ParameterValue>& values) {
  const std::size_t count = values.size();
  RequestClient client(domain, operator_options(unique_source("param"), 0ms, /*detached=*/true));
  ParameterSetter setter(client);
  std::string reason;
  if (const int failed = connect(client, "param", &reason); failed != exit_status::kOk) {
    print_nothing_done("set", options, reason);
    return failed;
  }
  Json json = Json::array();
  int status = exit_status::kOk;
  for (std::size_t i = 0; i < count && status == exit_status::kOk; ++i) {
    const auto& [name, value, text] = values[i];
    try {
      const msg::ParameterChange change = setter.set(name, value, options.at_tick);
      json.push_back({{"name", name},
                      {"value", change.value},
                      {"effective_tick", change.effective_tick},
                      {"accepted_tick", change.header.tick}});
      if (!options.view.json) fmt::print("run {}: {}: {} from tick {} on\n", domain, name, text, change.effective_tick);
    } catch (const CommandError& error) {
      status = error.cause() == CommandError::Cause::kRefused       ? exit_status::kFailed
               : error.cause() == CommandError::Cause::kInterrupted ? interrupt_status()
                                                                    : exit_status::kWaitedTooLong;
      const bool refused = error.cause() == CommandError::Cause::kRefused;
      std::string why = error.what();
      if (refused) why += advice_for_unknown(name, read_parameters(client.participant()));
      // A request without an answer is not refused: a run that is paused may still obey it.
      json.push_back({{"name", name}, {"value", value}, {refused ? "refused" : "no_answer", why}});
      if (!refused || !options.view.json)
        std::fprintf(stderr, "param: %s%s\n", refused ? "refused: " : "", why.c_str());
      if (!refused) {
        client.flush();
        std::fprintf(stderr, "  %zu of %zu parameters were set; authority has not changed\n", i, count);
      }
    }
  }
  if (options.view.json) fmt::print("{}\n", json_text(json, 2));
  return status;
}

int set_parameter(const ParamOptions& options) {
  if (options.changes.size() % 2 != 0) throw UsageError(options.changes.back() + " has no value");
  // Only a value that is not a number needs the parameters' names of values.
  std::vector<ParameterValue> values;
  std::optional<std::uint32_t> domain;
  std::optional<ParameterView> view;
  const auto joined = [&] {
    if (!domain) domain = join_run(options.view.domain).domain;
    return *domain;
  };
  for (std::size_t i = 0; i < options.changes.size() / 2; ++i) {
    const std::string& name = options.changes[2 * i];
    const std::string& text = options.changes[2 * i + 1];
    std::optional<double> value = value_from({}, text);
    if (!value) {
      // Without a run there are no names, and the value is as wrong as any other text.
      const bool no_run = !options.view.domain && live_runs().empty();
      if (!view) view = no_run ? ParameterView{} : read_parameters(dds::Domain(joined()).participant());
      const auto found = view->parameters.find(name);
      if (found == view->parameters.end() && !view->parameters.empty() && view->silent.empty())
        throw no_such_parameter(name, *view);
      const msg::Parameter known = found == view->parameters.end() ? msg::Parameter{} : found->second.parameter;
      value = value_from(known, text);
      if (!value)
        throw UsageError(fmt::format("VALUE of {}: found '{}', accepted {}{}", name, text,
                                     *known.choices ? accepted_text(known) : "a number",
                                     did_you_mean(text, choices_of(known))));
    }
    values.push_back({name, *value, text});
  }
  return set_all(options, joined(), values);
}

int dump(const ParamOptions& options) {
  if (!options.force && options.file != "-" && std::filesystem::exists(options.file))
    throw UsageError(fmt::format("FILE: found {}, which exists, accepted a new file (or --force)", options.file));
  const RunNote run = join_run(options.view.domain);
  const dds::Domain domain(run.domain);
  const ParameterView view = read_parameters(domain.participant());
  report_silent(view);
  if (view.parameters.empty() || !view.silent.empty()) {
    std::fprintf(stderr, "param: not every component has announced its parameters; no file was written\n");
    return exit_status::kFailed;
  }
  const std::string title =
      fmt::format("Parameters of run {}{}{}", run.domain, run.scenario.empty() ? "" : ", ", run.scenario);
  const std::string text = parameter_file(view, title, options.changed);
  if (options.file == "-") fmt::print("{}", text);
  else write_whole(options.file, text);
  return exit_status::kOk;
}

int load(const ParamOptions& options) {
  std::ifstream stream(options.file, std::ios::binary);
  const std::string text{std::istreambuf_iterator<char>(stream), {}};
  if (!stream.is_open() || stream.bad())
    throw ConfigurationError(fmt::format("{}: cannot be read: {}", options.file, ::strerrordesc_np(errno)));
  std::vector<ParameterValue> values;
  const std::uint32_t number = join_run(options.view.domain).domain;
  {
    const dds::Domain domain(number);
    const ParameterView view = read_parameters(domain.participant());
    report_silent(view);
    values = read_parameter_file(text, options.file, view, is_in_configuration);
  }
  if (!values.empty()) return set_all(options, number, values);
  if (options.view.json) fmt::print("[]\n");
  else fmt::print("every parameter of the file has its value already\n");
  return exit_status::kOk;
}

}  // namespace

void add_param(CLI::App& app, Action& action) {
  auto options = std::make_shared<ParamOptions>();
  auto* param = add_group(app, "param", "list and change the parameters of a run while it runs");
  param->footer(help_footer(
      "A parameter's name is that of its component and the keys in its configuration file:\n"
      "navigation.travel.speed_m_s is `travel: speed_m_s:` in navigation.yaml. Each component announces which of its\n"
      "parameters may change, with unit and bounds.\n\n"
      "A change takes effect at a tick: the next one, or the one that --at-tick names. The run's report records it.\n"
      "A run with the same changes at the same ticks has the same result, bit for bit (to repeat one:\n"
      "`parameter_changes` in a copy of components/input/input.yaml, with `constrictor run --config input=FILE`).\n"
      "A reset restores the defaults. Setting a parameter takes no authority. While an operator has authority, only\n"
      "operators may set parameters; this command does so as an operator.",
      {"constrictor param list", "constrictor param list navigation.follow_line",
       "constrictor param get navigation.travel.speed_m_s", "constrictor param set navigation.travel.speed_m_s 0.9",
       "constrictor param set control.motion.travel.method sidewinding",
       "constrictor param set navigation.travel.speed_m_s 0.9 navigation.follow_line.steering.kp 5 --at-tick 2000",
       "constrictor param list --changed --json", "constrictor param dump tuned.yaml --changed",
       "constrictor param load tuned.yaml"},
      "0 done; 1 refused, or no such parameter; 64 wrong usage; 70 no run, or several and none chosen; 75 no answer;\n"
      "  78 the file of `load` is wrong: nothing was set; 130 interrupted by Ctrl-C",
      "CONSTRICTOR_DOMAIN  the run, like --run"));
  const auto add = [&](const char* name, const char* what, int (*run)(const ParamOptions&)) {
    const auto with = [name, run](const ParamOptions& chosen) { return with_json(name, chosen, run); };
    auto* sub = add_subcommand(*param, name, what, action, options, with);
    add_view_options(*sub, options->view);
    return sub;
  };
  auto* list_app =
      add("list", "list the parameters with value, default, unit, accepted values and meaning; * marks changed ones",
          list_parameters);
  list_app->add_option("PREFIX", options->name,
                       "only names that begin with this text: a component, or component.section");
  list_app->add_flag("--changed", options->changed, "only parameters that were changed, or will be");
  list_app->add_flag("--names", options->names, "only the names, one in each line")->excludes("--json");
  add("get", "print one parameter", get_parameter)->add_option("NAME", options->name, "the parameter")->required();
  auto* dump_app =
      add_subcommand(*param, "dump", "write the values in force into a file for `param load`", action, options, dump);
  add_run_option(*dump_app, options->view.domain);
  dump_app->add_option("FILE", options->file, "YAML file; - is the standard output")->required();
  dump_app->add_flag("--changed", options->changed, "only parameters that were changed, or will be");
  dump_app->add_flag("--force", options->force, "replace FILE if it exists");
  auto* load_app = add("load", "check a whole file, then set the parameters that it names", load);
  add_token_option(*load_app);
  load_app
      ->add_option(
          "FILE", options->file,
          "YAML file of `param dump`, or with keys as in the components' configuration files below the name of "
          "the component; any number of parameters")
      ->required();
  auto* set_app = add("set", "change parameters", set_parameter);
  add_token_option(*set_app);
  set_app
      ->add_option("CHANGES", options->changes,
                   "NAME VALUE, as often as needed; a value is a number or one of the names that `get` shows. They are "
                   "set in this order; the first refusal ends the command")
      ->required()
      ->expected(2, 64)
      ->option_text("NAME VALUE...");
  for (auto* sub : {set_app, load_app}) {
    sub->add_option("--at-tick", options->at_tick,
                    "tick at which the changes take effect; it must be in the future (default: the next tick)")
        ->check(whole_number(1, 9'000'000'000'000'000));
  }
}

}  // namespace constrictor::cli
