// `constrictor status`: the runs of this host, and a live table of one's components.
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <set>
#include <sstream>
#include <thread>

#include "cli/introspection/domain_view.hpp"
#include "cli/run_observer.hpp"
#include "cli/subcommands.hpp"
#include "cli/usage.hpp"
#include "client/run_registry.hpp"
#include "common/operator.hpp"
#include "common/replay_control.hpp"
#include "configuration/counted.hpp"
#include "constrictor/constants.hpp"
#include "constrictor/json.hpp"
#include "runtime/host.hpp"

namespace constrictor::cli {
namespace {

using namespace std::chrono_literals;
using Clock = std::chrono::steady_clock;
using Json = nlohmann::ordered_json;

constexpr auto kStatusPoll = 20ms;
constexpr auto kRateWindow = 3500ms;
constexpr std::size_t kColumns = 80;

struct StatusOptions {
  ViewOptions view;
  bool watch = false;
};

/// Ticks per second of each component, from two of its statuses that arrived while this program ran.
class RateMeter {
 public:
  void add(const RunView& view) {
    const auto now = Clock::now();
    for (const auto& [name, status] : view.components) {
      auto& mark = marks_[name];
      if (status.tick == mark.tick) continue;
      if (mark.tick < 0 || status.tick < mark.tick) {
        mark = {now, status.tick, mark.rate_hz, false};
      } else if (!mark.live) {
        // The first status may be an old one, kept for late readers, so the measurement begins with the second.
        mark = {now, status.tick, mark.rate_hz, true};
      } else if (now - mark.at > 200ms) {
        mark.rate_hz =
            static_cast<double>(status.tick - mark.tick) / std::chrono::duration<double>(now - mark.at).count();
        mark.at = now;
        mark.tick = status.tick;
      }
    }
  }
  /// [Hz] NaN if the rate is not known yet.
  [[nodiscard]] double rate_hz(const std::string& name) const {
    const auto found = marks_.find(name);
    return found == marks_.end() ? std::nan("") : found->second.rate_hz;
  }

