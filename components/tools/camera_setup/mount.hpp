// Finds the pose of the camera in the head from one view of a board that lies on the ground.
#pragma once

#include <Eigen/Geometry>
#include <optional>
#include <string>

#include "camera_setup/board.hpp"
#include "video/calibration.hpp"

namespace constrictor::camera_setup {

/// The place of the board in the frame G: origin on the ground below the head's centre, x forward, y left.
struct BoardOnGround {
  double x_m = 0.5, y_m = 0.0;  ///< middle of the inner corners
  double yaw_rad = 0.0;         ///< 0: its rows lie across the robot (along y)
};

/// A board on the ground, which the camera sees from the side: it is looked for as it looks from above, by the
/// `expected` mount. Empty if the board is not, or not wholly, in the picture.
[[nodiscard]] std::optional<Corners> find_board_on_ground(const cv::Mat& bgr, const Board& board,
                                                          const BoardOnGround& place,
                                                          const video::CameraCalibration& lens, double head_height_m,
                                                          const Eigen::Isometry3d& expected);

struct MountResult {
  Eigen::Isometry3d X_HC = Eigen::Isometry3d::Identity();
  double error_px = 0.0;  ///< root mean square of the corners
};

/// The head is level and lies on the ground: its centre is `head_height_m` above it. A chessboard looks the same when
/// it is turned; the result is the one that is nearest to `expected` (the mount of the robot file). Throws
/// std::invalid_argument if no pose fits.
[[nodiscard]] MountResult find_mount(const Corners& corners, const Board& board, const BoardOnGround& place,
                                     const video::CameraCalibration& lens, double head_height_m,
                                     const Eigen::Isometry3d& expected);

inline constexpr double kFarthestFromHead_m = 0.3;
inline constexpr double kLargestMove_m = 0.1;
inline constexpr double kLargestTurn_deg = 30.0;

/// Why this mount is hardly that of the camera: it is far from the head's centre, or differs much from the `expected`
/// mount. Empty: it is plausible. A wrong size of the squares or a wrong order of the board's numbers fits the picture
/// as well as the right one, so that the pixel error does not show it.
[[nodiscard]] std::string doubt_of_mount(const Eigen::Isometry3d& X_HC, const Eigen::Isometry3d& expected);

}  // namespace constrictor::camera_setup
