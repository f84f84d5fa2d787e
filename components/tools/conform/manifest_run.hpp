// Checks a part of a manifest: starts a run of this part in which programs of this folder take the places of others.
#pragma once

#include <filesystem>
#include <functional>
#include <string>

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

}  // namespace constrictor::conform
