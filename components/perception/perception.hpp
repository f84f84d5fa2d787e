// The component: images in, percepts and a processed picture out.
#pragma once

#include <cereal/types/array.hpp>
#include <cereal/types/deque.hpp>
#include <cereal/types/vector.hpp>
#include <cstdint>
#include <deque>
#include <optional>
#include <span>
#include <vector>

#include "component/component.hpp"
#include "component/parameters.hpp"
#include "component/robot_bounds.hpp"
#include "perception/line_and_blob_detector.hpp"
#include "perception/view_limits.hpp"
#include "robot/ground_slope.hpp"
#include "robot/planar.hpp"
#include "robot/robot_model.hpp"

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

/// Angles of the joints at a tick.
struct Posture {
  std::int64_t tick = 0;
  std::vector<double> angles_rad;
  template <class Archive>
  void serialize(Archive& archive) {
    archive(tick, angles_rad);
  }
};

/// Finds out whether a camera repeats its image.
struct ImageRepeats {
  std::uint64_t fingerprint = 0;  ///< of the last image
  int equal_images = 0;           ///< number of last images that are equal to the last one, itself included
  template <class Archive>
  void serialize(Archive& archive) {
    archive(fingerprint, equal_images);
  }
};

/// Decides which images of a camera are drawn: the first one, the first one after an event, and one whenever `period`
/// images have come since the last that was drawn.
struct PictureTurn {
  bool wanted = true;  ///< the next image is drawn, whatever the period
  int images = 0;      ///< since the last one that was drawn, that one included

  /// Whether the image that has come is drawn. To be called once for each.
  [[nodiscard]] bool take(int period) {
    const bool drawn = wanted || images >= period;
    wanted = false;
    images = drawn ? 1 : images + 1;
    return drawn;
  }
  template <class Archive>
  void serialize(Archive& archive) {
    archive(wanted, images);
  }
};

struct FurtherCamera {
  msg::CameraInfo info{};  ///< its width is 0 until it has arrived
  ImageRepeats repeats;
  PictureTurn turn;
  template <class Archive>
  void serialize(Archive& archive) {
    auto& p = info.X_HC.position_m;
    auto& q = info.X_HC.orientation;
    archive(info.module_index, info.width, info.height, info.fx, info.fy, info.cx, info.cy);
    archive(p.x, p.y, p.z, q.w, q.x, q.y, q.z, repeats, turn);
  }
};

struct PerceptionState {
  std::deque<Attitude> attitudes;   ///< of the last ticks, the oldest first
  std::uint8_t line_colour = 0;     ///< named by a task; 0: no task has named one
  std::uint64_t images = 0;         ///< number of processed images
  ImageRepeats repeats;             ///< of the head's camera
  PictureTurn turn;                 ///< of the head's camera
  perception::ObjectSizes sizes;    ///< from the images so far
  perception::GroundColour ground;  ///< from the images so far
  GroundSlope slope;
  ParameterState parameters;
  std::vector<FurtherCamera> further;  ///< one for each further camera of the robot
  std::deque<Posture> postures;        ///< of the last ticks, the oldest first
  template <class Archive>
  void serialize(Archive& archive) {
    archive(attitudes, line_colour, images, repeats, turn, sizes, ground, slope, parameters, further, postures);
  }
};

/// Processes each new image with the attitude that the head had when the image was exposed. Publishes nothing before
/// the first image and the first camera model. The line has the colour that a task named last; before that, the colour
/// of the configuration. The angles that the joints had at the exposure show which parts of the image are the robot's
/// own body. The images of further cameras are processed in the same way, and their percepts have topics of their own.
/// Only some images are drawn with their percepts (PictureTurn), because control does not need these pictures.
class Perception : public TunableComponent<PerceptionState, perception::PerceptionConfig>, public RobotJudge {
 public:
  Perception(Wiring& wiring, const Setup& setup);
  void step(const Tick& tick) override;
  [[nodiscard]] CheckVerdict judge_robot() const override { return perception::judge_view(robot_); }

 private:
  /// The topics of the percepts of an image.
  struct PerceptOutputs {
    Output<msg::LinePercept> line;
    Output<msg::ObjectPercepts> objects;
    Output<msg::CameraImage> processed;
  };
  /// The topics of a robot that has further cameras.
  struct Further {
    explicit Further(Wiring& wiring);
    Events<msg::CameraInfo> infos;
    Events<msg::CameraImage> images;
    PerceptOutputs percepts;
  };

  void remember_body(const Tick& tick);
  /// Whether the image can be used; counts a refusal otherwise.
  [[nodiscard]] bool accepted(const msg::CameraImage& image, const msg::CameraInfo& info, const char* topic,
                              ImageRepeats& repeats);
  [[nodiscard]] msg::Quaternion attitude_at(std::int64_t tick) const;
  [[nodiscard]] std::span<const double> angles_at(std::int64_t tick) const;
  /// After an event of a task, the next image of each camera is drawn.
  void follow_events();
  /// Writes the percepts of an image, and its picture if it is its turn. `X_GV`: frame V of the camera's view.
  void look(const Tick& tick, const msg::CameraImage& image, const perception::GroundCamera& camera,
            const PlanarPose& X_GV, PictureTurn& turn, const PerceptOutputs& outputs);
  /// Adds the errors of the configuration to the percepts of an image.
  void disturb(const Tick& tick, const msg::CameraImage& image, const perception::GroundCamera& camera,
               const PlanarPose& X_GV, perception::Percepts& percepts) const;
  void look_further(const Tick& tick);

  perception::LineAndBlobDetector detector_;
  std::uint64_t seed_;  // of the errors that are added to percepts
  RobotModel robot_;
  perception::HeadShape head_;
  Latest<msg::CameraImage> image_ = wiring_.latest(topics::kCameraImage);
  Latest<msg::CameraInfo> info_ = wiring_.latest(topics::kCameraInfo);
  Latest<msg::JointState> joints_ = wiring_.latest(topics::kJointState);
  Latest<msg::ImuState> imu_ = wiring_.latest(topics::kImuState);
  Latest<msg::TaskStatus> task_ = wiring_.latest(topics::kTaskStatus);
  Events<msg::TaskEvent> task_events_ = wiring_.events(topics::kTaskEvent);
  PerceptOutputs percepts_{wiring_.output(topics::kLinePercept), wiring_.output(topics::kObjectPercepts),
                           wiring_.output(topics::kProcessedImage)};
  std::optional<Further> further_;
};

/// Declares the component to the runtime.
ComponentFactory make_perception_factory();

}  // namespace constrictor
