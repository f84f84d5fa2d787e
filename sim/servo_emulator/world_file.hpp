// The file in which the emulator notes what really happens, so that a run can be judged afterwards.
#pragma once

#include <cstdint>
#include <filesystem>
#include <fstream>

#include "sim/world/world.hpp"

namespace constrictor::servo_emulator {

/// One JSON object a line: the scene first, then the world again and again. README.md has the fields.
class WorldFile {
 public:
  /// Throws std::runtime_error if the file cannot be written.
  WorldFile(const std::filesystem::path& file, const World& world, double every_s);
  /// Notes the world if the last note is old enough.
  void note(const World& world, std::int64_t left_out_ns);

 private:
  std::ofstream file_;
  double every_s_;
  double next_s_ = 0.0;
};

}  // namespace constrictor::servo_emulator
