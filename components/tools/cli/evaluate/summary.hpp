// The results of all runs of an evaluation together.
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "cli/evaluate/mission_result.hpp"
#include "cli/evaluate/statistics.hpp"
#include "cli/evaluate/variation.hpp"
#include "configuration/quantiles.hpp"

namespace constrictor::cli {

/// The values of one figure over the runs in which it is known.
struct Distribution {
  std::vector<double> values;
  [[nodiscard]] double at(double q) const { return interpolated_quantile(values, q); }
};

/// The runs of one variant.
struct VariantSummary {
  std::string name;
  std::size_t runs = 0;
  std::size_t errors = 0;               ///< runs that ended with an error; they count as not successful
  std::size_t refused = 0;              ///< runs that were refused before their start; they do not count as missions
  std::size_t false_successes = 0;      ///< missions that only the robot believed to have succeeded
  std::size_t unnoticed_successes = 0;  ///< missions with all objects in their zones, which the robot did not notice
  std::vector<std::size_t> reached;     ///< runs that reached each of kPhases
  Distribution placement_m;             ///< distance of each dropped object from the centre of its zone
  Distribution mission_time_s;          ///< of successful missions
  Distribution cross_track_m;
  Distribution pose_error_m;
  Distribution cost_of_transport;
  Distribution recoveries;
  Distribution longest_recovery_s;     ///< of each run; 0: it had none
  RecoveryTime worst_recovery;         ///< the longest of all runs
  std::uint64_t worst_seed = 0;        ///< of the run with it
  std::filesystem::path worst_folder;  ///< of the run with it
  std::map<std::string, double> mean_time_in_state_s;
  std::map<std::string, int> recoveries_by_cause;

  [[nodiscard]] std::size_t successes() const { return reached.back(); }
  /// The runs to which numbers of successes relate.
  [[nodiscard]] std::size_t begun() const { return runs - refused; }
};

/// One summary for each variant, also for those without a run.
[[nodiscard]] std::vector<VariantSummary> summarise(const std::vector<Variant>& variants,
                                                    const std::vector<MissionResult>& results);

[[nodiscard]] nlohmann::ordered_json to_json(const std::vector<VariantSummary>& summaries);
/// A row for each run, in the order of `results`; RFC 4180.
[[nodiscard]] std::string to_csv(const std::vector<Variant>& variants, const std::vector<MissionResult>& results);

}  // namespace constrictor::cli
