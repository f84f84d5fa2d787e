// The perception study: which errors are tried, and the results of the evaluations of each error.
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

namespace constrictor::perception_study {

/// One error of perception or of the world that is made stronger from level to level: an entry of factors.yaml.
struct Factor {
  std::string name;  ///< of its folder: small letters, digits and "_"
  std::string title;
  std::string axis;        ///< what the level is, with its unit
  double reference = 0.0;  ///< the level of the runs without errors
  std::vector<double> levels;
  std::vector<std::string> settings;  ///< for `constrictor evaluate --vary`; the first one has a value for each level
};

/// Reads a file of factors. Throws ConfigurationError with file, line, key, what was found and what is accepted.
[[nodiscard]] std::vector<Factor> read_factors(const std::filesystem::path& file);

/// The median of a quantity and the values between which half of the runs lie; NaN if no run has it.
struct Quartiles {
  double low, median, high;
};

/// All runs of one level.
struct LevelResult {
  double level = 0.0;
  bool reference = false;  ///< without the error; these runs are shared by all factors
  std::size_t runs = 0;
  std::size_t successes = 0;
  std::size_t errors = 0;                      ///< runs that ended with an error; they count as not successful
  std::size_t false_successes = 0;             ///< only the robot believed that the mission had succeeded
  double wilson_low = 0.0, wilson_high = 1.0;  ///< 95 % interval of the probability of success
  Quartiles placement_m{};                     ///< of dropped objects from the centre of their zone
  Quartiles time_s{};                          ///< simulated, of successful missions
};

/// The folder of the runs without errors, beside those of the factors.
inline constexpr const char* kReferenceFolder = "reference";

/// The results of one factor in the order of its levels, with the reference at its place among them. `study`: the
/// folder that has `NAME/summary.json` of each evaluation. A level without a run is left out; so is a factor whose
/// evaluation has no run. Throws std::runtime_error if a file is damaged or does not belong to the factor.
[[nodiscard]] std::vector<LevelResult> read_results(const std::filesystem::path& study, const Factor& factor);

/// A row for each level of each factor; RFC 4180.
[[nodiscard]] std::string to_csv(const std::vector<Factor>& factors,
                                 const std::vector<std::vector<LevelResult>>& results);
/// The same as a table in Markdown.
[[nodiscard]] std::string to_markdown(const std::vector<Factor>& factors,
                                      const std::vector<std::vector<LevelResult>>& results);

}  // namespace constrictor::perception_study
