// An evaluation: many runs, several at a time, in one folder that can be continued.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "cli/evaluate/mission_result.hpp"
#include "cli/evaluate/variation.hpp"
#include "cli/launch_plan.hpp"

namespace constrictor::cli {

/// The runs of an evaluation.
struct EvaluationRequest {
  RunOptions run;  ///< the options of every run but its seed, its report directory and what is varied
  std::vector<std::uint64_t> seeds;
  std::vector<std::string> vary;  ///< as on the command line
  std::size_t jobs = 1;           ///< runs at a time
  std::size_t shard = 1;          ///< this call does the runs shard, shard + shards, ...; counted from 1
  std::size_t shards = 1;
  std::string keep = "failed";  ///< of which runs figure, journals and logs stay: "all", "failed" or "none"
  std::filesystem::path folder;
};

/// One run that belongs to the evaluation.
struct PlannedRun {
  std::size_t variant = 0;
  std::uint64_t seed = 0;
  std::filesystem::path folder;  ///< relative to that of the evaluation
};

class Evaluation {
 public:
  using Print = std::function<void(const std::string& line)>;

  /// Makes the folder and the files of the variants, and checks all files. An evaluation that is already in the folder
  /// is continued if it has the same files and options; the seeds may differ. Throws UsageError or ConfigurationError;
  /// a folder that was empty is empty again then.
  explicit Evaluation(EvaluationRequest request);

  /// All runs, in the order in which they are done: all variants of a seed, then those of the next seed.
  [[nodiscard]] const std::vector<PlannedRun>& runs() const { return runs_; }
  [[nodiscard]] const std::vector<Variant>& variants() const { return variants_; }
  [[nodiscard]] const std::filesystem::path& folder() const { return request_.folder; }
  [[nodiscard]] const std::string& scenario() const { return scenario_; }

  /// Does the runs of this shard that have no result yet, and repeats runs whose result is an error, but not those that
  /// were refused: a repetition would be refused, too. After a failed run the others go on, also after one whose files
  /// cannot be written: it is an error, and it leaves only its run.log. Calls `show` with a line for each run that
  /// ended, and `progress` with the state of the whole. Returns 0, or the number of the signal that interrupted it: the
  /// runs that had not ended are then stopped, and the next call does them again.
  int carry_out(const Print& show, const Print& progress);
  /// The results of runs(), in their order: those that the folder has, and an error for each run whose
  /// files could not be written.
  [[nodiscard]] std::vector<MissionResult> results() const;

 private:
  struct Job;
  /// Returns true if the folder holds a part of this evaluation already.
  bool claim_folder();
  void start(const PlannedRun& run, std::vector<Job>& jobs);
  /// Notes that the files of a run cannot be written, and removes those that it has.
  MissionResult lose(const PlannedRun& run, const std::string& why);
  /// Notes the end of a run and removes what is not to be kept of it.
  MissionResult finish(const Job& job, int status);
  [[nodiscard]] std::vector<std::string> arguments(const PlannedRun& run) const;
  [[nodiscard]] std::optional<MissionResult> result_of(const PlannedRun& run) const;
  /// Adds what is known of a run before it begins.
  [[nodiscard]] MissionResult completed(MissionResult result, const PlannedRun& run) const;

  EvaluationRequest request_;
  std::vector<Variant> variants_;
  std::vector<RunOptions> options_;   ///< of each variant
  std::vector<SearchLimits> limits_;  ///< of each variant
  std::vector<PlannedRun> runs_;
  std::map<std::filesystem::path, MissionResult> lost_;  ///< runs whose files could not be written, by their folder
  std::string scenario_;
  int lock_ = -1;

 public:
  ~Evaluation();
  Evaluation(const Evaluation&) = delete;
  Evaluation& operator=(const Evaluation&) = delete;
};

}  // namespace constrictor::cli
