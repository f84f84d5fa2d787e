#include "sim/camera_emulator/emulated_camera.hpp"

#include <algorithm>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>
#include <stdexcept>

#include "device_faults/device_commands.hpp"
#include "robot/camera_mount.hpp"
#include "sim/camera/camera.hpp"
#include "sim/physics/scene_description.hpp"
#include "sim/render/scene_from_messages.hpp"

namespace constrictor::camera_emulator {
namespace {

constexpr double kShadowRadius_m = 2.2;  // as the simulated camera's

Scene drawn_scene(const Scenario& scenario, const RobotModel& robot) {
  return scene_of(scene_description(scenario, robot));
}

/// [0, 1) from the upper 53 bits: the same on every platform.
double uniform(std::mt19937_64& random) { return static_cast<double>(random() >> 11) * 0x1p-53; }

}  // namespace

EmulatedCamera::EmulatedCamera(const RobotModel& robot, const Scenario& scenario, std::uint64_t seed,
                               const CameraSettings& settings)
    : model_(robot.camera),
      settings_(settings),
      faults_(settings.usual),
      X_HC_(camera_mount(robot.camera)),
      renderer_(std::make_unique<Renderer>(drawn_scene(scenario, robot), RenderOptions{})),
      noise_(scenario.camera_noise_sd, seed),
      random_(seed) {
  model_.width *= settings.scale;
  model_.height *= settings.scale;
}

EmulatedCamera::~EmulatedCamera() = default;

Jpeg EmulatedCamera::picture(const msg::WorldState& world) {
  const ScenePoses poses = poses_of(world);
  PinholeCamera camera = camera_intrinsics(model_);
  camera.X_WC = poses.X_WModule.front() * X_HC_;
  const Eigen::Vector3d ahead = camera.X_WC.translation() + 0.6 * kShadowRadius_m * camera.X_WC.linear().col(2);
  if (faults_.black) rgb_.assign(static_cast<std::size_t>(camera.width * camera.height * 3), 0);
  else rgb_ = renderer_->draw(poses, camera, {ahead.head<2>(), kShadowRadius_m});
  cv::Mat rgb(camera.height, camera.width, CV_8UC3, rgb_.data());
  if (faults_.blur_px > 0.0 && !faults_.black) cv::GaussianBlur(rgb, rgb, {}, faults_.blur_px);
  noise_.add(rgb_, frames_);  // the sensor is behind the lens
  cv::Mat bgr;
  cv::cvtColor(rgb, bgr, cv::COLOR_RGB2BGR);
  std::vector<std::uint8_t> bytes;
  if (!cv::imencode(".jpg", bgr, bytes, {cv::IMWRITE_JPEG_QUALITY, settings_.jpeg_quality}))
    throw std::runtime_error("OpenCV cannot write JPEG");
  return std::make_shared<const std::vector<std::uint8_t>>(std::move(bytes));
}

EmulatedFrame EmulatedCamera::expose(const msg::WorldState& world) {
  ++frames_;
  // Both numbers are drawn for every frame, so that a fault does not change the others.
  const double late = uniform(random_), lost = uniform(random_);
  if (!faults_.frozen || !last_) last_ = picture(world);
  if (lost < faults_.drop) return {nullptr, 0.0};
  return {last_, faults_.delay_s + late * faults_.jitter_s};
}

std::string EmulatedCamera::command(const std::string& line) {
  const auto read = read_order("camera_emulator", line, {});
  if (const auto* refusal = std::get_if<std::string>(&read)) return *refusal;
  const auto& [known, index, value] = std::get<DeviceOrder>(read);
  const std::string_view name = known->name;
  if (name == "mend") faults_ = settings_.usual;
  else if (name == "off" || name == "on") faults_.off = name == "off";
  else if (name == "silent") faults_.silent = true;
  else if (name == "black") faults_.black = true;
  else if (name == "freeze") faults_.frozen = true;
  else if (name == "blur") faults_.blur_px = value;
  else if (name == "delay") faults_.delay_s = value;
  else if (name == "jitter") faults_.jitter_s = value;
  else if (name == "drop") faults_.drop = value;
  return {};
}

}  // namespace constrictor::camera_emulator
