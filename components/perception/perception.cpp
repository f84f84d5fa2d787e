#include "perception/perception.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <cstring>

#include "perception/further_view.hpp"
#include "robot/planar_message.hpp"

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

/// The entry of a tick; otherwise the one nearest to it; null if there is none.
template <class Entry>
const Entry* nearest_in_time(const std::deque<Entry>& entries, std::int64_t tick) {
  const Entry* nearest = nullptr;
  for (const Entry& entry : entries) {
    if (nearest == nullptr || std::abs(entry.tick - tick) < std::abs(nearest->tick - tick)) nearest = &entry;
  }
  return nearest;
}

}  // namespace

Perception::Further::Further(Wiring& wiring)
    : infos(wiring.events(topics::kFurtherCameraInfo)),
      images(wiring.events(topics::kFurtherCameraImage)),
      percepts{wiring.output(topics::kFurtherLinePercept), wiring.output(topics::kFurtherObjectPercepts),
               wiring.output(topics::kFurtherProcessedImage)} {}

Perception::Perception(Wiring& wiring, const Setup& setup)
    : TunableComponent(wiring, setup, topics::kPerceptionParameters),
      detector_(config_),
      seed_(setup.component_seed()),
      robot_(load_robot(setup.robot_file)),
      head_{0.5 * robot_.module_length_m, robot_.module_radius_m} {
  if (robot_.further_cameras.empty()) return;
  further_.emplace(wiring);
  state_.further.resize(robot_.further_cameras.size());
}

msg::Quaternion Perception::attitude_at(std::int64_t tick) const {
  const Attitude* nearest = nearest_in_time(state_.attitudes, tick);
  return nearest ? msg::Quaternion{nearest->w, nearest->x, nearest->y, nearest->z}
                 : msg::Quaternion{1.0, 0.0, 0.0, 0.0};
}

std::span<const double> Perception::angles_at(std::int64_t tick) const {
  const Posture* nearest = nearest_in_time(state_.postures, tick);
  return nearest ? std::span<const double>(nearest->angles_rad) : std::span<const double>{};
}

bool Perception::accepted(const msg::CameraImage& image, const msg::CameraInfo& info, const char* topic,
                          ImageRepeats& repeats) {
  const std::string error = perception::image_error(image, info);
  if (!error.empty()) {
    wiring_.count_refusal(fmt::format("{}: {}", topic, error));
    return false;
  }
  // The noise of any camera makes each image different.
  const std::uint64_t now = fingerprint(image.data);
  repeats.equal_images = now == repeats.fingerprint ? repeats.equal_images + 1 : 1;
  repeats.fingerprint = now;
  if (config_.frozen_after == 0 || repeats.equal_images <= config_.frozen_after) return true;
  wiring_.count_refusal(fmt::format("{}: found the same bytes in {} images, accepted at most {}; the camera is frozen",
                                    topic, repeats.equal_images, config_.frozen_after));
  return false;
}

void Perception::remember_body(const Tick& tick) {
  if (imu_ && imu_.fresh()) {
    const auto& q = imu_->orientation;
    state_.attitudes.push_back({imu_->header.tick, q.w, q.x, q.y, q.z});
    if (state_.attitudes.size() > kAttitudes) state_.attitudes.pop_front();
    if (config_.ground.slope_time_s > 0.0) state_.slope.learn(q, tick.period_s() / config_.ground.slope_time_s);
    else state_.slope = {};
  }
  if (joints_ && joints_.fresh()) {
    const std::size_t count = std::min<std::size_t>(joints_->joint_count, robot_.joints.size());
    Posture now;
    if (state_.postures.size() == kAttitudes) {
      now = std::move(state_.postures.front());  // for its memory
      state_.postures.pop_front();
    }
    now.tick = joints_->header.tick;
    now.angles_rad.assign(joints_->position_rad, joints_->position_rad + count);
    state_.postures.push_back(std::move(now));
  }
}

void Perception::follow_events() {
  if (task_events_.empty()) return;
  state_.turn.wanted = true;
  for (FurtherCamera& camera : state_.further) camera.turn.wanted = true;
}

