#include "sim/camera/overview.hpp"

#include "configuration/configuration.hpp"
#include "robot/robot_model.hpp"
#include "sim/render/scene_messages.hpp"

namespace constrictor {

OverviewConfiguration load_overview(const std::filesystem::path& path) {
  auto file = Configuration::load(path);
  OverviewConfiguration configuration;
  configuration.width = static_cast<int>(file.integer("width", 16, 4096));
  configuration.height = static_cast<int>(file.integer("height", 16, 4096));
  configuration.period_ticks = static_cast<int>(file.integer("period_ticks", 1, 1000));
  configuration.latency_ticks = static_cast<int>(file.integer("latency_ticks", 1, 100));
  configuration.horizontal_fov_rad = file.number("horizontal_fov_rad", {0.1, 2.5});
  configuration.elevation_rad = file.number("elevation_rad", {0.1, 1.5});
  configuration.heading_rad = file.number("heading_rad", {-3.2, 3.2});
  configuration.margin = file.number("margin", {0.0, 0.4});
  configuration.surroundings.behind_m = file.number("behind_m", {0.0, 20.0});
  configuration.surroundings.ahead_m = file.number("ahead_m", {0.0, 20.0});
  configuration.surroundings.half_width_m = file.number("half_width_m", {0.0, 20.0});
  configuration.inset = file.number("inset", {0.0, 0.6});
  configuration.render.samples = static_cast<int>(file.integer("samples", 1, 4));
  if (configuration.render.samples != 1 && configuration.render.samples != 4) {
    throw file.error("samples", "found " + std::to_string(configuration.render.samples) + ", accepted 1 or 4");
  }
  configuration.render.shadow_map_size = static_cast<int>(file.integer("shadow_map_size", 0, 8192));
  configuration.render.shadow_taps = 3;
  configuration.render.module_segments = static_cast<int>(file.integer("module_segments", 8, 64));
  file.finish();
  return configuration;
}

Overview::Overview(Wiring& wiring, const Setup& setup)
    : configuration_(load_overview(setup.config_file)),
      timing_{static_cast<std::uint16_t>(configuration_.period_ticks), static_cast<std::uint16_t>(configuration_.latency_ticks)},
      world_(wiring.latest(topics::kWorldState)),
      description_(wiring.latest(topics::kSceneDescription)),
      image_(wiring.output(topics::kOverviewImage)) {
  configuration_.render.head_camera_m = load_robot(setup.robot_file).camera.p_HC;
}

void Overview::build(const msg::SceneDescription& description) {
  const Scene scene = scene_of(description);
  renderer_ = std::make_unique<Renderer>(scene, configuration_.render);
  const auto extent = scene_extent(scene, configuration_.surroundings);
  heading_rad_ = side_heading(scene) + configuration_.heading_rad;
  camera_ = fit_view(extent, heading_rad_, configuration_.elevation_rad,
                     configuration_.horizontal_fov_rad, configuration_.width, configuration_.height, configuration_.margin);
  shadow_ = shadow_region_of(extent);
  if (configuration_.inset > 0.0) {
    RenderOptions options = configuration_.render;
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
  const int width = static_cast<int>(camera_.width * configuration_.inset);
  const int height = static_cast<int>(camera_.height * configuration_.inset);
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
        pixel[channel] = picture ? inset[static_cast<std::size_t>(3 * (row * width + column) + channel)] : std::uint8_t{250};
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
  msg::CameraImage image{};
  image.width = static_cast<std::uint16_t>(camera_.width);
  image.height = static_cast<std::uint16_t>(camera_.height);
  image.exposure_tick = world_->header.tick;
  image.data._buffer = rgb_.data();
  image.data._length = static_cast<std::uint32_t>(rgb_.size());
  image.data._maximum = image.data._length;
  image_.write(image);
  ++state_.frames;
}

ComponentFactory make_overview_factory() {
  return {"overview", [](Wiring& wiring, const Setup& setup) { return std::make_unique<Overview>(wiring, setup); },
          "sim/camera/overview.yaml"};
}

}  // namespace constrictor
