// Checks the plant of a manifest: starts a run of this plant, of `input`, and of conform_control in place of `control`.
#pragma once

#include <filesystem>
#include <functional>
#include <string>

namespace constrictor::conform {

/// The manifest of such a run: plant, robot, scenario and companions of `manifest`. Throws ConfigurationError.
[[nodiscard]] std::string conform_manifest(const std::filesystem::path& manifest, const std::filesystem::path& folder);

/// Starts the run in `folder`, which must contain profile.yaml, and calls `print` with each line of the results. The
/// run is ended when the checks have ended, or when `interrupted()` is true: its joints hold, then relax, as after
/// every end of a run. Returns false if there is no result: `log` in the folder says why.
bool run_manifest(const std::filesystem::path& manifest, const std::filesystem::path& folder,
                  const std::function<bool()>& interrupted, const std::function<void(const std::string&)>& print);

}  // namespace constrictor::conform
