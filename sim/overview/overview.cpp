#include "sim/overview/overview.hpp"

#include "robot/robot_model.hpp"
#include "sim/render/image_message.hpp"
#include "sim/render/scene_from_messages.hpp"

namespace constrictor {

Overview::Overview(Wiring& wiring, const Setup& setup)
    : ConfiguredComponent(wiring, setup),
      timing_{static_cast<std::uint16_t>(config_.period_ticks), static_cast<std::uint16_t>(config_.latency_ticks)} {
  config_.render.head_camera_m = load_robot(setup.robot_file).camera.p_HC;
}

void Overview::build(const msg::SceneDescription& description) {
  const Scene scene = scene_of(description);
  renderer_ = std::make_unique<Renderer>(scene, config_.render);
  const auto extent = scene_extent(scene, config_.surroundings);
  heading_rad_ = side_heading(scene) + config_.heading_rad;
  camera_ = fit_view(extent, heading_rad_, config_.elevation_rad, config_.horizontal_fov_rad, config_.width,
                     config_.height, config_.margin);
  shadow_ = shadow_region_of(extent);
  if (config_.inset > 0.0) {
    RenderOptions options = config_.render;
    options.shadow_map_size /= 2;
    inset_renderer_ = std::make_unique<Renderer>(scene, options);
  }
}

void Overview::draw_inset(const ScenePoses& poses) {
  if (!inset_renderer_ || poses.X_WModule.empty()) return;
  constexpr double kInsetElevation_rad = 0.75;
  constexpr double kInsetMargin = 0.06;
  constexpr int kBorder = 2;
  std::vector<Eigen::Vector3d> body;
  for (const Eigen::Isometry3d& X_WModule : poses.X_WModule) body.push_back(X_WModule.translation());
  const int width = static_cast<int>(camera_.width * config_.inset);
  const int height = static_cast<int>(camera_.height * config_.inset);
  if (width < 8 || height < 8) return;
  const PinholeCamera camera = fit_view(body, heading_rad_, kInsetElevation_rad, 0.5, width, height, kInsetMargin);
  const std::vector<std::uint8_t>& inset = inset_renderer_->draw(poses, camera, shadow_region_of(body));
  const int top = camera_.height - height - 2 * kBorder;
  for (int row = -kBorder; row < height + kBorder; ++row) {
    std::uint8_t* target = rgb_.data() + static_cast<std::ptrdiff_t>(3) * (top + kBorder + row - 1) * camera_.width;
    const bool inside = row >= 0 && row < height;
    for (int column = -kBorder; column < width + kBorder; ++column) {
      std::uint8_t* pixel = target + static_cast<std::ptrdiff_t>(3) * (column + kBorder + 1);
      const bool picture = inside && column >= 0 && column < width;
      for (int channel = 0; channel < 3; ++channel) {
        pixel[channel] =
            picture ? inset[static_cast<std::size_t>(3 * (row * width + column) + channel)] : std::uint8_t{250};
      }
    }
  }
}

void Overview::step(const Tick&) {
  if (!world_ || !description_) return;
  if (!renderer_) build(*description_);
  const ScenePoses poses = poses_of(*world_);
  rgb_ = renderer_->draw(poses, camera_, shadow_);
  draw_inset(poses);
  image_.write(image_message(camera_, rgb_, world_->header.tick));
  ++state_.frames;
}

ComponentFactory make_overview_factory() {
  return make_factory<Overview, OverviewConfig>("overview", "sim/overview/overview.yaml");
}

}  // namespace constrictor
