// What a camera sees of the robot's own body.
#pragma once

#include <Eigen/Geometry>
#include <numbers>
#include <span>
#include <vector>

#include "constrictor/messages.hpp"
#include "robot/robot_model.hpp"

namespace constrictor::perception {

/// The modules of the robot as capsules, in the frame C of a camera (z along the view).
class OwnBody {
 public:
  OwnBody() = default;
  /// `X_CM`: poses of the modules; a capsule's straight part reaches `half_length_m` along x to both sides. Modules
  /// that lie farther from the camera's axis than the angle `view_rad` are left out.
  OwnBody(const std::vector<Eigen::Isometry3d>& X_CM, double half_length_m, double radius_m,
          double view_rad = std::numbers::pi);

  [[nodiscard]] bool empty() const { return modules_.empty(); }
  /// Whether a ray from the camera meets a module, or comes nearer to it than the angle `margin_rad`, as seen from the
  /// camera. The ray need not be normalised.
  [[nodiscard]] bool covers(const Eigen::Vector3d& ray_C, double margin_rad) const;

 private:
  struct Module {
    Eigen::Vector3d front, back;  ///< [m] ends of the straight part
    Eigen::Vector3d direction;    ///< unit vector to the middle
    double half_rad;              ///< half of the angle of a cone that contains the module; pi: it is too near
  };
  std::vector<Module> modules_;
  double reach_m_ = 0.0;
};

/// The modules behind the head that the head's camera may show, with these angles of the joints. Without angles: none.
[[nodiscard]] OwnBody body_before_head(const msg::CameraInfo& info, const RobotModel& robot,
                                       std::span<const double> angles_rad);

}  // namespace constrictor::perception
