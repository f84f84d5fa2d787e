// The world of a simulated run, as its plant publishes it.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>

#include "constrictor/messages.hpp"

namespace constrictor::camera_emulator {

/// An observer of ground truth in a DDS domain.
class RunWorld {
 public:
  /// Throws dds::Error.
  explicit RunWorld(std::uint32_t domain);
  ~RunWorld();

  /// The newest state; empty as long as there is none. `expected`: the scene that is drawn. Throws std::runtime_error
  /// if the run has another scene.
  [[nodiscard]] std::optional<msg::WorldState> read(const msg::SceneDescription& expected);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace constrictor::camera_emulator
