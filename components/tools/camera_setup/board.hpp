// A chessboard that a camera sees.
#pragma once

#include <opencv2/core.hpp>
#include <optional>
#include <vector>

namespace constrictor::camera_setup {

/// `columns` x `rows` inner corners, at which four squares meet.
struct Board {
  int columns = 9;
  int rows = 6;
  double square_m = 0.025;  ///< edge of a square

  [[nodiscard]] int corner_count() const { return columns * rows; }
  /// [m] the inner corners in the board's own frame: row by row, x along a row, y along the columns, z = 0.
  [[nodiscard]] std::vector<cv::Point3f> corners() const;
};

/// [pixel] places of the inner corners, row by row, with whole numbers at the centres of pixels (as OpenCV has them).
using Corners = std::vector<cv::Point2f>;

/// Empty if the board is not, or not wholly, in the picture.
[[nodiscard]] std::optional<Corners> find_board(const cv::Mat& bgr, const Board& board);

/// Moves corners that are known roughly to their exact places.
void refine(const cv::Mat& bgr, const Board& board, Corners& corners);

/// [pixel] the largest distance between corresponding corners.
[[nodiscard]] double largest_motion(const Corners& a, const Corners& b);

/// The place of a board in the picture, each value from 0 to about 1.
struct Pose2 {
  double x = 0.0, y = 0.0, size = 0.0, slant = 0.0;
};
[[nodiscard]] Pose2 pose_in_picture(const Corners& corners, const Board& board, cv::Size picture);
/// Sum of the differences.
[[nodiscard]] double difference(const Pose2& a, const Pose2& b);

}  // namespace constrictor::camera_setup
