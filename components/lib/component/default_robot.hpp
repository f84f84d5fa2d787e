// The robot of a plant or of another driver of a device: such components also run without a launcher, which names the
// robot.
#pragma once

#include <filesystem>

#include "component/component.hpp"
#include "component/data_path.hpp"

namespace constrictor {

/// The robot file of `setup`; the default one if it names none.
[[nodiscard]] inline std::filesystem::path robot_file_of(const Setup& setup) {
  return setup.robot_file.empty() ? default_robot_file() : setup.robot_file;
}

}  // namespace constrictor
