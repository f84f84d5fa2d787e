// `constrictor log`: what the processes of a run have to say, while it goes on or from the files of its report.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <map>
#include <optional>
#include <set>
#include <thread>

#include "cli/introspection/domain_view.hpp"
#include "cli/log/log_files.hpp"
#include "cli/log/log_lines.hpp"
#include "cli/subcommands.hpp"
#include "cli/usage.hpp"
#include "client/log_reader.hpp"
#include "client/run_monitor.hpp"
#include "client/run_registry.hpp"
#include "common/interrupt.hpp"
#include "configuration/closest_name.hpp"
#include "constrictor/constants.hpp"
#include "constrictor/json.hpp"
#include "cyclone/domain.hpp"
#include "cyclone/own_host.hpp"
#include "runtime/host.hpp"

namespace constrictor::cli {
namespace {

using namespace std::chrono_literals;
using Clock = std::chrono::steady_clock;

constexpr auto kLogPoll = 20ms;
constexpr auto kQuiet = 200ms;  // lines that were written before arrive with smaller gaps
constexpr auto kBound = 3s;     // for lines that were written before

struct LogOptions {
  ViewOptions view;
  LogFilter filter;
  std::string folder;
  std::string level = "info";
  std::uint64_t last = 0;
  bool follow = false;
};

class Printer {
 public:
  explicit Printer(const LogOptions& options) : json_(options.view.json) {}
  void print(const LogEntry& entry) const {
    if (json_) fmt::print("{}\n", json_text(to_json(entry)));
    else fmt::print("{}\n", text_of(entry, own_host_));
  }
  void print_last(const std::vector<LogEntry>& entries, std::uint64_t last) const {
    const std::size_t skipped = last > 0 && entries.size() > last ? entries.size() - last : 0;
    for (std::size_t i = skipped; i < entries.size(); ++i) print(entries[i]);
    std::fflush(stdout);
  }

 private:
  bool json_;
  std::string own_host_ = own_host();
};

/// Throws UsageError if a component of the filter has no line at all in `all`, and is none of the `others`.
void refuse_unknown_components(const LogOptions& options, const std::vector<LogEntry>& all,
                               const std::vector<std::string>& others = {}) {
  for (const std::string& name : options.filter.components) {
    LogFilter only;
    only.components = {name};
    if (std::find(others.begin(), others.end(), name) != others.end()) continue;
    if (std::any_of(all.begin(), all.end(), [&](const LogEntry& entry) { return only.accepts(entry); })) continue;
    std::set<std::string> known(others.begin(), others.end());
    for (const LogEntry& entry : all) known.insert(entry.record.subject);
    known.erase("");
    const std::vector<std::string> names(known.begin(), known.end());
    throw UsageError(
        fmt::format("--component: found '{}', accepted {}{}", name, fmt::join(names, ", "), did_you_mean(name, names)));
  }
}

int of_files(const LogOptions& options) {
  if (options.follow)
    throw UsageError(
        fmt::format("--follow: found together with the folder '{}', accepted for a run that goes on; "
                    "leave the folder out",
                    options.folder));
  const auto entries = read_logs(options.folder, options.filter);
  if (entries.empty() && !options.filter.components.empty())
    refuse_unknown_components(options, read_logs(options.folder, {}));
  Printer(options).print_last(entries, options.last);
  return exit_status::kOk;
}

/// The lines of a run that goes on, from the topic `log`.
class LiveLog {
 public:
  explicit LiveLog(const LogOptions& options)
      : options_(options),
        run_(join_run(options.view.domain)),
        domain_(run_.domain),
        monitor_(run_, domain_.participant()),
        reader_(domain_.participant()),
        printer_(options) {}

  int show() {
    catch_interrupts({SIGINT, SIGTERM, SIGHUP});
    const auto begin = Clock::now();
    for (auto changed = begin; interrupt_signal() == 0; std::this_thread::sleep_for(kLogPoll)) {
      if (take() > 0) changed = Clock::now();
      const bool complete = reader_.heard_all() && Clock::now() - changed > kQuiet;
      if (complete || Clock::now() - begin > kBound || !over().empty()) break;
    }
    std::stable_sort(waiting_.begin(), waiting_.end(),
                     [](const auto& a, const auto& b) { return a.record.time < b.record.time; });
    if (interrupt_signal() == 0) refuse_unknown();
    printer_.print_last(waiting_, options_.last);
    waiting_.clear();
    if (options_.follow) follow();
    report_lost();
    return interrupt_signal() != 0 && !options_.follow ? interrupt_status() : exit_status::kOk;
  }

 private:
  /// A component may be silent, or its lines be older than those that its process keeps: the members of the run and the
  /// files of its report name it.
  void refuse_unknown() const {
    if (!waiting_.empty() || options_.filter.components.empty()) return;
    std::vector<std::string> others = run_.roster;
    others.emplace_back("launcher");
    std::vector<LogEntry> all;
    for (const std::string& subject : subjects_) all.emplace_back().record.subject = subject;
    if (run_.on_this_host && !log_files(run_.report_dir / "logs").empty()) {
      const auto kept = read_logs(run_.report_dir, {});
      all.insert(all.end(), kept.begin(), kept.end());
    }
    refuse_unknown_components(options_, all, others);
  }
  [[nodiscard]] const std::string& over() const { return monitor_.attachment().over(); }