 private:
  struct Mark {
    Clock::time_point at{};
    std::int64_t tick = -1;
    double rate_hz = std::nan("");
    bool live = false;  ///< arrived while this program ran
  };
  std::map<std::string, Mark> marks_;
};

/// Wraps text at 80 columns. All lines are indented by `indent`; further lines by at least 2.
std::string wrapped(const std::string& text, std::size_t indent) {
  std::string lines(indent, ' ');
  std::size_t column = indent;
  std::istringstream words(text);
  for (std::string word; words >> word;) {
    const bool first = column == indent;
    if (!first && column + 1 + word.size() > kColumns) {
      lines += "\n" + std::string(std::max<std::size_t>(indent, 2), ' ');
      column = std::max<std::size_t>(indent, 2);
    } else if (!first) {
      lines += ' ';
      ++column;
    }
    lines += word;
    column += word.size();
  }
  return lines;
}

std::string run_line(const RunNote& run, const RunView& view) {
  std::string line = fmt::format("run {}: {}", run.domain, progress_line(view, 0));
  if (view.run_state) {
    const auto& state = *view.run_state;
    if (std::isfinite(state.real_time_factor)) line += fmt::format(", {:.1f}x real time", state.real_time_factor);
    if (state.paused) line += ", paused";
    if (state.realtime) line += ", on the wall clock";
    else if (state.pace > 0)
      line +=
          fmt::format(", at most {:g}x{}", state.pace, state.operator_pace ? " while an operator has authority" : "");
  }
  line = wrapped(line, 0);
  if (view.authority) {
    const auto& authority = *view.authority;
    std::string who = authority_text(authority);
    if (authority.refused_count > 0)
      who += fmt::format("; {} refused, the last one from {}: {}", counted(authority.refused_count, "request"),
                         authority.refused_source, authority.refusal);
    line += "\n" + wrapped(who, 0);
  }
  if (view.mission && *view.mission->reason)
    line += "\n" + wrapped("the mission " + printable(text_of(view.mission->reason)), 0);
  return line;
}

std::string printed(double value, const char* format) {
  return std::isfinite(value) ? fmt::format(fmt::runtime(format), value) : "-";
}

/// A table of 80 columns, or more for names of more than 11 letters. It shows hosts only if the run has several.
std::string table(const RunNote& run, const RunView& view, const RateMeter& rates) {
  constexpr const char* kRow = "{:<{}}{:<8}{:>8}{:>7}{:>8}{:>8}{:>9}{:>8}{:>4}{:>8}\n";
  std::size_t width = 12;
  for (const auto& name : run.roster) width = std::max(width, name.size() + 1);
  std::string text = fmt::format(kRow, "component", width, "state", "tick", "[Hz]", "p50[us]", "p99[us]", "overruns",
                                 "refused", "inc", "pid");
  std::set<std::string> hosts;
  for (const auto& [name, status] : view.components) hosts.insert(status.host);
  for (const auto& name : run.roster) {
    const auto found = view.components.find(name);
    if (found == view.components.end()) {
      text += fmt::format("{:<{}}no status yet\n", name, width);
      continue;
    }
    const auto& status = found->second;
    text += fmt::format(kRow, name, width, name_of(constants::kComponent, status.state), status.tick,
                        printed(rates.rate_hz(name), "{:.1f}"), printed(status.step_time_p50_us, "{:.0f}"),
                        printed(status.step_time_p99_us, "{:.0f}"), view.overruns.at(name), view.refused.at(name),
                        status.incarnation, status.pid);
    if (hosts.size() > 1) text += fmt::format("{:<{}}on {}\n", "", width, status.host);
    if (std::isfinite(status.jitter_p99_us))
      text += wrapped(fmt::format("ticks {:.1f} ms late (99 %), {:.1f} at most; scheduling: {}",
                                  1e-3 * status.jitter_p99_us, 1e-3 * status.jitter_max_us,
                                  printable(text_of(status.scheduling))),
                      12) +
              "\n";
    if (*status.device) text += wrapped(fmt::format("device: {}", printable(text_of(status.device))), 12) + "\n";
    if (*status.last_refusal) text += wrapped(fmt::format("last refusal: {}", status.last_refusal), 12) + "\n";
  }
  return text;
}

Json finite(double value) { return std::isfinite(value) ? Json(value) : Json(nullptr); }

Json json_of(const RunNote& run, const RunView& view, const RateMeter& rates) {
  Json json = {{"run", run.domain},
               {"pid", run.pid},
               {"scenario", run.scenario},
               {"seed", view.seed(run.seed)},
               {"report", run.report_dir.string()},
               {"tick", view.tick},
               {"sim_time_s", view.sim_time_s()}};
  json["real_time_factor"] = view.run_state ? finite(view.run_state->real_time_factor) : Json(nullptr);
  json["paused"] = view.run_state ? Json(view.run_state->paused) : Json(nullptr);
  json["pace"] = view.run_state ? finite(view.run_state->pace) : Json(nullptr);
  json["mission"] = view.mission ? Json(std::string(view.mission->state)) : Json(nullptr);
  json["mission_reason"] = view.mission ? Json(text_of(view.mission->reason)) : Json(nullptr);
  json["task"] = view.task ? Json(name_of(constants::kTask, view.task->task)) : Json(nullptr);
  if (view.authority) {
    json["authority"] = {{"level", words_of(constants::kAuthority, view.authority->level)},
                         {"source", std::string(view.authority->source)},
                         {"refused", view.authority->refused_count},
                         {"refusal", std::string(view.authority->refusal)}};
  }
  auto& list = json["components"] = Json::array();
  for (const auto& name : run.roster) {
    const auto found = view.components.find(name);
    if (found == view.components.end()) {
      list.push_back({{"component", name}, {"state", nullptr}});
      continue;
    }
    const auto& status = found->second;
    list.push_back({{"component", name},
                    {"state", name_of(constants::kComponent, status.state)},
                    {"tick", status.tick},
                    {"rate_hz", finite(rates.rate_hz(name))},
                    {"step_time_p50_us", finite(status.step_time_p50_us)},
                    {"step_time_p99_us", finite(status.step_time_p99_us)},
                    {"overruns", view.overruns.at(name)},
                    {"jitter_p50_us", finite(status.jitter_p50_us)},
                    {"jitter_p99_us", finite(status.jitter_p99_us)},
                    {"jitter_max_us", finite(status.jitter_max_us)},
                    {"scheduling", std::string(status.scheduling)},
                    {"device", std::string(status.device)},
                    {"refused", view.refused.at(name)},
                    {"last_refusal", std::string(status.last_refusal)},
                    {"incarnation", status.incarnation},
                    {"cpu_s", finite(status.cpu_s)},
                    {"version", std::string(status.version)},
                    {"pid", status.pid},
                    {"host", std::string(status.host)}});
  }
  return json;
}

/// True once the launcher has removed its note or died. It shows the end of a run whose plant was killed, because such
/// a plant cannot publish the end.
bool is_gone(const RunNote& run) {
  if (!run.on_this_host) return false;
  const auto runs = live_runs();
  return std::none_of(runs.begin(), runs.end(),
                      [&](const RunNote& other) { return other.domain == run.domain && other.pid == run.pid; });
}

void print_run(const RunNote& run) {
  fmt::print("run {}: {} seed {}, pid {}\n  report in {}\n", run.domain, run.scenario, run.seed, run.pid,
             run.report_dir.string());
}

/// A replay is no run, so that no command chooses it by itself.
void print_replays() {
  for (const auto domain : live_replays()) {
    fmt::print("replay of a recording in DDS domain {0}: `constrictor dashboard --run {0}` shows and seeks it\n",
               domain);
  }
}

int status(const StatusOptions& options) {
  if (!options.view.json && !options.view.domain) print_replays();
  const auto runs = live_runs();
  if (!options.view.json && !options.view.domain && runs.size() > 1) {
    for (const auto& run : runs) print_run(run);
    std::vector<std::string> choices;
    for (const auto& run : runs) choices.push_back(fmt::format("--run {}", run.domain));
    fmt::print("choose one for its components: {}\n", fmt::join(choices, ", "));
    return exit_status::kOk;
  }
  const RunNote run = join_run(options.view.domain);
  if (!options.view.json && run.on_this_host) print_run(run);
  if (!options.view.json && is_replay(options.view.domain))
    fmt::print("run {} is a replay of a recording; `constrictor dashboard` shows and seeks it\n", run.domain);
  RunObserver observer(run.domain);
  RateMeter rates;
  // Statuses are kept for late readers, but a rate needs two of them; the state of the run arrives once a second.
  const auto start = Clock::now();
  auto shown = start;
  const bool screen = options.watch && !options.view.json && ::isatty(STDOUT_FILENO) != 0;
  while (!interrupted()) {
    for (const auto& line : observer.poll()) {
      if (!options.view.json) fmt::print("{}\n", line);
    }
    rates.add(observer.view());
    const auto now = Clock::now();
    const bool complete = observer.view().components.size() >= run.roster.size() && observer.view().run_state &&
                          std::all_of(run.roster.begin(), run.roster.end(),
                                      [&](const auto& name) { return std::isfinite(rates.rate_hz(name)); });
    const bool paused = observer.view().run_state && observer.view().run_state->paused && now - start > 500ms;
    if (!options.watch && (complete || paused || now - start > kRateWindow)) break;
    if (options.watch && now - shown > 1s) {
      shown = now;
      if (options.view.json) fmt::print("{}\n", json_text(json_of(run, observer.view(), rates)));
      else
        fmt::print("{}{}\n\n{}", screen ? "\x1b[H\x1b[J" : "\n", run_line(run, observer.view()),
                   table(run, observer.view(), rates));
      std::fflush(stdout);
      if (observer.view().ended(run.plant) || is_gone(run)) return exit_status::kOk;
    }
    std::this_thread::sleep_for(kStatusPoll);
  }
  if (options.watch) return exit_status::kOk;
  if (options.view.json) fmt::print("{}\n", json_text(json_of(run, observer.view(), rates), 2));
  else fmt::print("{}\n\n{}", run_line(run, observer.view()), table(run, observer.view(), rates));
  return exit_status::kOk;
}

}  // namespace

void add_status(CLI::App& app, Action& action) {
  auto options = std::make_shared<StatusOptions>();
  auto* sub = add_subcommand(app, "status", "show the runs on this host, and the state of the components of one run",
                             action, options, status);
  add_view_options(*sub, options->view);
  sub->add_flag("--watch,-w", options->watch, "update the table every second, until Ctrl-C or the end of the run");
  sub->footer(help_footer(
      "Step times are those since a component's previous status, which it publishes every 50 ticks. Rates are in "
      "ticks\n"
      "per second of wall time. The column inc is the incarnation: 1, and one more after each restart.",
      {"constrictor status", "constrictor status --watch", "constrictor status --json | jq '.components[].rate_hz'"},
      "0 done; 64 wrong usage; 70 no run, or several and none chosen with --json",
      "CONSTRICTOR_DOMAIN  the run, like --run"));
}

}  // namespace constrictor::cli
