#include "sim/camera/camera.hpp"

#include <cmath>

#include "configuration/configuration.hpp"
#include "sim/render/scene_messages.hpp"

namespace constrictor {

Eigen::Isometry3d camera_mount(const CameraModel& camera) {
  const double c = std::cos(camera.tilt_rad);
  const double s = std::sin(camera.tilt_rad);
  Eigen::Isometry3d X_HC = Eigen::Isometry3d::Identity();
  X_HC.linear().col(0) = -Eigen::Vector3d::UnitY();
  X_HC.linear().col(1) = Eigen::Vector3d(-s, 0.0, -c);
  X_HC.linear().col(2) = Eigen::Vector3d(c, 0.0, -s);
  X_HC.translation() = camera.p_HC;
  return X_HC;
}

PinholeCamera camera_intrinsics(const CameraModel& camera) {
  return make_pinhole(camera.width, camera.height, camera.horizontal_fov_rad);
}

Camera::Camera(Wiring& wiring, const Setup& setup)
    : model_(load_robot(setup.robot_file).camera),
      timing_{static_cast<std::uint16_t>(model_.period_ticks), static_cast<std::uint16_t>(model_.latency_ticks)},
      X_HC_(camera_mount(model_)),
      seed_(setup.component_seed()),
      world_(wiring.latest(topics::kWorldState)),
      description_(wiring.latest(topics::kSceneDescription)),
      info_(wiring.output(topics::kCameraInfo)),
      image_(wiring.output(topics::kCameraImage)) {
  auto file = Configuration::load(setup.config_file);
  options_.shadow_map_size = static_cast<int>(file.integer("shadow_map_size", 0, 4096));
  options_.module_segments = static_cast<int>(file.integer("module_segments", 8, 64));
  shadow_radius_m_ = file.number("shadow_radius_m", {0.5, 20.0});
  file.finish();
}

void Camera::build(const msg::SceneDescription& description) {
  renderer_ = std::make_unique<Renderer>(scene_of(description), options_);
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
  const Eigen::Quaterniond q(X_HC_.linear());
  const Eigen::Vector3d p = X_HC_.translation();
  info.X_HC = {{p.x(), p.y(), p.z()}, {q.w(), q.x(), q.y(), q.z()}};
  info.frame_period_s = timing_.period * tick.period_s();
  info_.write(info);
}

void Camera::step(const Tick& tick) {
  if (!world_ || !description_ || world_->module_count == 0) return;
  if (!renderer_) build(*description_);
  const ScenePoses poses = poses_of(*world_);
  PinholeCamera camera = camera_intrinsics(model_);
  camera.X_WC = poses.X_WModule.front() * X_HC_;
  // Shadows matter where the robot looks and acts: in front of it.
  const Eigen::Vector3d ahead = camera.X_WC.translation() + 0.6 * shadow_radius_m_ * camera.X_WC.linear().col(2);
  rgb_ = renderer_->draw(poses, camera, {ahead.head<2>(), shadow_radius_m_});
  noise_->add(rgb_, world_->header.tick);

  if (state_.frames == 0) write_info(tick);
  msg::CameraImage image{};
  image.width = static_cast<std::uint16_t>(camera.width);
  image.height = static_cast<std::uint16_t>(camera.height);
  image.exposure_tick = world_->header.tick;
  image.data._buffer = rgb_.data();
  image.data._length = static_cast<std::uint32_t>(rgb_.size());
  image.data._maximum = image.data._length;
  image_.write(image);
  ++state_.frames;
}

ComponentFactory make_camera_factory() {
  return {"camera", [](Wiring& wiring, const Setup& setup) { return std::make_unique<Camera>(wiring, setup); },
          "sim/camera/camera.yaml"};
}

}  // namespace constrictor
