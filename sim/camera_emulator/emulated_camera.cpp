#include "sim/camera_emulator/emulated_camera.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <functional>
#include <map>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>
#include <sstream>
#include <stdexcept>

#include "robot/camera_mount.hpp"
#include "sim/camera/camera.hpp"
#include "sim/physics/scene_description.hpp"
#include "sim/render/scene_from_messages.hpp"

namespace constrictor::camera_emulator {
namespace {

constexpr double kShadowRadius_m = 2.2;  // as the simulated camera's

struct Command {
  const char* value_name;  ///< null: there is none
  double min, max;
  std::function<void(CameraFaults&, double)> obey;
};

/// `mend` is not among them: it needs the usual faults.
const std::map<std::string, Command>& commands() {
  static const std::map<std::string, Command> known = {
      {"off", {nullptr, 0, 0, [](CameraFaults& f, double) { f.off = true; }}},
      {"on", {nullptr, 0, 0, [](CameraFaults& f, double) { f.off = false; }}},
      {"silent", {nullptr, 0, 0, [](CameraFaults& f, double) { f.silent = true; }}},
      {"black", {nullptr, 0, 0, [](CameraFaults& f, double) { f.black = true; }}},
      {"freeze", {nullptr, 0, 0, [](CameraFaults& f, double) { f.frozen = true; }}},
      {"blur", {"PIXELS", 0, 50, [](CameraFaults& f, double value) { f.blur_px = value; }}},
      {"delay", {"SECONDS", 0, 10, [](CameraFaults& f, double value) { f.delay_s = value; }}},
      {"jitter", {"SECONDS", 0, 10, [](CameraFaults& f, double value) { f.jitter_s = value; }}},
      {"drop", {"PROBABILITY", 0, 1, [](CameraFaults& f, double value) { f.drop = value; }}},
  };
  return known;
}

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
  std::istringstream words(line);
  std::string name;
  words >> name;
  if (name == "mend" && (words >> std::ws).eof()) {
    faults_ = settings_.usual;
    return {};
  }
  const auto found = commands().find(name);
  const auto usage_of = [](const auto& entry) {
    return entry.first + (entry.second.value_name ? fmt::format(" {}", entry.second.value_name) : "");
  };
  if (found == commands().end()) {
    std::string accepted = "mend";
    for (const auto& entry : commands()) accepted += ", " + usage_of(entry);
    return fmt::format("found '{}', accepted {}", line, accepted);
  }
  const Command& command = found->second;
  double value = 0.0;
  const bool read = (!command.value_name || (words >> value)) && (words >> std::ws).eof();
  if (!read || !(value >= command.min && value <= command.max))
    return fmt::format("found '{}', accepted {}{}", line, usage_of(*found),
                       command.value_name ? fmt::format(" from {:g} to {:g}", command.min, command.max) : "");
  command.obey(faults_, value);
  return {};
}

}  // namespace constrictor::camera_emulator
