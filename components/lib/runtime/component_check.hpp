// Checks the files of components without a run: what `--check` of a component's program does.
#pragma once

#include <string>
#include <vector>

#include "component/component.hpp"
#include "runtime/host.hpp"

namespace constrictor {

/// Begins each line of a warning that `--check` prints.
inline constexpr const char* kWarningMark = "warning: ";

/// What a check has found, for people.
struct Findings {
  std::vector<std::string> errors;    ///< the run cannot begin
  std::vector<std::string> warnings;  ///< it can, and often fails
};

/// Builds each component once from its files (robot, scenario, configuration), with ports that are connected to
/// nothing, and destroys it again. Joins no DDS domain and writes no file. Returns one error "NAME: what is wrong" for
/// each component that cannot be built; an error that several components report is returned once.
/// Also compares the latencies of these components with the depths of the topics between them, and asks the components
/// whether they can deal with the objects that the mission demands, if the scene is known here, and whether they can
/// move the robot.
[[nodiscard]] Findings check_components(const HostOptions& options, const std::vector<ComponentFactory>& factories);

/// The topics that the components of a process exchange with other processes, one line each: "reads TOPIC" or "writes
/// TOPIC". Topics of the barrier aside, which every process uses. Throws what the components' constructors throw.
std::vector<std::string> topics_of_components(const HostOptions& options,
                                              const std::vector<ComponentFactory>& factories);

/// Why the plant cannot take part in a run at this pace; empty: it can.
[[nodiscard]] std::string pace_violation(const HostOptions& options, const Component& plant);

}  // namespace constrictor
