#include "camera_setup/mount.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <opencv2/calib3d.hpp>
#include <opencv2/imgproc.hpp>
#include <stdexcept>

#include "video/rectifier.hpp"

namespace constrictor::camera_setup {

std::optional<Corners> find_board_on_ground(const cv::Mat& bgr, const Board& board, const BoardOnGround& place,
                                            const video::CameraCalibration& lens, double head_height_m,
                                            const Eigen::Isometry3d& expected) {
  constexpr double kPixelsForSquare = 40.0;
  constexpr int kAround = 3;  // squares: the mount is not exactly as expected
  const double scale_m = board.square_m / kPixelsForSquare;
  const int edge = static_cast<int>(kPixelsForSquare) * (std::max(board.columns, board.rows) + 1 + 2 * kAround);
  video::CameraCalibration straight = lens;
  straight.distortion.clear();
  const Eigen::Isometry3d X_CH = expected.inverse();
  // The place in the picture of a place in the view from above; whole numbers at the centres of pixels.
  const auto seen_at = [&](double column, double row) -> cv::Point2f {
    const Eigen::Vector2d aside = Eigen::Rotation2Dd(place.yaw_rad) *
                                  Eigen::Vector2d((0.5 * edge - row) * scale_m, (0.5 * edge - column) * scale_m);
    const Eigen::Vector3d p_C = X_CH * Eigen::Vector3d(place.x_m + aside.x(), place.y_m + aside.y(), -head_height_m);
    if (p_C.z() < 1e-3) return {-1.0F, -1.0F};
    const Eigen::Vector2d at = video::distorted(
        lens, straight, {lens.fx * p_C.x() / p_C.z() + lens.cx, lens.fy * p_C.y() / p_C.z() + lens.cy});
    return {static_cast<float>(at.x() - 0.5), static_cast<float>(at.y() - 0.5)};
  };
  cv::Mat map(edge, edge, CV_32FC2), above;
  for (int row = 0; row < edge; ++row) {
    for (int column = 0; column < edge; ++column) map.at<cv::Point2f>(row, column) = seen_at(column, row);
  }
  cv::remap(bgr, above, map, {}, cv::INTER_CUBIC, cv::BORDER_CONSTANT, cv::Scalar::all(128));
  auto corners = find_board(above, board);
  if (!corners) return find_board(bgr, board);
  for (auto& corner : *corners) corner = seen_at(corner.x, corner.y);
  refine(bgr, board, *corners);
  return corners;
}

MountResult find_mount(const Corners& corners, const Board& board, const BoardOnGround& place,
                       const video::CameraCalibration& lens, double head_height_m, const Eigen::Isometry3d& expected) {
  const cv::Mat matrix = (cv::Mat_<double>(3, 3) << lens.fx, 0, lens.cx - 0.5, 0, lens.fy, lens.cy - 0.5, 0, 0, 1);
  const cv::Mat distortion(lens.distortion, true);
  // The corners around the middle of the board: then a turn of the board is a turn about its origin.
  auto points = board.corners();
  const cv::Point3f middle = 0.5F * (points.front() + points.back());
  for (auto& point : points) point -= middle;
  cv::Mat rotation, translation;
  if (!cv::solvePnP(points, corners, matrix, distortion, rotation, translation, false, cv::SOLVEPNP_IPPE))
    throw std::invalid_argument("no pose of the board fits the picture: check --board, --square and --calibration");
  cv::solvePnPRefineLM(points, corners, matrix, distortion, rotation, translation);
  Corners seen;
  cv::projectPoints(points, rotation, translation, matrix, distortion, seen);
  cv::Mat R;
  cv::Rodrigues(rotation, R);
  Eigen::Isometry3d X_CB = Eigen::Isometry3d::Identity();
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) X_CB.linear()(i, j) = R.at<double>(i, j);
    X_CB.translation()(i) = translation.at<double>(i);
  }
  Eigen::Isometry3d X_HG = Eigen::Isometry3d::Identity();
  X_HG.translation().z() = -head_height_m;
  MountResult best;
  double least = std::numeric_limits<double>::infinity();
  // Rows of the board run along -y of G, and its columns towards the robot, if it is seen upright; z is down. It may be
  // turned by half a turn, and its corners may be found in the mirrored order of the other side.
  for (const double turn : {0.0, std::numbers::pi}) {
    for (const double side : {1.0, -1.0}) {
      Eigen::Matrix3d upright;
      upright.col(0) = Eigen::Vector3d(0.0, -1.0, 0.0);
      upright.col(1) = Eigen::Vector3d(-side, 0.0, 0.0);
      upright.col(2) = upright.col(0).cross(upright.col(1));
      Eigen::Isometry3d X_GB = Eigen::Isometry3d::Identity();
      X_GB.linear() = Eigen::AngleAxisd(place.yaw_rad + turn, Eigen::Vector3d::UnitZ()).toRotationMatrix() * upright;
      X_GB.translation() = Eigen::Vector3d(place.x_m, place.y_m, 0.0);
      const Eigen::Isometry3d X_HC = X_HG * X_GB * X_CB.inverse();
      const double angle = Eigen::AngleAxisd(expected.linear().transpose() * X_HC.linear()).angle();
      if (angle >= least) continue;
      least = angle;
      best.X_HC = X_HC;
    }
  }
  best.error_px = cv::norm(seen, corners, cv::NORM_L2) / std::sqrt(static_cast<double>(seen.size()));
  return best;
}

std::string doubt_of_mount(const Eigen::Isometry3d& X_HC, const Eigen::Isometry3d& expected) {
  constexpr const char* kCauses =
      "is --square the edge of one square in metres, are the numbers of --board in the right order (the rows lie "
      "across "
      "the robot), and is --at measured from the centre of the head?";
  const double away_m = X_HC.translation().norm();
  if (!(away_m <= kFarthestFromHead_m))
    return fmt::format("found a camera {:.3f} m from the centre of the head, accepted at most {:g} m: {}", away_m,
                       kFarthestFromHead_m, kCauses);
  const double moved_m = (X_HC.translation() - expected.translation()).norm();
  const double turned_deg =
      Eigen::AngleAxisd(expected.linear().transpose() * X_HC.linear()).angle() * 180.0 / std::numbers::pi;
  if (!(moved_m <= kLargestMove_m) || !(turned_deg <= kLargestTurn_deg))
    return fmt::format(
        "found a mount {:.3f} m and {:.1f} degrees from that of the robot file, accepted at most {:g} m and {:g} "
        "degrees: {}",
        moved_m, turned_deg, kLargestMove_m, kLargestTurn_deg, kCauses);
  return {};
}

}  // namespace constrictor::camera_setup
