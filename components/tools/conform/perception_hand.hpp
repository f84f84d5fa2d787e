// Plays the surroundings of a perception: a camera that shows synthetic scenes, an inertial unit and a navigation.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "conform/part_port.hpp"
#include "conform/synthetic_view.hpp"

namespace constrictor::conform {

/// The result for one image.
struct Seen {
  std::int64_t exposure_tick = 0;  ///< of the image
  std::int64_t sent_tick = 0;      ///< at which it was written
  std::vector<msg::LinePercept> lines;
  std::vector<msg::ObjectPercepts> objects;
  struct Picture {
    int width = 0, height = 0;
    std::int64_t exposure_tick = 0;
  };
  std::vector<Picture> pictures;
  std::int64_t answer_ticks = -1;  ///< from sent_tick until the first percept was visible; -1: never

  [[nodiscard]] bool answered() const { return !lines.empty() && !objects.empty(); }
};

class PerceptionHand {
 public:
  PerceptionHand(PartPort& port, const RobotModel& robot, double answer_s);

  /// Shows `images` images of the scene, with other noise in each, and waits for the answer to each of them.
  std::vector<Seen> show(const SyntheticScene& scene, int images = 3);
  /// Shows these pixels, which claim to have this size.
  Seen show(std::vector<std::uint8_t> rgb, int width, int height, std::int64_t age_ticks = kAge_ticks);
  /// Goes on without images.
  void wait(int ticks);
  void begin_epoch();

  std::uint8_t line_colour = msg::kColourBlue;  ///< that the task names
  std::optional<msg::CameraInfo> info;          ///< sent with the next image, then empty
  [[nodiscard]] const SyntheticCamera& camera() const { return camera_; }

 private:
  static constexpr std::int64_t kAge_ticks = 2;
  void tick(Seen* seen);
  PartPort& port_;
  SyntheticCamera camera_;
  int period_ticks_, answer_ticks_;
  msg::Quaternion attitude_{1.0, 0.0, 0.0, 0.0};
  std::uint64_t images_ = 0;
};

}  // namespace constrictor::conform