void Perception::disturb(const Tick& tick, const msg::CameraImage& image, const perception::GroundCamera& camera,
                         const PlanarPose& X_GV, perception::Percepts& percepts) const {
  const double exposure_s = static_cast<double>(image.exposure_tick) * tick.period_s();
  const double yaw_rad = yaw_of(attitude_at(image.exposure_tick)) + X_GV.yaw_rad;
  const std::uint64_t seed = seed_ + (std::uint64_t{image.camera} << 32U);  // each camera has errors of its own
  perception::PerceptErrors(config_.errors, seed).apply(exposure_s, yaw_rad, camera, percepts.line, percepts.objects);
}

void Perception::look(const Tick& tick, const msg::CameraImage& image, const perception::GroundCamera& camera,
                      const PlanarPose& X_GV, PictureTurn& turn, const PerceptOutputs& outputs) {
  ++state_.images;
  // The matrix is a view of the message's pixels. The detector does not write to them.
  const cv::Mat rgb(image.height, image.width, CV_8UC3, image.data._buffer);
  const std::uint8_t colour = state_.line_colour != 0 ? state_.line_colour : detector_.config().line_colour;
  perception::Percepts percepts = detector_.detect(rgb, camera, colour, state_.sizes, state_.ground);
  if (config_.errors.any()) disturb(tick, image, camera, X_GV, percepts);
  state_.sizes.learn(percepts.measured);
  state_.ground = percepts.ground;

  const auto complete = [&](auto& percept) {
    percept.camera = image.camera;
    percept.X_GV = {X_GV.p.x(), X_GV.p.y(), X_GV.yaw_rad};
    percept.exposure_tick = image.exposure_tick;
  };
  complete(percepts.line);
  complete(percepts.objects);
  outputs.line.write(percepts.line);
  outputs.objects.write(percepts.objects);
  if (!turn.take(config_.picture_period)) return;

  const cv::Mat& drawn = detector_.draw(rgb, camera, percepts.line, percepts.objects);
  msg::CameraImage picture{};
  picture.camera = image.camera;
  picture.width = image.width;
  picture.height = image.height;
  picture.exposure_tick = image.exposure_tick;
  picture.data._buffer = drawn.data;
  picture.data._length = picture.data._maximum = image.data._length;
  picture.data._release = false;
  outputs.processed.write(picture);
}

void Perception::look_further(const Tick& tick) {
  const auto known = [&](std::uint8_t number, const char* topic) {
    if (number >= 1 && number <= state_.further.size()) return true;
    wiring_.count_refusal(fmt::format("{}.camera: found {}, accepted 1 to {}, the further cameras of the robot", topic,
                                      number, state_.further.size()));
    return false;
  };
  for (const msg::CameraInfo& info : further_->infos) {
    if (known(info.camera, "camera/further/info")) state_.further[info.camera - 1U].info = info;
  }
  for (const msg::CameraImage& image : further_->images) {
    if (!known(image.camera, "camera/further/image")) continue;
    FurtherCamera& from = state_.further[image.camera - 1U];
    if (from.info.width == 0 || !accepted(image, from.info, "camera/further/image", from.repeats)) continue;
    const msg::Quaternion attitude =
        state_.slope.relative_to_ground(attitude_at(image.exposure_tick), config_.ground.level_rad);
    const auto view = perception::further_view(from.info, robot_, attitude, angles_at(image.exposure_tick));
    look(tick, image, view.camera, view.X_GV, from.turn, further_->percepts);
  }
}

void Perception::step(const Tick& tick) {
  if (parameters_.step(tick, state_.parameters)) detector_ = perception::LineAndBlobDetector(config_);
  remember_body(tick);
  follow_events();
  if (task_ && task_->parameters.line_colour != msg::kColourUnknown) state_.line_colour = task_->parameters.line_colour;
  if (image_ && image_.fresh() && info_ && accepted(*image_, *info_, "camera/image", state_.repeats)) {
    const msg::Quaternion attitude =
        state_.slope.relative_to_ground(attitude_at(image_->exposure_tick), config_.ground.level_rad);
    // The robot lies on its modules: the centre of the head is one radius above the ground.
    const perception::GroundCamera camera(
        *info_, attitude, robot_.module_radius_m, head_,
        perception::body_before_head(*info_, robot_, angles_at(image_->exposure_tick)));
    look(tick, *image_, camera, {}, state_.turn, percepts_);
  }
  if (further_) look_further(tick);
}

ComponentFactory make_perception_factory() {
  return make_factory<Perception, perception::PerceptionConfig>("perception", "components/perception/perception.yaml");
}

}  // namespace constrictor
