// The state of a component that draws images of the simulated world, for its checkpoint.
#pragma once

#include <cstdint>

namespace constrictor {

/// Everything else in such an image follows from the world of its tick and from the scene.
struct FrameCount {
  std::uint64_t frames = 0;  ///< number of written frames
  template <class Archive>
  void serialize(Archive& archive) {
    archive(frames);
  }
};

}  // namespace constrictor
