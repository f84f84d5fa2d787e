#include "sim/overview/overview_view.hpp"

#include "sim/render/scene_from_messages.hpp"

namespace constrictor {
namespace {

RenderOptions render_options(const OverviewConfig& options, const Eigen::Vector3d& head_camera_m) {
  RenderOptions render = options.render;
  render.head_camera_m = head_camera_m;
  return render;
}

}  // namespace

OverviewView::OverviewView(const msg::SceneDescription& description, const OverviewConfig& options,
                           const Eigen::Vector3d& head_camera_m)
    : OverviewView(scene_of(description), options, render_options(options, head_camera_m)) {}

OverviewView::OverviewView(const Scene& scene, const OverviewConfig& options, const RenderOptions& render)
    : options_(options),
      extent_(scene_extent(scene, options.surroundings)),
      follows_(scene.line_m.empty()),
      heading_rad_(side_heading(scene) + options.heading_rad),
      renderer_(scene, render) {
  look_at_bodies({});
}

void OverviewView::look_at_bodies(const ScenePoses& poses) {
  std::vector<Eigen::Vector3d> points = extent_;
  const std::vector<Eigen::Vector3d> bodies = bodies_extent(poses);
  points.insert(points.end(), bodies.begin(), bodies.end());
  camera_ = fit_view(points, heading_rad_, options_.elevation_rad, options_.horizontal_fov_rad, options_.width,
                     options_.height, options_.margin);
  shadow_ = shadow_region_of(points);
}

std::vector<std::uint8_t>& OverviewView::draw(const msg::WorldState& world) {
  const ScenePoses poses = poses_of(world);
  if (follows_) look_at_bodies(poses);
  rgb_ = renderer_.draw(poses, camera_, shadow_);
  draw_inset(poses);
  return rgb_;
}

void OverviewView::draw_inset(const ScenePoses& poses) {
  if (options_.inset <= 0.0 || poses.X_WModule.empty()) return;
  constexpr double kInsetElevation_rad = 0.75;
  constexpr double kInsetMargin = 0.06;
  constexpr int kBorder = 2;
  std::vector<Eigen::Vector3d> body;
  for (const Eigen::Isometry3d& X_WModule : poses.X_WModule) body.push_back(X_WModule.translation());
  const int width = static_cast<int>(camera_.width * options_.inset);
  const int height = static_cast<int>(camera_.height * options_.inset);
  if (width < 8 || height < 8) return;
  const PinholeCamera camera = fit_view(body, heading_rad_, kInsetElevation_rad, 0.5, width, height, kInsetMargin);
  ShadowRegion region = shadow_region_of(body);
  region.coarse = true;
  const std::vector<std::uint8_t>& inset = renderer_.draw(poses, camera, region);
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

}  // namespace constrictor
