// A launch manifest of deploy/: which processes make up a run, and which components each of them hosts.
#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <vector>

namespace constrictor::cli {

/// One process of a run.
struct ProcessPlan {
  std::vector<std::string> components;   ///< hosted by it, at least one
  std::string program;                   ///< empty: the component's own, or constrictor_host for several
  int restarts = 100;                    ///< how often it may be restarted after it died; the plant's never is
  std::vector<std::string> environment;  ///< "NAME=VALUE", added to the launcher's

  /// "control", or "navigation+control" if it hosts several.
  [[nodiscard]] std::string name() const;
};

struct LaunchManifest {
  std::string plant;                     ///< the component that is the time master
  std::filesystem::path robot_file;
  std::filesystem::path scenario_file;
  double patience_s = 60.0;              ///< [s] wall time a process waits for a peer before it gives up
  std::vector<ProcessPlan> processes;
  std::map<std::string, std::filesystem::path> config_files;  ///< by component; absent: its default

  /// Every component, in the order of the file.
  [[nodiscard]] std::vector<std::string> roster() const;
};

/// Reads a manifest; paths in it are relative to the project's root. Throws ConfigurationError: also if a component is
/// named twice or the plant is not among them.
LaunchManifest load_manifest(const std::filesystem::path& file);

/// Puts each group of components into one process of their own; the others stay where they are. The roster, and so the
/// run's identity, keeps its order. Throws ConfigurationError if a component is unknown or in two groups.
void regroup(LaunchManifest& manifest, const std::vector<std::vector<std::string>>& groups);

}  // namespace constrictor::cli
