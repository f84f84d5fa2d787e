#include "cli/evaluate/evaluation.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <csignal>
#include <fstream>
#include <memory>
#include <nlohmann/json.hpp>
#include <set>
#include <system_error>

#include "cli/child_process.hpp"
#include "cli/evaluate/evaluation_record.hpp"
#include "cli/evaluate/search_limits.hpp"
#include "cli/run_record.hpp"
#include "cli/signal_queue.hpp"
#include "cli/usage.hpp"
#include "configuration/configuration.hpp"
#include "configuration/counted.hpp"
#include "configuration/whole_file.hpp"
#include "runtime/host.hpp"

namespace constrictor::cli {
namespace {

namespace fs = std::filesystem;
using namespace std::chrono_literals;
using Clock = std::chrono::steady_clock;

constexpr const char* kOutcome = "outcome.json";  // its presence shows that the run is over
constexpr auto kEndGrace = 10s;                   // for a run that is interrupted

fs::path folder_of(const Variant& variant, std::uint64_t seed) {
  return fs::path("runs") / variant.folder / fmt::format("seed_{:04}", seed);
}

/// Removes what is in the folder but the files of these names. What cannot be removed stays.
void remove_content(const fs::path& folder, const std::set<std::string>& kept = {}) {
  std::error_code ignored;
  std::vector<fs::path> content;
  for (fs::directory_iterator entry(folder, ignored), end; entry != end; entry.increment(ignored)) {
    if (!kept.contains(entry->path().filename().string())) content.push_back(entry->path());
  }
  for (const auto& path : content) fs::remove_all(path, ignored);
}

std::string quoted(const std::string& word) {
  const auto plain = [](unsigned char c) {
    return std::isalnum(c) != 0 || std::string_view("./_=-+:,").find(static_cast<char>(c)) != std::string_view::npos;
  };
  return !word.empty() && std::all_of(word.begin(), word.end(), plain) ? word : "'" + word + "'";
}

/// Throws ConfigurationError if a component refuses a file of this variant. A scene that only one seed draws is left to
/// its run: it is enough that one of the first seeds is accepted.
void check_variant(const Variant& variant, RunOptions options, const std::vector<std::uint64_t>& seeds) {
  constexpr std::size_t kTried = 20;
  std::string first, last;
  for (std::size_t i = 0; i < std::min(kTried, seeds.size()); ++i) {
    options.seed = seeds[i];
    try {
      show_warnings(check_components(options, make_launch_plan(options)));
      return;
    } catch (const ConfigurationError& error) {
      if (last == error.what()) break;  // the seed does not matter
      last = error.what();
      if (first.empty()) first = last;
    }
  }
  throw ConfigurationError(variant.settings.empty() ? first : fmt::format("--vary {}: {}", variant.name, first));
}

std::string duration_text(double seconds) {
  if (seconds < 90) return fmt::format("{:.0f} s", seconds);
  if (seconds < 5400) return fmt::format("{:.0f} min", seconds / 60);
  return fmt::format("{:.1f} h", seconds / 3600);
}

}  // namespace

struct Evaluation::Job {
  PlannedRun run;
  std::unique_ptr<ChildProcess> child;
  Clock::time_point start;
  bool over = false;
};

Evaluation::Evaluation(EvaluationRequest request) : request_(std::move(request)) {
  const LaunchPlan plan = make_launch_plan(request_.run);
  scenario_ = plan.manifest.scenario_file.stem().string();
  std::vector<Variation> variations;
  for (const auto& text : request_.vary) variations.push_back(parse_variation(text));
  variants_ = make_variants(variations);
  request_.run = absolute_options(request_.run, plan);
  request_.folder = fs::absolute(request_.folder);
  const bool begun_before = claim_folder();
  try {
    for (const auto& variant : variants_) {
      options_.push_back(options_of(variant, request_.run, request_.folder / "variants" / variant.folder));
      check_variant(variant, options_.back(), request_.seeds);
      limits_.push_back(search_limits_of(options_.back()));
    }
  } catch (const ConfigurationError&) {
    // A refused evaluation leaves its folder empty, so that the corrected command may use it.
    if (!begun_before) remove_content(request_.folder);
    throw;
  }
  for (const auto seed : request_.seeds) {
    for (std::size_t i = 0; i < variants_.size(); ++i) runs_.push_back({i, seed, folder_of(variants_[i], seed)});
  }
}

Evaluation::~Evaluation() {
  if (lock_ >= 0) ::close(lock_);
}

bool Evaluation::claim_folder() {
  EvaluationRecord wanted{scenario_, request_.vary, request_.seeds, identities_of(request_.run)};
  std::error_code error;
  fs::create_directories(request_.folder, error);
  if (error || !fs::is_directory(request_.folder)) {
    throw UsageError(fmt::format("--output: {} cannot become a folder: {}", request_.folder.string(),
                                 error ? error.message() : "it is a file"));
  }
  const auto found = read_record(request_.folder);
  if (!found && !fs::is_empty(request_.folder))
    throw UsageError(fmt::format("--output: {} is not empty and holds no evaluation", request_.folder.string()));
  if (found) {
    const std::string why = difference(*found, wanted);
    if (!why.empty()) {
      throw UsageError(fmt::format("--output: {} holds another evaluation: {}; choose another folder",
                                   request_.folder.string(), why));
    }
    for (const auto seed : found->seeds) {
      if (std::find(wanted.seeds.begin(), wanted.seeds.end(), seed) == wanted.seeds.end()) wanted.seeds.push_back(seed);
    }
    std::sort(wanted.seeds.begin(), wanted.seeds.end());
  }
  // A folder whose disk is full can be continued with the same seeds.
  if (!found || found->seeds != wanted.seeds) write_record(request_.folder, wanted);
  const fs::path lock = request_.folder / fmt::format(".shard-{}-of-{}", request_.shard, request_.shards);
  lock_ = ::open(lock.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0644);
  if (lock_ < 0) throw std::system_error(errno, std::generic_category(), lock.string());
  if (::flock(lock_, LOCK_EX | LOCK_NB) != 0) {
    throw UsageError(fmt::format("--output: another `constrictor evaluate` is doing shard {} of {} in {}",
                                 request_.shard, request_.shards, request_.folder.string()));
  }
  return found.has_value();
}

std::vector<std::string> Evaluation::arguments(const PlannedRun& run) const {
  const RunOptions& options = options_[run.variant];
  std::vector<std::string> words{"run",        options.scenario, "--seed",      std::to_string(run.seed),
                                 "--manifest", options.manifest, "--in-process"};
  if (!options.robot.empty()) words.insert(words.end(), {"--robot", options.robot});
  for (const auto& file : options.config_files) words.insert(words.end(), {"--config", file});
  if (!options.faults_file.empty()) words.insert(words.end(), {"--faults", options.faults_file.string()});
  if (options.max_sim_time_s > 0)
    words.insert(words.end(), {"--max-sim-time", fmt::format("{}", options.max_sim_time_s)});
  return words;
}

void Evaluation::start(const PlannedRun& run, std::vector<Job>& jobs) {
  const fs::path folder = request_.folder / run.folder;
  fs::remove_all(folder);  // of a run that was interrupted, or ended with an error
  fs::create_directories(folder);
  std::vector<std::string> words = arguments(run);
  words.insert(words.begin(), (program_folder() / "constrictor").string());
  words.insert(words.end(), {"--no-checkpoints", "--report", folder.string()});
  jobs.push_back({run, std::make_unique<ChildProcess>(words, run_environment(), folder / "run.log"), Clock::now()});
}

MissionResult Evaluation::lose(const PlannedRun& run, const std::string& why) {
  // The run will be done again. Until then its files must not take the space that the other runs need.
  remove_content(request_.folder / run.folder, {"run.log"});
  MissionResult result;
  result.incomplete = true;
  result.reason = why;
  return lost_[run.folder] = completed(std::move(result), run);
}

MissionResult Evaluation::finish(const Job& job, int status) {
  const fs::path folder = request_.folder / job.run.folder;
  const nlohmann::json outcome = {{"exit_status", status},
                                  {"wall_time_s", std::chrono::duration<double>(Clock::now() - job.start).count()}};
  try {
    write_whole(folder / kOutcome, outcome.dump(1) + "\n");
  } catch (const std::system_error& error) {
    return lose(job.run, error.what());
  }
  const auto result = result_of(job.run);
  if (!result) return lose(job.run, fmt::format("cannot read {}", (folder / kOutcome).string()));
  const bool kept = request_.keep == "all" || (request_.keep == "failed" && !result->success);
  // Files that only people read go, and those of an incomplete run, for which there was no space; the results stay.
  if (!kept || result->incomplete) remove_content(folder, {"report.json", kOutcome, "run.log"});
  return *result;
}

std::optional<MissionResult> Evaluation::result_of(const PlannedRun& run) const {
  std::ifstream stream(request_.folder / run.folder / kOutcome);
  if (!stream) return {};
  const auto outcome = nlohmann::json::parse(stream, nullptr, false);
  if (!outcome.is_object() || !outcome.contains("exit_status") || !outcome["exit_status"].is_number_integer())
    return {};
  return completed(read_result(request_.folder / run.folder, outcome["exit_status"].get<int>(), limits_[run.variant]),
                   run);
}

MissionResult Evaluation::completed(MissionResult result, const PlannedRun& run) const {
  result.variant = run.variant;
  result.seed = run.seed;
  result.folder = run.folder;
  result.command = "constrictor";
  for (const auto& word : arguments(run)) result.command += " " + quoted(word);
  return result;
}

std::vector<MissionResult> Evaluation::results() const {
  std::vector<MissionResult> results;
  for (const auto& run : runs_) {
    if (const auto lost = lost_.find(run.folder); lost != lost_.end()) results.push_back(lost->second);
    else if (auto result = result_of(run)) results.push_back(std::move(*result));
  }
  return results;
}

int Evaluation::carry_out(const Print& show, const Print& progress) {
  std::vector<PlannedRun> due;
  std::size_t done = 0, succeeded = 0;
  for (std::size_t i = request_.shard - 1; i < runs_.size(); i += request_.shards) {
    const auto result = result_of(runs_[i]);
    if (!result || result->error()) {
      due.push_back(runs_[i]);
      continue;
    }
    ++done;
    succeeded += result->success ? 1 : 0;
  }
  if (done > 0) show(fmt::format("{} done before, {} left", counted(done, "run"), due.size()));
  const std::size_t before = done, all = done + due.size();
  const SignalQueue signals;
  const auto begin = Clock::now();
  std::vector<Job> jobs;
  std::size_t next = 0;
  const auto over = [&](const PlannedRun& run, const MissionResult& result) {
    ++done;
    succeeded += result.success ? 1 : 0;
    const std::string& variant = variants_[run.variant].name;
    show(fmt::format(
        "seed {}{}: {}", run.seed, variants_.size() > 1 ? " with " + variant : "",
        result.success ? fmt::format("succeeded in {:.1f} s", result.mission_time_s) : result.kind() + result.reason));
  };
  while (next < due.size() || !jobs.empty()) {
    while (jobs.size() < request_.jobs && next < due.size()) {
      const PlannedRun& run = due[next++];
      try {
        start(run, jobs);
      } catch (const std::system_error& error) {
        over(run, lose(run, fmt::format("the run was not started: {}", error.what())));
      }
    }
    const int signal = signals.wait(500ms);
    if (signal != 0) {
      for (auto& job : jobs) job.child->signal(SIGTERM);
      const auto end = Clock::now() + kEndGrace;
      for (auto& job : jobs) {
        while (!job.child->poll() && Clock::now() < end) static_cast<void>(signals.wait(50ms));
      }
      return signal;  // the children that still run are killed
    }
    for (auto& job : jobs) {
      const auto& exit = job.child->poll();
      if (!exit) continue;
      job.over = true;
      const int status = exit->code().value_or(128 + WTERMSIG(exit->wait_status));
      over(job.run, finish(job, status));
    }
    std::erase_if(jobs, [](const Job& job) { return job.over; });
    const double passed_s = std::chrono::duration<double>(Clock::now() - begin).count();
    std::string line = fmt::format("{} of {} runs done, {} succeeded", done, all, succeeded);
    if (done > before) {
      const double each_s = passed_s / static_cast<double>(done - before);
      line += fmt::format(", about {} left", duration_text(each_s * static_cast<double>(all - done)));
    }
    progress(line);
  }
  return 0;
}

}  // namespace constrictor::cli
