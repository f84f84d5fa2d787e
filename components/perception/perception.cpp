#include "perception/perception.hpp"

#include <fmt/format.h>

#include <cmath>
#include <cstdlib>
#include <cstring>

#include "robot/planar_message.hpp"
#include "robot/robot_model.hpp"

namespace constrictor {
namespace {

constexpr std::size_t kAttitudes = 32;  // [ticks] longer than the delay of any camera

/// FNV-1a (Fowler, Noll, Vo) over words of eight bytes; the bytes after the last whole word are left out.
std::uint64_t fingerprint(const dds_sequence_octet& bytes) {
  std::uint64_t hash = 0xcbf29ce484222325;
  for (std::uint32_t i = 0; i + 8 <= bytes._length; i += 8) {
    std::uint64_t word = 0;
    std::memcpy(&word, bytes._buffer + i, sizeof word);
    hash = (hash ^ word) * 0x100000001b3;
  }
  return hash;
}

}  // namespace

Perception::Perception(Wiring& wiring, const Setup& setup)
    : TunableComponent(wiring, setup, topics::kPerceptionParameters),
      detector_(config_),
      seed_(setup.component_seed()) {
  const RobotModel robot = load_robot(setup.robot_file);
  // The robot lies on its modules: the centre of the head is one radius above the ground.
  head_height_m_ = robot.module_radius_m;
  head_ = {0.5 * robot.module_length_m, robot.module_radius_m};
}

msg::Quaternion Perception::attitude_at(std::int64_t tick) const {
  const Attitude* nearest = nullptr;
  for (const Attitude& a : state_.attitudes) {
    if (nearest == nullptr || std::abs(a.tick - tick) < std::abs(nearest->tick - tick)) nearest = &a;
  }
  return nearest ? msg::Quaternion{nearest->w, nearest->x, nearest->y, nearest->z}
                 : msg::Quaternion{1.0, 0.0, 0.0, 0.0};
}

bool Perception::frozen(const msg::CameraImage& image) {
  const std::uint64_t now = fingerprint(image.data);
  state_.equal_images = now == state_.fingerprint ? state_.equal_images + 1 : 1;
  state_.fingerprint = now;
  return config_.frozen_after > 0 && state_.equal_images > config_.frozen_after;
}

void Perception::step(const Tick& tick) {
  if (parameters_.step(tick, state_.parameters)) detector_ = perception::LineAndBlobDetector(config_);
  if (imu_ && imu_.fresh()) {
    const auto& q = imu_->orientation;
    state_.attitudes.push_back({imu_->header.tick, q.w, q.x, q.y, q.z});
    if (state_.attitudes.size() > kAttitudes) state_.attitudes.pop_front();
    if (config_.slope_time_s > 0.0) state_.slope.learn(q, tick.period_s() / config_.slope_time_s);
    else state_.slope = {};
  }
  if (task_ && task_->parameters.line_colour != msg::kColourUnknown) state_.line_colour = task_->parameters.line_colour;
  if (!image_ || !image_.fresh() || !info_) return;
  const std::string error = perception::image_error(*image_, *info_);
  if (!error.empty()) {
    wiring_.count_refusal("camera/image: " + error);
    return;
  }
  if (frozen(*image_)) {
    wiring_.count_refusal(
        fmt::format("camera/image: found the same bytes in {} images, accepted at most {}; the camera "
                    "is frozen",
                    state_.equal_images, config_.frozen_after));
    return;
  }
  ++state_.images;

  // The matrix is a view of the message's pixels. The detector does not write to them.
  const cv::Mat rgb(image_->height, image_->width, CV_8UC3, image_->data._buffer);
  const msg::Quaternion attitude =
      state_.slope.relative_to_ground(attitude_at(image_->exposure_tick), config_.level_rad);
  const perception::GroundCamera camera(*info_, attitude, head_height_m_, head_);
  const std::uint8_t colour = state_.line_colour != 0 ? state_.line_colour : detector_.config().line_colour;
  perception::LineAndBlobDetector::Change errors;
  if (config_.errors.any()) {
    errors = [&](msg::LinePercept& line, msg::ObjectPercepts& objects) {
      const double exposure_s = static_cast<double>(image_->exposure_tick) * tick.period_s();
      const double yaw_rad = yaw_of(attitude_at(image_->exposure_tick));
      perception::PerceptErrors(config_.errors, seed_).apply(exposure_s, yaw_rad, camera, line, objects);
    };
  }
  perception::Percepts percepts = detector_.detect(rgb, camera, colour, state_.sizes, errors);
  state_.sizes.learn(percepts.measured);

  percepts.line.exposure_tick = image_->exposure_tick;
  percepts.objects.exposure_tick = image_->exposure_tick;
  line_.write(percepts.line);
  objects_.write(percepts.objects);

  msg::CameraImage picture{};
  picture.width = image_->width;
  picture.height = image_->height;
  picture.exposure_tick = image_->exposure_tick;
  picture.data._buffer = percepts.picture.data;
  picture.data._length = picture.data._maximum = image_->data._length;
  picture.data._release = false;
  processed_.write(picture);
}

ComponentFactory make_perception_factory() {
  return make_factory<Perception, perception::PerceptionConfig>("perception", "components/perception/perception.yaml");
}

}  // namespace constrictor
