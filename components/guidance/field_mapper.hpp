// Builds the map from percepts and touches, and corrects the pose by the landmarks and by the line.
#pragma once

#include <optional>

#include "constrictor/messages.hpp"
#include "guidance/existence.hpp"
#include "guidance/field_state.hpp"
#include "guidance/guidance_config.hpp"
#include "guidance/pose_filter.hpp"
#include "robot/kinematics.hpp"

namespace constrictor::guidance {

/// Poses of the modules in the head's frame, head to tail.
using BodyChain = std::vector<PlanarPose>;

/// Frame V of percepts in the head's present frame. `exposure`: the head at the exposure, in its present frame.
template <class Percepts>
[[nodiscard]] PlanarPose view_of(const Percepts& percepts, const PlanarPose& exposure) {
  if (percepts.camera == 0) return exposure;
  const msg::Pose2& X_GV = percepts.X_GV;
  return {to_parent(exposure, {X_GV.x_m, X_GV.y_m}), wrap_angle(exposure.yaw_rad + X_GV.yaw_rad)};
}

/// Works on a FieldState and a PoseFilter that the caller owns. `exposure` is the pose that the head had when the image
/// was exposed, in the head's present frame. With it, neither motion nor delay distorts the map. The percepts may be
/// those of any camera of the robot.
class FieldMapper {
 public:
  FieldMapper(FieldState& state, PoseFilter& filter, const RobotModel& model, const GuidanceConfig& config);

  /// A percept with a range updates its landmark, or creates one. A percept with the range NaN only refreshes the time
  /// at which its landmark was seen. In a full map a landmark that is not confirmed gives way to a new one.
  void objects(const msg::ObjectPercepts& percepts, const PlanarPose& exposure, std::int64_t tick);
  /// Whether there are as many landmarks as a map may have.
  [[nodiscard]] bool full() const;
  /// The first object or zone that was left out because the map is full of confirmed ones, since this mapper was made:
  /// with its place in M, and without a handle.
  [[nodiscard]] const std::optional<Landmark>& left_out() const { return left_out_; }
  /// To be called after objects(), with the same arguments: landmarks that the image shows become likelier; those that
  /// it should show and does not become less likely, and are forgotten in the end. `level`: the head is not tilted, so
  /// that the camera sees what it should. Returns the landmarks that were forgotten, with their last places.
  std::vector<Landmark> doubt(const msg::ObjectPercepts& percepts, const PlanarPose& exposure, const BodyChain& chain,
                              bool level, std::int64_t tick, double period_s);
  /// Maps the obstacles that the image shows, and forgets those that it should show and does not. The arguments are
  /// those of doubt().
  void obstacles(const msg::ObjectPercepts& percepts, const PlanarPose& exposure, const BodyChain& chain, bool level,
                 std::int64_t tick);
  /// Maps the points of the line and corrects the pose by points that are in the map already.
  void line(const msg::LinePercept& percept, const PlanarPose& exposure, std::int64_t tick, double period_s);
  /// Keeps contacts that belong neither to the ground nor to the robot itself, and marks the objects that they confirm.
  /// A contact where no object stands is with an obstacle, whose place the map keeps until the body passes through it.
  void touch(const msg::ContactState& contacts, const BodyChain& chain, std::int64_t tick, double period_s);
  /// For a robot that feels no contacts: an object beside which the body lies may have been pushed, as one that a touch
  /// reports. Whether there is such an object: what the robot pushes, its odometry does not know either.
  bool brush(const BodyChain& chain);
  /// Moves the carried object with the base of the U.
  void carry(const msg::TaskStatus& task, const BodyChain& chain, std::int64_t tick);

  void fill(msg::FieldMap& map) const;

