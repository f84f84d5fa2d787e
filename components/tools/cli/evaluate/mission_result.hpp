// The result of one run of an evaluation, as read from its report directory.
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "cli/evaluate/recoveries.hpp"

namespace constrictor::cli {

struct ObjectResult {
  std::string colour;
  bool grasped = false;
  bool dropped = false;
  bool in_zone = false;
  double zone_distance_m = kUnknown;  ///< from the centre of the object to that of its zone; NaN: it has no zone
};

struct MissionResult {
  std::size_t variant = 0;  ///< index in the evaluation's variants
  std::uint64_t seed = 0;
  std::filesystem::path folder;      ///< relative to that of the evaluation
  std::string command;               ///< repeats the run
  int exit_status = -1;              ///< of `constrictor run`: 0 and 1 are outcomes of the mission, others are errors
  bool incomplete = false;           ///< the files of its result could not be written; `reason` tells why
  bool refused = false;              ///< before its start, because of its files and seed; `reason` tells why
  bool success = false;              ///< by ground truth
  bool believed = false;             ///< the planner ended the mission as succeeded
  bool all_in_zones = false;         ///< all demanded objects lie in their zones, by ground truth
  std::string reason;                ///< why it did not succeed
  double mission_time_s = kUnknown;  ///< until the planner ended the mission, or else until the run ended
  double wall_time_s = kUnknown;
  double rms_cross_track_m = kUnknown;
  double rms_pose_error_m = kUnknown;
  double cost_of_transport = kUnknown;
  int recoveries = 0;
  std::string state_hash;
  std::vector<ObjectResult> objects;
  std::vector<std::string> demanded;               ///< colours of the objects that the mission demands
  std::map<std::string, double> time_in_state_s;   ///< by state of the planner
  std::map<std::string, int> recoveries_by_cause;  ///< their sum is `recoveries`
  RecoveryTime longest_recovery;

  /// The run itself failed, so that nothing is known about the mission. A repetition may succeed, unlike one of a run
  /// that was refused.
  [[nodiscard]] bool error() const { return !refused && (incomplete || (exit_status != 0 && exit_status != 1)); }
  /// All objects are where they belong, and the planner did not end the mission as succeeded.
  [[nodiscard]] bool unnoticed() const { return !error() && !refused && all_in_zones && !believed; }
  /// What `reason` is, for people.
  [[nodiscard]] const char* kind() const { return error() ? "error: " : refused ? "refused: " : "failed: "; }
  /// The run did not fail, but its files could not be written.
  [[nodiscard]] bool unwritten() const { return incomplete && exit_status <= 1; }
};

/// The phases of a mission that are counted, in their order. A phase counts as reached if all objects that the
/// mission demands have reached it: of each colour at least as many as it demands.
inline constexpr const char* kPhases[] = {"objects grasped", "objects dropped", "objects in their zones",
                                          "mission succeeded"};
[[nodiscard]] bool reached(const MissionResult& result, std::size_t phase);

/// The result of a `constrictor run` that wrote into `folder` and ended with `status`. A run without a whole report is
/// incomplete, or refused if it ended with exit_status::kConfiguration and has no report at all. Text and numbers of
/// the report are not trusted: what is missing or of a wrong type stays unknown.
[[nodiscard]] MissionResult read_result(const std::filesystem::path& folder, int status,
                                        const SearchLimits& limits = {});

}  // namespace constrictor::cli
