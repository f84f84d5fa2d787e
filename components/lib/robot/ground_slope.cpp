#include "robot/ground_slope.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "robot/rotation.hpp"

namespace constrictor {

void GroundSlope::learn(const msg::Quaternion& attitude, double share) {
  const Eigen::Vector3d up = rotation_from(attitude).col(2);
  if (up.z() < std::cos(kLying_rad)) return;
  count_ += 1.0;
  const double gain = std::max(1.0 / count_, std::min(share, 1.0));
  x_ += gain * (up.x() - x_);
  y_ += gain * (up.y() - y_);
}

double GroundSlope::angle_rad() const { return std::asin(std::min(1.0, std::hypot(x_, y_))); }

bool GroundSlope::inclined(double level_rad) {
  inclined_ = angle_rad() > (inclined_ ? level_rad * 2.0 / 3.0 : level_rad);
  return inclined_;
}

Eigen::Vector2d GroundSlope::downhill(double level_rad) {
  if (!inclined(level_rad)) return Eigen::Vector2d::Zero();
  return {x_, y_};
}

msg::Quaternion GroundSlope::relative_to_ground(const msg::Quaternion& attitude, double level_rad) {
  if (!inclined(level_rad)) return attitude;
  const Eigen::Vector3d normal(x_, y_, std::sqrt(std::max(0.0, 1.0 - x_ * x_ - y_ * y_)));
  const Eigen::Quaterniond turned = shortest_rotation(normal, Eigen::Vector3d::UnitZ()) *
                                    Eigen::Quaterniond(attitude.w, attitude.x, attitude.y, attitude.z);
  return {turned.w(), turned.x(), turned.y(), turned.z()};
}

}  // namespace constrictor
