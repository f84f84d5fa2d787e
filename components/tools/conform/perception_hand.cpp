#include "conform/perception_hand.hpp"

#include <algorithm>
#include <cmath>

namespace constrictor::conform {
namespace {

constexpr int kSettle_ticks = 10;  // in which the attitude of a scene is known before its first image

}  // namespace

PerceptionHand::PerceptionHand(PartPort& port, const RobotModel& robot, double answer_s)
    : info(SyntheticCamera(robot).info()),
      port_(port),
      camera_(robot),
      period_ticks_(robot.camera.period_ticks),
      answer_ticks_(std::max(2, static_cast<int>(std::lround(answer_s / kTick_s)))) {}

void PerceptionHand::tick(Seen* seen) {
  msg::ImuState imu{};
  imu.orientation = attitude_;
  imu.linear_acceleration_m_s2.z = 9.81;
  port_.send(topics::kImuState, imu);
  msg::TaskStatus task{};
  task.task = msg::kTaskFollowLine;
  task.goal_state = msg::kGoalRunning;
  task.goal_id = 1;
  task.parameters.line_colour = line_colour;
  port_.send(topics::kTaskStatus, task);
  port_.advance();
  if (seen == nullptr) return;
  for (const auto* line : port_.written(topics::kLinePercept)) seen->lines.push_back(*line);
  for (const auto* objects : port_.written(topics::kObjectPercepts)) seen->objects.push_back(*objects);
  for (const auto* picture : port_.written(topics::kProcessedImage))
    seen->pictures.push_back({picture->width, picture->height, picture->exposure_tick});
  if (seen->answer_ticks < 0 && seen->answered()) seen->answer_ticks = port_.tick() - seen->sent_tick;
}

void PerceptionHand::wait(int ticks) {
  for (int i = 0; i < ticks; ++i) tick(nullptr);
}

Seen PerceptionHand::show(std::vector<std::uint8_t> rgb, int width, int height, std::int64_t age_ticks) {
  msg::CameraImage image{};
  image.width = static_cast<std::uint16_t>(width);
  image.height = static_cast<std::uint16_t>(height);
  Seen seen;
  seen.sent_tick = port_.tick() + 1;
  seen.exposure_tick = image.exposure_tick = std::max<std::int64_t>(0, seen.sent_tick - age_ticks);
  image.data._buffer = rgb.data();
  image.data._length = image.data._maximum = static_cast<std::uint32_t>(rgb.size());
  if (info) port_.send(topics::kCameraInfo, *info);
  info.reset();
  port_.send(topics::kCameraImage, image);
  // The next image comes only when this one has been answered, so that answers and images cannot be confused.
  int ticks = 0;
  do tick(&seen);
  while (++ticks < period_ticks_ || (ticks < 2 * answer_ticks_ + 2 && !seen.answered()));
  return seen;
}

std::vector<Seen> PerceptionHand::show(const SyntheticScene& scene, int images) {
  attitude_ = SyntheticCamera::attitude(scene);
  wait(kSettle_ticks);
  const std::vector<std::uint8_t> clean = camera_.draw(scene);
  const msg::CameraInfo model = camera_.info();
  std::vector<Seen> all;
  for (int i = 0; i < images; ++i) {
    std::vector<std::uint8_t> rgb = clean;
    SyntheticCamera::add_noise(rgb, scene.noise, ++images_);
    all.push_back(show(std::move(rgb), model.width, model.height));
  }
  return all;
}

void PerceptionHand::begin_epoch() {
  port_.begin_epoch();
  images_ = 0;
  info = camera_.info();
  attitude_ = {1.0, 0.0, 0.0, 0.0};
  line_colour = msg::kColourBlue;
}

}  // namespace constrictor::conform
