// The slope of the ground on which the robot lies, from the attitude of its head.
#pragma once

#include <Eigen/Core>

#include "constrictor/messages.hpp"

namespace constrictor {

/// The inertial unit measures the attitude of the head relative to gravity; what the camera sees depends on the
/// attitude relative to the ground, and gravity pulls the body downhill. The robot lies on its belly, so that the mean
/// direction of the head's z axis is the normal of the ground, however the head turns and rocks. Serialisable.
class GroundSlope {
 public:
  /// A new attitude: unit quaternion from the head to the level frame of the inertial unit. `share`: period of the
  /// attitudes as a share of the time constant of the mean, 0 to 1; the first ones form a plain mean. Attitudes that
  /// incline the head by more than kLying_rad do not count: it does not lie on the ground.
  void learn(const msg::Quaternion& attitude, double share);

  /// [rad] Angle between the normal of the ground and the vertical; 0 before the first attitude.
  [[nodiscard]] double angle_rad() const;

  /// The attitude relative to the ground. Ground that is inclined by less than `level_rad` counts as level, and the
  /// attitude stays as it is; a slope counts as one until its angle is less than two thirds of `level_rad`, so that
  /// the result does not go to and fro.
  [[nodiscard]] msg::Quaternion relative_to_ground(const msg::Quaternion& attitude, double level_rad);

  /// The part of gravity along the ground, as a share of it, in the level frame: it points downhill, and its length is
  /// the sine of the slope. Zero on ground that counts as level, in the same sense as above.
  [[nodiscard]] Eigen::Vector2d downhill(double level_rad);

  static constexpr double kLying_rad = 0.35;

  template <class Archive>
  void serialize(Archive& archive) {
    archive(x_, y_, count_, inclined_);
  }

 private:
  /// Whether the ground counts as a slope.
  bool inclined(double level_rad);

  double x_ = 0.0, y_ = 0.0;  // of the normal, in the level frame
  double count_ = 0.0;        // of attitudes
  bool inclined_ = false;
};

}  // namespace constrictor
