// The parts that `constrictor conform` can check as members of a run, apart from the plant.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "configuration/parameter_set.hpp"
#include "conform/part_port.hpp"
#include "conform/report.hpp"
#include "robot/robot_model.hpp"

namespace constrictor::conform {

/// The inputs of the checks of a part.
struct PartSetting {
  RobotModel robot;
  std::filesystem::path profile;  ///< empty: the defaults
  std::string mission;            ///< of the scenario, as YAML on one line; empty: it states none
  bool may_move = true;           ///< the checks can send commands to the plant
};

struct PartKind {
  const char* name;     ///< in the roster, and of the subcommand
  const char* summary;  ///< of the subcommand's help
  const char* what;     ///< description of the checks, for the subcommand's help
  std::vector<Check> (*checks)();
  DescribeParameters profile;
  /// Makes all checks. Throws ConfigurationError if the profile is wrong, and PartGone.
  void (*run)(PartPort& port, const PartSetting& setting, Report& report);
  bool moves_joints;  ///< those of the plant of the manifest
  bool observable;    ///< the checks can also watch a run that goes on
};

[[nodiscard]] const std::vector<PartKind>& part_kinds();
/// Throws std::invalid_argument if there is no such part.
[[nodiscard]] const PartKind& part_kind(const std::string& name);

}  // namespace constrictor::conform
