#include "pictures/scene_painter.hpp"

namespace constrictor::pictures {

ScenePainter::ScenePainter(const RecordedStory& story, int width, int height) {
  if (!story.scene) return;
  OverviewConfig config;
  config.width = width;
  config.height = height;
  view_ = std::make_unique<OverviewView>(*story.scene, config, story.head_camera_m);
}

figure::Picture ScenePainter::scene(const Seen& seen) {
  if (!view_ || !seen.world) return {};
  return {view_->camera().width, view_->camera().height, view_->draw(*seen.world).data()};
}

figure::Picture picture_of(const std::shared_ptr<const msg::CameraImage>& image) {
  return image ? figure::Picture(image->width, image->height, image->data._buffer) : figure::Picture();
}

}  // namespace constrictor::pictures
