// The component: images in, percepts and a processed picture out.
#pragma once

#include <cereal/types/array.hpp>
#include <cereal/types/deque.hpp>
#include <cstdint>
#include <deque>

#include "component/component.hpp"
#include "component/parameters.hpp"
#include "perception/line_and_blob_detector.hpp"
#include "robot/ground_slope.hpp"

namespace constrictor {

/// Attitude of the head at a tick: unit quaternion from head to world.
struct Attitude {
  std::int64_t tick = 0;
  double w = 1.0, x = 0.0, y = 0.0, z = 0.0;
  template <class Archive>
  void serialize(Archive& archive) {
    archive(tick, w, x, y, z);
  }
};

struct PerceptionState {
  std::deque<Attitude> attitudes;  ///< of the last ticks, the oldest first
  std::uint8_t line_colour = 0;    ///< named by a task; 0: no task has named one
  std::uint64_t images = 0;        ///< number of processed images
  std::uint64_t fingerprint = 0;   ///< of the last image
  int equal_images = 0;            ///< number of last images that are equal to the last one, itself included
  perception::ObjectSizes sizes;   ///< from the images so far
  GroundSlope slope;
  ParameterState parameters;
  template <class Archive>
  void serialize(Archive& archive) {
    archive(attitudes, line_colour, images, fingerprint, equal_images, sizes, slope, parameters);
  }
};

/// Processes each new image with the attitude that the head had when the image was exposed. Publishes nothing before
/// the first image and the first camera model. The line has the colour that a task named last; before that, the colour
/// of the configuration.
class Perception : public TunableComponent<PerceptionState, perception::PerceptionConfig> {
 public:
  Perception(Wiring& wiring, const Setup& setup);
  void step(const Tick& tick) override;

 private:
  /// Whether the camera repeats its image. The noise of any camera makes each image different.
  [[nodiscard]] bool frozen(const msg::CameraImage& image);
  [[nodiscard]] msg::Quaternion attitude_at(std::int64_t tick) const;

  perception::LineAndBlobDetector detector_;
  std::uint64_t seed_;  // of the errors that are added to percepts
  double head_height_m_ = 0.0;
  perception::HeadShape head_;
  Latest<msg::CameraImage> image_ = wiring_.latest(topics::kCameraImage);
  Latest<msg::CameraInfo> info_ = wiring_.latest(topics::kCameraInfo);
  Latest<msg::ImuState> imu_ = wiring_.latest(topics::kImuState);
  Latest<msg::TaskStatus> task_ = wiring_.latest(topics::kTaskStatus);
  Output<msg::LinePercept> line_ = wiring_.output(topics::kLinePercept);
  Output<msg::ObjectPercepts> objects_ = wiring_.output(topics::kObjectPercepts);
  Output<msg::CameraImage> processed_ = wiring_.output(topics::kProcessedImage);
};

/// Declares the component to the runtime.
ComponentFactory make_perception_factory();

}  // namespace constrictor
