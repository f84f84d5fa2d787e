#include "perception/further_view.hpp"

#include <algorithm>
#include <cmath>

#include "robot/kinematics.hpp"
#include "robot/rotation.hpp"

namespace constrictor::perception {
namespace {

constexpr double kLevel = 0.1;  // a view with a smaller horizontal share looks straight down or up

/// The horizontal direction of a view; of one that looks straight down: that of the image's upper border.
double heading_of(const Eigen::Matrix3d& R_GC) {
  const Eigen::Vector3d view = R_GC.col(2);
  const Eigen::Vector3d ahead = view.head<2>().norm() > kLevel ? view : Eigen::Vector3d(-R_GC.col(1));
  return std::atan2(ahead.y(), ahead.x());
}

}  // namespace

FurtherView further_view(const msg::CameraInfo& info, const RobotModel& robot, const msg::Quaternion& attitude,
                         std::span<const double> angles_rad) {
  const Eigen::Matrix3d R_WH = rotation_from(attitude);
  Eigen::Isometry3d X_GH = Eigen::Isometry3d::Identity();
  X_GH.linear() = Eigen::AngleAxisd(-std::atan2(R_WH(1, 0), R_WH(0, 0)), Eigen::Vector3d::UnitZ()) * R_WH;
  X_GH.translation().z() = robot.module_radius_m;
  std::vector<Eigen::Isometry3d> modules = module_poses(robot, angles_rad, X_GH);

  Eigen::Isometry3d X_MC = Eigen::Isometry3d::Identity();
  X_MC.linear() = rotation_from(info.X_HC.orientation);
  const auto& p = info.X_HC.position_m;
  X_MC.translation() = Eigen::Vector3d(p.x, p.y, p.z);
  const Eigen::Isometry3d X_GC = modules[std::min<std::size_t>(info.module_index, modules.size() - 1)] * X_MC;

  const PlanarPose view{X_GC.translation().head<2>(), heading_of(X_GC.linear())};
  Eigen::Isometry3d X_GV = Eigen::Isometry3d::Identity();
  X_GV.linear() = Eigen::AngleAxisd(view.yaw_rad, Eigen::Vector3d::UnitZ()).toRotationMatrix();
  X_GV.translation().head<2>() = view.p;

  const Eigen::Isometry3d X_CG = X_GC.inverse();
  for (Eigen::Isometry3d& module : modules) module = X_CG * module;
  return {view, GroundCamera(info, X_GV.inverse() * X_GC,
                             OwnBody(modules, 0.5 * robot.module_length_m, robot.module_radius_m))};
}

}  // namespace constrictor::perception
