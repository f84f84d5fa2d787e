#include "sim/camera/camera.hpp"

#include <utility>

#include "robot/pose_message.hpp"
#include "sim/render/image_message.hpp"
#include "sim/render/scene_from_messages.hpp"

namespace constrictor {

PinholeCamera camera_intrinsics(const CameraModel& camera) {
  return make_pinhole(camera.width, camera.height, camera.horizontal_fov_rad);
}

Camera::Camera(Wiring& wiring, const Setup& setup)
    : ConfiguredComponent(wiring, setup),
      model_(load_robot(setup.robot_file).camera),
      timing_{static_cast<std::uint16_t>(model_.period_ticks), static_cast<std::uint16_t>(model_.latency_ticks)},
      X_HC_(camera_mount(model_)),
      seed_(setup.component_seed()),
      errors_(config_.errors) {}

void Camera::build(const msg::SceneDescription& description) {
  RenderOptions options;
  options.shadow_map_size = config_.shadow_map_size;
  options.module_segments = config_.module_segments;
  renderer_ = std::make_unique<Renderer>(scene_of(description), options);
  noise_ = std::make_unique<PixelNoise>(description.camera_noise_sd, seed_);
}

void Camera::write_info(const Tick& tick) {
  const PinholeCamera camera = camera_intrinsics(model_);
  msg::CameraInfo info{};
  info.width = static_cast<std::uint16_t>(camera.width);
  info.height = static_cast<std::uint16_t>(camera.height);
  info.fx = camera.fx;
  info.fy = camera.fy;
  info.cx = camera.cx;
  info.cy = camera.cy;
  info.X_HC = pose_message(X_HC_);
  info.frame_period_s = timing_.period * tick.period_s();
  info_.write(info);
}

void Camera::draw(const ScenePoses& poses) {
  PinholeCamera camera = camera_intrinsics(model_);
  camera.X_WC = poses.X_WModule.front() * X_HC_;
  // The shadow region is in front of the robot, where it looks and acts.
  const Eigen::Vector3d ahead = camera.X_WC.translation() + 0.6 * config_.shadow_radius_m * camera.X_WC.linear().col(2);
  rgb_ = renderer_->draw(poses, camera, {ahead.head<2>(), config_.shadow_radius_m});
}

void Camera::step(const Tick& tick) {
  const msg::WorldState* before = nullptr;
  const msg::WorldState* now = nullptr;
  for (const msg::WorldState& world : worlds_) before = std::exchange(now, &world);
  if (now == nullptr || !description_ || now->module_count == 0) return;
  if (!renderer_) build(*description_);
  const std::int64_t exposed = now->header.tick;
  if (image_is_dropped(config_.errors.dropped_share, seed_, exposed)) return;
  const double between_s =
      before == nullptr ? 0.0 : static_cast<double>(exposed - before->header.tick) * tick.period_s();
  const std::vector<double> instants = exposure_instants(between_s > 0.0 ? config_.errors.exposure_s : 0.0);
  if (instants.size() == 1 && !errors_.change_single_frames()) {
    draw(poses_of(*now));
  } else {
    const ScenePoses poses = poses_of(*now);
    errors_.begin(instants.size());
    for (const double later_s : instants) {
      draw(later_s == 0.0 ? poses : extrapolated(poses_of(*before), poses, later_s / between_s));
      errors_.expose(rgb_);
    }
    errors_.finish(model_.width, rgb_);
  }
  noise_->add(rgb_, exposed);

  if (state_.frames == 0) write_info(tick);
  image_.write(image_message(camera_intrinsics(model_), rgb_, exposed));
  ++state_.frames;
}

ComponentFactory make_camera_factory() {
  return make_factory<Camera, CameraConfig>("camera", "sim/camera/camera.yaml");
}

}  // namespace constrictor