  /// Prints lines until the run is over and no line has arrived for kQuiet: the last lines of the processes may arrive
  /// after the end was reported, in particular if this process was stopped meanwhile.
  void follow() {
    std::optional<Clock::time_point> known;  // since when the end is known
    for (auto changed = Clock::now(); interrupt_signal() == 0; std::this_thread::sleep_for(kLogPoll)) {
      const auto now = Clock::now();
      if (take() > 0) changed = now;
      printer_.print_last(waiting_, 0);
      waiting_.clear();
      if (known && ((now - *known > kQuiet && now - changed > kQuiet) || now - *known > kBound)) {
        std::fprintf(stderr, "log: %s\n", over().c_str());
        return;
      }
      if (!known && !over().empty()) known = now;
    }
  }
  std::size_t take() {
    monitor_.poll();
    std::size_t taken = 0;
    reader_.take([&](const msg::LogLine& line, std::uint64_t lost) {
      ++taken;
      const auto& state = monitor_.state();
      if (state && line.run_id != 0 && line.run_id != state->run_id) return;
      if (lost > 0) lost_[constrictor::text_of(line.process)] += lost;
      LogEntry entry = entry_of(line);
      subjects_.insert(entry.record.subject);
      if (options_.filter.accepts(entry)) waiting_.push_back(std::move(entry));
    });
    return taken;
  }
  void report_lost() const {
    for (const auto& [process, count] : lost_) {
      std::fprintf(stderr,
                   "log: %llu lines of %s did not arrive here, because it wrote faster than it may publish; its "
                   "log file has them\n",
                   static_cast<unsigned long long>(count), process.c_str());
    }
  }

  const LogOptions& options_;
  RunNote run_;
  dds::Domain domain_;
  RunMonitor monitor_;
  LogReader reader_;
  Printer printer_;
  std::vector<LogEntry> waiting_;
  std::set<std::string> subjects_;             ///< of all lines, also of those that the filter does not accept
  std::map<std::string, std::uint64_t> lost_;  ///< number of lines, by process
};

int log(const LogOptions& given) {
  LogOptions options = given;
  options.filter.least_level = *value_of(constants::kLog, options.level);
  if (!options.folder.empty()) return of_files(options);
  return LiveLog(options).show();
}

}  // namespace

void add_log(CLI::App& app, Action& action) {
  auto options = std::make_shared<LogOptions>();
  std::vector<std::string> levels = names_of(constants::kLog);
  levels.emplace_back("warn");  // short for "warning"
  auto* sub = add_subcommand(app, "log", "print the log lines of all processes of a run, in the order of their time",
                             action, options, log);
  sub->add_option("FOLDER", options->folder,
                  "report folder of a run, also of one that has ended (default: the run that goes on, over DDS)")
      ->check(existing_folder());
  sub->add_flag("--follow,-f", options->follow, "print new lines until Ctrl-C or the end of the run");
  sub->add_option("--level", options->level, "only lines of this level and of those above it: info, warning, error")
      ->check(one_of(levels))
      ->transform(CLI::Transformer(std::map<std::string, std::string>{{"warn", "warning"}}))
      ->capture_default_str();
  sub->add_option("--component", options->filter.components,
                  "only lines of this component, or of the process that contains it; `launcher` has those of "
                  "`constrictor run`; may be repeated")
      ->expected(1)
      ->take_all();
  sub->add_option("--since", options->filter.since_tick, "only lines of this tick and of later ones")
      ->check(whole_number(0, 9'000'000'000'000'000));
  sub->add_option("--grep", options->filter.text, "only lines whose message contains this text");
  sub->add_option("--last", options->last, "only the last lines, this many, of those that were written before")
      ->check(whole_number(1, 1'000'000'000));
  add_view_options(*sub, options->view);
  sub->footer(help_footer(
      "A run that goes on: each process keeps its newest 256 lines for readers that come later. The files of the "
      "report "
      "have\nmore: every line, also what libraries write, up to 16 MiB for each process; then the oldest lines are "
      "dropped, and the\nlog says so. Lines of processes on other hosts name the host.\n\n"
      "--json prints one object for each line: wall_time_ns (since 1970, UTC), level, component, process, host, pid, "
      "incarnation,\nepoch, tick, number (of the line in its process), foreign (not written by our log), message; null "
      "is unknown.",
      {"constrictor log", "constrictor log --follow --level warning",
       "constrictor log --component physics --since 1000",
       "constrictor log runs/20261122-101530_case_study_seed1 --grep refused",
       "constrictor log --json | jq -r .message"},
      fmt::format("0 done; {}; 130 interrupted before the first line", kRunStatuses)));
}

}  // namespace constrictor::cli
