#include "video/calibration.hpp"

#include <fmt/format.h>

#include <cmath>
#include <stdexcept>

#include "configuration/configuration.hpp"
#include "robot/camera_mount.hpp"

namespace constrictor::video {
namespace {

constexpr double kSameProportions = 0.01;

Eigen::Isometry3d read_mount(Configuration& mount) {
  const auto p = mount.numbers("position_m", {-1.0, 1.0}, 3, 3);
  const auto q = mount.numbers("orientation_wxyz", {-1.0, 1.0}, 4, 4);
  Eigen::Quaterniond rotation(q[0], q[1], q[2], q[3]);
  if (std::abs(rotation.norm() - 1.0) > 1e-3)
    throw mount.error("orientation_wxyz", fmt::format("found a quaternion of length {:.4f}, accepted 1: w x y z rotate "
                                                      "vectors of the camera into the head",
                                                      rotation.norm()));
  Eigen::Isometry3d X_HC = Eigen::Isometry3d::Identity();
  X_HC.linear() = rotation.normalized().toRotationMatrix();
  X_HC.translation() = Eigen::Vector3d(p[0], p[1], p[2]);
  return X_HC;
}

}  // namespace

CameraCalibration CameraCalibration::scaled_to(int new_width, int new_height) const {
  const double sx = static_cast<double>(new_width) / width;
  const double sy = static_cast<double>(new_height) / height;
  if (std::abs(sx / sy - 1.0) > kSameProportions)
    throw std::invalid_argument(
        fmt::format("found images of {} x {} pixels, accepted the proportions of {} x {}, for "
                    "which the camera is calibrated",
                    new_width, new_height, width, height));
  CameraCalibration scaled = *this;
  scaled.width = new_width;
  scaled.height = new_height;
  scaled.fx *= sx;
  scaled.cx *= sx;
  scaled.fy *= sy;
  scaled.cy *= sy;
  return scaled;
}

CameraCalibration calibration_of(const CameraModel& camera) {
  CameraCalibration calibration;
  calibration.width = camera.width;
  calibration.height = camera.height;
  calibration.fx = calibration.fy = camera.width / (2.0 * std::tan(camera.horizontal_fov_rad / 2.0));
  calibration.cx = camera.width / 2.0;
  calibration.cy = camera.height / 2.0;
  calibration.X_HC = camera_mount(camera);
  return calibration;
}

CameraCalibration load_calibration(const std::filesystem::path& file, const CameraModel& camera) {
  Configuration root = Configuration::load(file);
  CameraCalibration calibration;
  Configuration image = root.section("image");
  calibration.width = static_cast<int>(image.integer("width", 16, 4096));
  calibration.height = static_cast<int>(image.integer("height", 16, 4096));
  image.finish();
  Configuration lens = root.section("lens");
  calibration.fx = lens.number("fx", {1.0, 1e5});
  calibration.fy = lens.number("fy", {1.0, 1e5});
  calibration.cx = lens.number("cx", {0.0, 4096.0});
  calibration.cy = lens.number("cy", {0.0, 4096.0});
  calibration.distortion = lens.numbers("distortion", {-100.0, 100.0}, 0, 8, std::vector<double>{});
  const std::size_t count = calibration.distortion.size();
  if (count != 0 && count != 4 && count != 5 && count != 8)
    throw lens.error("distortion",
                     fmt::format("found {} numbers, accepted 0, 4, 5 or 8: k1 k2 p1 p2 k3 k4 k5 k6", count));
  if (lens.has("reprojection_error_px"))
    calibration.reprojection_error_px = lens.number("reprojection_error_px", {0.0, 1000.0});
  lens.finish();
  if (root.has("mount")) {
    Configuration mount = root.section("mount");
    calibration.X_HC = read_mount(mount);
    mount.finish();
  } else {
    calibration.X_HC = camera_mount(camera);
  }
  root.finish();
  return calibration;
}

std::string calibration_text(const CameraCalibration& c, bool mounted, const std::string& made_by) {
  const Eigen::Quaterniond q(c.X_HC.linear());
  const Eigen::Vector3d& p = c.X_HC.translation();
  std::string text = fmt::format("# Calibration of a camera, made by {}.\n", made_by);
  text += fmt::format("image: {{width: {}, height: {}}}   # [pixel]\n", c.width, c.height);
  text += "lens:                             # [pixel] pixel centres lie at +0.5, the origin is the top left corner\n";
  text += fmt::format("  fx: {:.4f}\n  fy: {:.4f}\n  cx: {:.4f}\n  cy: {:.4f}\n", c.fx, c.fy, c.cx, c.cy);
  text += fmt::format("  distortion: [{:.8g}]   # k1 k2 p1 p2 k3 k4 k5 k6\n", fmt::join(c.distortion, ", "));
  if (c.reprojection_error_px) text += fmt::format("  reprojection_error_px: {:.4f}\n", *c.reprojection_error_px);
  if (!mounted) return text;
  text += "mount:                            # X_HC: camera (z along the view, x right, y down) in the head\n";
  text += fmt::format("  position_m: [{:.5f}, {:.5f}, {:.5f}]\n", p.x(), p.y(), p.z());
  text += fmt::format("  orientation_wxyz: [{:.7f}, {:.7f}, {:.7f}, {:.7f}]\n", q.w(), q.x(), q.y(), q.z());
  return text;
}

}  // namespace constrictor::video
