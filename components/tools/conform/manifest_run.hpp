// Checks a part of a manifest, or one that a user starts by hand: starts a run of this part in which programs of this
// folder take the places of others.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "conform/part_stand.hpp"

namespace constrictor::conform {

/// The manifest of a run of the plant of `manifest`, with its robot, its scenario and its programs `beside` the run.
/// conform_control takes the place of control; of the other members only `input` takes part. Throws ConfigurationError.
[[nodiscard]] std::string plant_manifest(const std::filesystem::path& manifest, const std::filesystem::path& folder);

/// The manifest of a run of this part of `manifest`; conform_part takes the places of the members around it. Throws
/// ConfigurationError.
[[nodiscard]] std::string part_manifest(const PartPlace& place, const std::filesystem::path& manifest,
                                        const std::filesystem::path& folder);

/// Starts the run in `folder`, which must contain profile.yaml, and calls `print` with each line of the results. The
/// run is ended when the checks have ended, or when `interrupted()` is true: real joints hold, then relax, as after
/// every end of a run. Returns false if there is no result: `log` in the folder says why.
bool run_manifest(const std::string& manifest, const std::filesystem::path& folder,
                  const std::function<bool()>& interrupted, const std::function<void(const std::string&)>& print);

/// A part that a user starts by hand, on the DDS of any vendor.
struct ServedPart {
  const PartPlace& place;
  std::uint32_t domain = 0;
  std::filesystem::path robot, scenario;
  double patience_s = 60.0;  ///< time in which the part must join
};
/// The arguments with which a component of this project joins the run as this part. Another program must have the same
/// domain, plant, roster, robot and scenario.
[[nodiscard]] std::vector<std::string> joining_arguments(const ServedPart& part);

/// Starts conform_part, and nothing else, as the members around the part. Otherwise as run_manifest(): false if the
/// part has not joined. Throws ConfigurationError if the scenario is wrong.
bool serve_part(const ServedPart& part, const std::filesystem::path& folder, const std::function<bool()>& interrupted,
                const std::function<void(const std::string&)>& print);

}  // namespace constrictor::conform
