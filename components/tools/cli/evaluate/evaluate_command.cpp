// `constrictor evaluate`: runs many missions, and writes their results together.
#include <fmt/chrono.h>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <sysexits.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <charconv>
#include <ctime>
#include <memory>
#include <set>
#include <system_error>
#include <thread>
#include <utility>

#include "cli/evaluate/evaluation.hpp"
#include "cli/evaluate/evaluation_record.hpp"
#include "cli/evaluate/merge.hpp"
#include "cli/evaluate/page.hpp"
#include "cli/evaluate/result_table.hpp"
#include "cli/evaluate/summary.hpp"
#include "cli/run_command.hpp"
#include "cli/subcommands.hpp"
#include "cli/usage.hpp"
#include "common/progress_display.hpp"
#include "common/screen_size.hpp"
#include "configuration/counted.hpp"
#include "configuration/whole_file.hpp"
#include "runtime/host.hpp"
#include "runtime/version.hpp"

namespace constrictor::cli {
namespace {

namespace fs = std::filesystem;

struct EvaluateOptions {
  EvaluationRequest request;
  std::string seeds;  ///< empty: 1..10, or those of the merged evaluations
  std::string shard = "1/1";
  std::vector<fs::path> merge;
};

/// "3/16": the third of sixteen parts.
void parse_shard(const std::string& text, EvaluationRequest& request) {
  const char* end = text.data() + text.size();
  const auto [slash, error] = std::from_chars(text.data(), end, request.shard);
  bool good = error == std::errc() && slash != end && *slash == '/';
  if (good) {
    const auto [rest, wrong] = std::from_chars(slash + 1, end, request.shards);
    good = wrong == std::errc() && rest == end && request.shard >= 1 && request.shard <= request.shards;
  }
  if (!good) throw UsageError(fmt::format("--shard: found '{}', accepted K/N with K from 1 to N, such as 3/16", text));
}

constexpr const char* kFolders = "evaluations";  // of evaluations without --output

fs::path new_folder(const RunOptions& options) {
  const std::string scenario = make_launch_plan(options).manifest.scenario_file.stem().string();
  const std::time_t now = std::time(nullptr);
  return make_new_directory(fs::path(kFolders) / fmt::format("{:%Y%m%d-%H%M%S}_{}", fmt::localtime(now), scenario));
}

/// Writes the files that can be written, and prints the table. Returns why the other files could not be written.
std::vector<std::string> write_summary(const Evaluation& evaluation, const EvaluationRequest& request) {
  PageContent page;
  page.scenario = evaluation.scenario();
  page.about = fmt::format("Constrictor {}, {}, robot {}, manifest {}", kVersion, counted(request.seeds.size(), "seed"),
                           request.run.robot.empty() ? "of the manifest" : request.run.robot, request.run.manifest);
  page.planned = evaluation.runs().size();
  page.variants = evaluation.variants();
  page.results = evaluation.results();
  const auto summaries = summarise(page.variants, page.results);
  nlohmann::ordered_json json{{"scenario", page.scenario},
                              {"version", kVersion},
                              {"planned_runs", page.planned},
                              {"variants", to_json(summaries)}};
  std::vector<std::string> unwritten;
  // The smallest file first: the disk may be nearly full.
  const std::vector<std::pair<const char*, std::string>> files{{"summary.json", json.dump(2) + "\n"},
                                                               {"runs.csv", to_csv(page.variants, page.results)},
                                                               {"index.html", make_page(page)}};
  for (const auto& [name, content] : files) {
    try {
      write_whole(evaluation.folder() / name, content);
    } catch (const std::system_error& error) {
      unwritten.push_back(error.what());
    }
  }
  fmt::print("\n{}", to_table(summaries, screen_size().columns));
  return unwritten;
}

/// Says which results are missing, and what to do. Returns false if there are any.
bool report_unwritten(const std::string& folder, const std::vector<std::string>& unwritten,
                      const std::vector<MissionResult>& results) {
  constexpr std::size_t kNamed = 5;
  for (std::size_t i = 0; i < std::min(kNamed, unwritten.size()); ++i) fmt::print(stderr, "{}\n", unwritten[i]);
  if (unwritten.size() > kNamed) fmt::print(stderr, "{} more\n", unwritten.size() - kNamed);
  const auto lost = static_cast<std::size_t>(
      std::count_if(results.begin(), results.end(), [](const MissionResult& result) { return result.unwritten(); }));
  if (lost > 0) fmt::print(stderr, "the results of {} are lost\n", counted(lost, "run"));
  if (unwritten.empty() && lost == 0) return true;
  fmt::print(stderr,
             "results are missing: check the free space and the rights of {}, then the same command with --output {} "
             "does what is missing\n",
             folder, folder);
  return false;
}

/// Begins the evaluation. The folders that were made for it do not stay if it is refused.
std::unique_ptr<Evaluation> begin(EvaluationRequest& request) {
  const bool own_folder = request.folder.empty();
  const bool first = own_folder && !fs::exists(kFolders);
  if (own_folder) request.folder = new_folder(request.run);
  try {
    return std::make_unique<Evaluation>(request);
  } catch (...) {
    std::error_code ignored;
    if (own_folder) fs::remove(request.folder, ignored);
    if (first) fs::remove(kFolders, ignored);
    throw;
  }
}

/// Names the runs that no merged folder has. Returns false if there are any.
bool report_missing(const Evaluation& evaluation, const std::vector<MissionResult>& results) {
  std::set<fs::path> found;
  for (const auto& result : results) found.insert(result.folder);
  std::vector<std::string> missing;
  for (const auto& run : evaluation.runs())
    if (!found.contains(run.folder)) missing.push_back(run.folder.string());
  if (missing.empty()) return true;
  constexpr std::size_t kNamed = 5;
  const std::size_t named = std::min(kNamed, missing.size());
  fmt::print(stderr, "{} of {} are in none of these folders: {}{}; the same command without --merge does them\n",
             missing.size(), counted(evaluation.runs().size(), "run"),
             fmt::join(missing.begin(), missing.begin() + static_cast<std::ptrdiff_t>(named), ", "),
             missing.size() > named ? ", ..." : "");
  return false;
}

/// Names the runs that were refused before their start. Returns true if there are any.
bool report_refused(const std::vector<MissionResult>& results) {
  const auto is_refused = [](const MissionResult& result) { return result.refused; };
  const auto refused = static_cast<std::size_t>(std::count_if(results.begin(), results.end(), is_refused));
  if (refused == 0) return false;
  const MissionResult& first = *std::find_if(results.begin(), results.end(), is_refused);
  fmt::print(
      stderr,
      "{} of {} refused, because the scene that its seed draws is not accepted, and does not count as a mission; "
      "no repetition changes that: change the ranges of the scenario, or leave out the seeds. The first one, "
      "{}: {}\n",
      refused, counted(results.size(), "run"), first.folder.string(), first.reason);
  return true;
}

int evaluate(const EvaluateOptions& given) {
  EvaluationRequest request = given.request;
  if (!given.merge.empty() && request.folder.empty()) throw UsageError("--merge: --output FOLDER is missing");
  if (!given.seeds.empty()) request.seeds = parse_seeds(given.seeds);
  else request.seeds = given.merge.empty() ? parse_seeds("1..10") : seeds_of(given.merge);
  parse_shard(given.shard, request);
  if (request.jobs == 0) request.jobs = std::max(1u, std::thread::hardware_concurrency());
  std::unique_ptr<Evaluation> begun;
  try {
    begun = begin(request);
  } catch (const std::system_error& error) {
    fmt::print(stderr, "constrictor: the evaluation cannot begin: {}\n", error.what());
    return EX_IOERR;
  }
  Evaluation& evaluation = *begun;
  std::vector<std::string> unwritten;
  if (!given.merge.empty()) unwritten = merge_evaluations(given.merge, request);
  const std::string folder = evaluation.folder().string();
  int signal = 0;
  if (given.merge.empty()) {
    fmt::print("evaluation of {}: {}, {} at a time, in {}\n", evaluation.scenario(),
               counted((evaluation.runs().size() + request.shards - request.shard) / request.shards, "run"),
               request.jobs, folder);
    ProgressDisplay display;
    signal = evaluation.carry_out([&](const std::string& line) { display.print(line); },
                                  [&](const std::string& line) { display.show_status(line); });
  }
  const auto files = write_summary(evaluation, request);
  if (files.empty()) fmt::print("{}/index.html, runs.csv, summary.json\n", folder);
  unwritten.insert(unwritten.end(), files.begin(), files.end());
  const auto results = evaluation.results();
  const bool complete = report_unwritten(folder, unwritten, results);
  if (signal != 0) {
    fmt::print("interrupted; the same command with --output {} goes on\n", folder);
    return 128 + signal;
  }
  if (!complete) return EX_IOERR;
  if (!given.merge.empty() && !report_missing(evaluation, results)) return exit_status::kFailed;
  const auto errors = static_cast<std::size_t>(
      std::count_if(results.begin(), results.end(), [](const MissionResult& result) { return result.error(); }));
  if (errors > 0) {
    fmt::print(stderr,
               "{} ended with an error, see run.log in the folder of each; the same command with --output {} does "
               "them again\n",
               counted(errors, "run"), folder);
  }
  const bool refused = report_refused(results);
  return errors > 0 ? exit_status::kSoftware : refused ? exit_status::kConfiguration : exit_status::kOk;
}

void add_evaluation_options(CLI::App& app, EvaluateOptions& options) {
  RunOptions& run = options.request.run;
  app.add_option("SCENARIO", run.scenario,
                 "a name (see `constrictor list scenarios`) or a file (default: the manifest's)");
  app.add_option("--seeds", options.seeds, "seeds of the runs: 1..40, or 1,5,9..12 (default: 1..10)")
      ->check([](const std::string& text) {
        return text.empty() ? "found nothing, accepted seeds and ranges such as 1..40 or 1,5,9..12" : std::string();
      });
  app.add_option("--vary", options.request.vary,
                 "[FILE:]KEY=VALUE[,VALUE...]: do all runs with each of these values. KEY names a value of the\n"
                 "scenario, or of FILE: robot, or a component, such as navigation; may be repeated (all combinations)")
      ->allow_extra_args(false);
  app.add_option("--jobs", options.request.jobs, "runs at a time (default: as many as there are processor cores)")
      ->check(whole_number(1, 90));
  app.add_option("--output", options.request.folder,
                 "folder of the evaluation (default: a new one below evaluations/); one that exists is continued");
  app.add_option("--shard", options.shard, "K/N: do only the K-th of N parts of the runs, for several machines")
      ->capture_default_str();
  app.add_option("--merge", options.merge,
                 "do no runs: gather those of these folders, which hold parts of this evaluation, in --output")
      ->check(existing_folder());
  app.add_option("--keep", options.request.keep, "of which runs figure, journals and logs are kept")
      ->capture_default_str()
      ->check(one_of({"all", "failed", "none"}));
  app.add_option("--manifest", run.manifest, "launch manifest: a name (see `constrictor list manifests`) or a file")
      ->capture_default_str();
  app.add_option("--robot", run.robot, "robot: a name (see `constrictor list robots`) or a file");
  app.add_option("--config", run.config_files,
                 "NAME=FILE: configuration file of a component, instead of its default; may be repeated")
      ->allow_extra_args(false);
  app.add_option("--faults", run.faults_file, "file of faults (YAML) to inject into every run");
  app.add_option("--max-sim-time", run.max_sim_time_s,
                 "[s] end each run at this simulated time (default, or 0: no limit but the report component's)")
      ->check(number(0.0, 1e6, "s"));
}

}  // namespace

void add_evaluate(CLI::App& app, Action& action) {
  auto options = std::make_shared<EvaluateOptions>();
  options->request.jobs = 0;
  auto* sub = add_subcommand(app, "evaluate", "run a scenario with many seeds and values, and plot the results", action,
                             options, evaluate);
  add_evaluation_options(*sub, *options);
  sub->footer(help_footer(
      "Each run is a `constrictor run --in-process` of its own; if one fails, the others go on. The folder then "
      "contains\n"
      "index.html (success by phase with 95 % intervals, placement, errors, times, recoveries, and the command that\n"
      "repeats each run), runs.csv, summary.json, and report.json of each run.\n"
      "Ctrl-C stops the runs and shows those that are done. The same command with --output continues: also after a\n"
      "crash, and with other seeds. It refuses to mix results of different files, options or programs.",
      {"constrictor evaluate --seeds 1..40", "constrictor evaluate short --seeds 1..20 --jobs 2 --output /tmp/short",
       "constrictor evaluate short --seeds 1..10 --vary noise.camera_sd=0,0.02,0.05",
       "constrictor evaluate short --seeds 1..100 --shard 1/2 --output part1",
       "constrictor evaluate short --seeds 1..100 --merge part1 part2 --output all"},
      "0 all runs are done, whether or not their missions succeeded; 1 the folders of --merge lack runs;\n"
      "  64 wrong usage; 70 a run ended with an error; 74 results could not be written; 78 wrong configuration, or a\n"
      "  run was refused, because the scene that its seed draws is not accepted; 130 Ctrl-C, 143 SIGTERM",
      kDataEnvironment));
}

}  // namespace constrictor::cli
