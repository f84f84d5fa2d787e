// The picture of the scene and the images of the robot, as pictures for a canvas.
#pragma once

#include <memory>

#include "pictures/picture_feed.hpp"
#include "sim/figure/canvas.hpp"
#include "sim/overview/overview_view.hpp"

namespace constrictor::pictures {

class ScenePainter {
 public:
  /// `width`, `height` [pixel] of the pictures of the scene. Throws std::runtime_error if OpenGL fails.
  ScenePainter(const RecordedStory& story, int width, int height);
  /// Empty without a world.
  [[nodiscard]] figure::Picture scene(const Seen& seen);

 private:
  std::unique_ptr<OverviewView> view_;  // null: the recording has no simulated world
};

/// Empty without an image.
[[nodiscard]] figure::Picture picture_of(const std::shared_ptr<const msg::CameraImage>& image);

}  // namespace constrictor::pictures
