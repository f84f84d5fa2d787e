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
      robot_(load_robot(setup.robot_file)),
      timing_{static_cast<std::uint16_t>(robot_.camera.period_ticks),
              static_cast<std::uint16_t>(robot_.camera.latency_ticks)},
      seed_(setup.component_seed()),
      errors_(config_.errors) {
  eyes_.push_back(eye(0, robot_.camera, wiring.output(topics::kCameraInfo), wiring.output(topics::kCameraImage)));
  if (robot_.further_cameras.empty()) return;
  const auto info = wiring.output(topics::kFurtherCameraInfo);
  const auto image = wiring.output(topics::kFurtherCameraImage);
  for (const CameraModel& model : robot_.further_cameras) eyes_.push_back(eye(eyes_.size(), model, info, image));
}

Camera::Eye Camera::eye(std::size_t number, const CameraModel& model, const Output<msg::CameraInfo>& info,
                        const Output<msg::CameraImage>& image) const {
  // Noise and lost images of different cameras are independent of each other.
  return {static_cast<std::uint8_t>(number), model, camera_mount(model), seed_ + (number << 32U), info, image};
}

void Camera::build(const msg::SceneDescription& description) {
  RenderOptions options;
  options.shadow_map_size = config_.shadow_map_size;
  options.module_segments = config_.module_segments;
  renderer_ = std::make_unique<Renderer>(scene_of(description), options);
  for (Eye& eye : eyes_) eye.noise = std::make_unique<PixelNoise>(description.camera_noise_sd, eye.seed);
}

void Camera::write_info(const Tick& tick, const Eye& eye) const {
  const PinholeCamera camera = camera_intrinsics(eye.model);
  msg::CameraInfo info{};
  info.camera = eye.number;
  info.module_index = static_cast<std::uint8_t>(eye.model.module);
  info.width = static_cast<std::uint16_t>(camera.width);
  info.height = static_cast<std::uint16_t>(camera.height);
  info.fx = camera.fx;
  info.fy = camera.fy;
  info.cx = camera.cx;
  info.cy = camera.cy;
  info.X_HC = pose_message(eye.X_MC);
  info.frame_period_s = timing_.period * tick.period_s();
  eye.info.write(info);
}

void Camera::draw(const Eye& eye, const ScenePoses& poses) {
  PinholeCamera camera = camera_intrinsics(eye.model);
  camera.X_WC = poses.X_WModule[eye.model.module] * eye.X_MC;
  // The shadow region is in front of the camera: where the robot looks and acts.
  const Eigen::Vector3d ahead = camera.X_WC.translation() + 0.6 * config_.shadow_radius_m * camera.X_WC.linear().col(2);
  rgb_ = renderer_->draw(poses, camera, {ahead.head<2>(), config_.shadow_radius_m});
}

void Camera::expose(const Tick& tick, const Eye& eye, const msg::WorldState* before, const msg::WorldState& now) {
  const std::int64_t exposed = now.header.tick;
  const double between_s =
      before == nullptr ? 0.0 : static_cast<double>(exposed - before->header.tick) * tick.period_s();
  const std::vector<double> instants = exposure_instants(between_s > 0.0 ? config_.errors.exposure_s : 0.0);
  if (instants.size() == 1 && !errors_.change_single_frames()) {
    draw(eye, poses_of(now));
  } else {
    const ScenePoses poses = poses_of(now);
    errors_.begin(instants.size());
    for (const double later_s : instants) {
      draw(eye, later_s == 0.0 ? poses : extrapolated(poses_of(*before), poses, later_s / between_s));
      errors_.expose(rgb_);
    }
    errors_.finish(eye.model.width, rgb_);
  }
  eye.noise->add(rgb_, exposed);
  msg::CameraImage image = image_message(camera_intrinsics(eye.model), rgb_, exposed);
  image.camera = eye.number;
  eye.image.write(image);
}

void Camera::step(const Tick& tick) {
  const msg::WorldState* before = nullptr;
  const msg::WorldState* now = nullptr;
  for (const msg::WorldState& world : worlds_) before = std::exchange(now, &world);
  if (now == nullptr || !description_ || now->module_count == 0) return;
  if (!renderer_) build(*description_);
  for (const Eye& eye : eyes_) {
    if (eye.model.module >= now->module_count) continue;
    if (image_is_dropped(config_.errors.dropped_share, eye.seed, now->header.tick)) continue;
    auto& frames = state_.frames[eye.number];
    if (frames++ == 0) write_info(tick, eye);
    expose(tick, eye, before, *now);
  }
}

ComponentFactory make_camera_factory() {
  return make_factory<Camera, CameraConfig>("camera", "sim/camera/camera.yaml");
}

}  // namespace constrictor
