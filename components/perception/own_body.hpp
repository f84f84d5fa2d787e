// What a further camera sees of the robot's own body.
#pragma once

#include <Eigen/Geometry>
#include <vector>

namespace constrictor::perception {

/// The modules of the robot as capsules, in the frame C of a camera (z along the view).
class OwnBody {
 public:
  OwnBody() = default;
  /// `X_CM`: poses of the modules; a capsule's straight part reaches `half_length_m` along x to both sides.
  OwnBody(const std::vector<Eigen::Isometry3d>& X_CM, double half_length_m, double radius_m);

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

}  // namespace constrictor::perception