 private:
  [[nodiscard]] Eigen::Vector2d position(const Landmark& landmark) const;
  [[nodiscard]] double sd(const Landmark& landmark) const;
  /// Updates, moves or creates the landmark of a blob with a range. `used` marks the landmarks that already have a blob
  /// in this image. `view`: frame V of the percepts in the head's present frame; `turn_rad`: yaw of V relative to the
  /// head at the time of the exposure.
  void place(const msg::Blob& blob, const PlanarPose& view, double turn_rad, std::int64_t tick,
             std::vector<bool>& used);
  /// [m] radius of the landmark that a blob at `z` (in the head's frame) may belong to.
  [[nodiscard]] double known_radius_m(const msg::Blob& blob, const Eigen::Vector2d& z) const;
  /// Averages the heights over the images. An image that cuts the top off gives a lower bound.
  void learn_height(const msg::Blob& blob, Landmark& landmark);
  /// Adds what the percept says of whether the landmark is an object or a zone.
  void learn_kind(const msg::Blob& blob, std::int64_t tick, Landmark& landmark);
  /// Refreshes the time at which the landmark was seen whose blob does not show where its centre is.
  void glimpse(const msg::Blob& blob, const PlanarPose& view, std::int64_t tick);
  void create(const msg::Blob& blob, const Eigen::Vector2d& z, const Eigen::Matrix2d& noise, std::int64_t tick,
              std::vector<bool>& used);
  /// Whether the map has room for one more landmark. If it is full, the unconfirmed landmark that was not seen for the
  /// longest time is forgotten; of several, the one with the fewest percepts. One that this image shows stays.
  [[nodiscard]] bool make_room(std::int64_t tick, std::vector<bool>& used);
  /// Whether a new landmark may take this one's place in a full map: it is neither confirmed nor carried.
  [[nodiscard]] bool may_give_way(const Landmark& landmark) const {
    return landmark.hits < config_.confirm && !landmark.carried;
  }
  void forget(std::size_t index);
  /// Whether the landmark so likely exists, and stands where it was seen, that it may correct the pose.
  [[nodiscard]] bool trusted(const Landmark& landmark) const;
  /// Takes a landmark that has moved to the place of the percept, without an effect on the pose.
  void replace(Landmark& landmark, const Eigen::Vector2d& z, const Eigen::Matrix2d& noise, std::int64_t tick);
  /// Takes the landmark out of the pose filter and keeps its place and standard deviation in the landmark itself.
  void release_slot(Landmark& landmark);
  /// [m] radius of an object, or of a zone, whose width no image has shown.
  [[nodiscard]] double usual_radius_m(std::uint8_t kind) const {
    return kind == msg::kBlobZone ? config_.zone_radius_m : config_.object_radius_m;
  }
  /// [m] of the landmark, or the usual one if no image has shown its width.
  [[nodiscard]] double radius_of(const Landmark& landmark) const {
    return landmark.radius_m > 0.0 ? landmark.radius_m : usual_radius_m(landmark.kind);
  }
  /// Whether the axis of a module is nearer than `distance_m` to a point in the head's frame.
  [[nodiscard]] bool is_near_body(const BodyChain& chain, const Eigen::Vector2d& p, double distance_m) const;
  /// True if the point `p` (in the head's frame) lies on the robot's own body, apart from `module` and its neighbours.
  [[nodiscard]] bool is_self(const BodyChain& chain, std::size_t module, const Eigen::Vector2d& p) const;
  /// The view of these percepts with the modules that may hide something in it. None if the robot has no such camera.
  [[nodiscard]] std::optional<View> view_with_body(const msg::ObjectPercepts& percepts, const PlanarPose& X_HV,
                                                   const BodyChain& chain) const;
  /// Something has touched the object, and may have pushed it: its place becomes less certain, and the next percept
  /// must correct the landmark, not the robot's pose.
  void expect_push(Landmark& landmark);
  /// Whether enough images showed the obstacle, or a touch did.
  [[nodiscard]] bool believed(const Obstacle& obstacle) const;
  /// The obstacle that a point at `p_M` shows, which was seen along the unit vector `sight` with this standard
  /// deviation; null: a new one.
  [[nodiscard]] Obstacle* obstacle_at(const Eigen::Vector2d& p_M, const Eigen::Vector2d& sight, double sd_m);
  /// Whether a point in the head's frame lies on the body, or on an object of the map.
  [[nodiscard]] bool is_no_obstacle(const Eigen::Vector2d& p, const BodyChain& chain) const;
  /// Forgets obstacles that the images should show and do not.
  void doubt_obstacles(const msg::ObjectPercepts& percepts, const PlanarPose& X_HV, const BodyChain& chain, bool level,
                       std::int64_t tick);
  void add_obstacle(const Obstacle& obstacle);
  /// Stores the place of a touched obstacle in M, unless there is one already.
  void feel_obstacle(const Eigen::Vector2d& p_M);
  /// Forgets obstacles where the body is now.
  void clear_obstacles(const BodyChain& chain);
  /// [m] position of the centre of an object of this radius that lies in the base of the U, in the head's frame.
  [[nodiscard]] Eigen::Vector2d base_of_u(const BodyChain& chain, double radius_m) const;

  FieldState& state_;
  PoseFilter& filter_;
  const RobotModel& model_;
  const GuidanceConfig& config_;
  std::optional<Landmark> left_out_;
};

}  // namespace constrictor::guidance
