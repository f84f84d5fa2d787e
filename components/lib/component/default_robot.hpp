// The robot of a component that drives a device: such components also run without a launcher, which names the robot.
#pragma once

#include <filesystem>

#include "component/component.hpp"
#include "component/data_path.hpp"

namespace constrictor {

/// The robot file of `setup`; that of the robot `mamba` if it names none.
[[nodiscard]] inline std::filesystem::path robot_file_of(const Setup& setup) {
  return setup.robot_file.empty() ? data_path("components/lib/robot/mamba.yaml") : setup.robot_file;
}

}  // namespace constrictor
