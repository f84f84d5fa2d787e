// The quantities that an evaluation varies: values of the scenario, of the robot, and of the components'
// configurations.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "cli/launch_plan.hpp"

namespace constrictor::cli {

/// "1..40", "7", "1,5,9..12": the seeds in the order of the text, each once. Throws UsageError.
[[nodiscard]] std::vector<std::uint64_t> parse_seeds(const std::string& text);

/// One value in a YAML file.
struct Setting {
  std::string file;   ///< "scenario", "robot" or the name of a component
  std::string key;    ///< "noise.camera_sd", "objects.0.mass_kg"
  std::string value;  ///< YAML
};

/// The values of --vary [FILE:]KEY=VALUE[,VALUE...]. If FILE is left out, KEY is a key of the scenario. A value in
/// brackets may contain commas.
struct Variation {
  std::string file;
  std::string key;
  std::vector<std::string> values;
  /// The name as on the command line, without the values.
  [[nodiscard]] std::string name() const { return file == "scenario" ? key : file + ":" + key; }
};

/// Throws UsageError, also if a value is there twice.
[[nodiscard]] Variation parse_variation(const std::string& text);

/// One combination of the varied values.
struct Variant {
  std::string folder;  ///< name of its folder: letters, digits and "._=-"; "as_given" without settings
  std::string name;    ///< "noise.camera_sd=0.02"
  std::vector<Setting> settings;
};

/// All combinations of the values, the last variation changing fastest; one variant without settings if nothing is
/// varied. Throws UsageError if a variation overwrites an earlier one, because it has the same key or one above it.
[[nodiscard]] std::vector<Variant> make_variants(const std::vector<Variation>& variations);

/// The configuration file that a component of this run reads: the given one, or its default; empty if it has none.
[[nodiscard]] std::filesystem::path config_file_of(const std::string& component, const LaunchPlan& plan);

/// The options of a run of this variant: those of `base`, with copies of the files that the variant changes, which are
/// written into `folder`. Throws ConfigurationError if a file cannot be varied, or if the key cannot exist in it;
/// whether the component accepts the value is checked by check_components().
[[nodiscard]] RunOptions options_of(const Variant& variant, const RunOptions& base,
                                    const std::filesystem::path& folder);

}  // namespace constrictor::cli
