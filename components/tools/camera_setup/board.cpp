#include "camera_setup/board.hpp"

#include <algorithm>
#include <cmath>
#include <opencv2/calib3d.hpp>
#include <opencv2/imgproc.hpp>

namespace constrictor::camera_setup {
namespace {

/// [pixel] the least distance between neighbouring corners.
double least_spacing(const Corners& corners, const Board& board) {
  double least = 1e9;
  for (int row = 0; row < board.rows; ++row) {
    for (int column = 0; column < board.columns; ++column) {
      const auto at = static_cast<std::size_t>(row * board.columns + column);
      if (column > 0) least = std::min(least, cv::norm(corners[at] - corners[at - 1]));
      if (row > 0)
        least = std::min(least, cv::norm(corners[at] - corners[at - static_cast<std::size_t>(board.columns)]));
    }
  }
  return least;
}

}  // namespace

std::vector<cv::Point3f> Board::corners() const {
  std::vector<cv::Point3f> found;
  for (int row = 0; row < rows; ++row) {
    for (int column = 0; column < columns; ++column)
      found.emplace_back(static_cast<float>(column * square_m), static_cast<float>(row * square_m), 0.0F);
  }
  return found;
}

void refine(const cv::Mat& bgr, const Board& board, Corners& corners) {
  cv::Mat grey;
  cv::cvtColor(bgr, grey, cv::COLOR_BGR2GRAY);
  const int half = std::clamp(static_cast<int>(0.4 * least_spacing(corners, board)), 1, 8);
  cv::cornerSubPix(grey, corners, {half, half}, {-1, -1}, {cv::TermCriteria::COUNT | cv::TermCriteria::EPS, 50, 0.005});
}

std::optional<Corners> find_board(const cv::Mat& bgr, const Board& board) {
  cv::Mat grey;
  cv::cvtColor(bgr, grey, cv::COLOR_BGR2GRAY);
  const cv::Size size(board.columns, board.rows);
  Corners corners;
  if (cv::findChessboardCorners(grey, size, corners, cv::CALIB_CB_NORMALIZE_IMAGE | cv::CALIB_CB_ADAPTIVE_THRESH)) {
    refine(bgr, board, corners);
    return corners;
  }
  // It finds boards that the first method misses, and the reverse: A. Duda, U. Frese, "Accurate Detection and
  // Localization of Checkerboard Corners for Calibration", BMVC 2018.
  const bool found = cv::findChessboardCornersSB(
      grey, size, corners, cv::CALIB_CB_NORMALIZE_IMAGE | cv::CALIB_CB_ACCURACY | cv::CALIB_CB_EXHAUSTIVE);
  if (!found || static_cast<int>(corners.size()) != board.corner_count()) return {};
  return corners;
}

double largest_motion(const Corners& a, const Corners& b) {
  double most = 0.0;
  for (std::size_t i = 0; i < std::min(a.size(), b.size()); ++i)
    most = std::max(most, static_cast<double>(std::hypot(a[i].x - b[i].x, a[i].y - b[i].y)));
  return most;
}

Pose2 pose_in_picture(const Corners& corners, const Board& board, cv::Size picture) {
  const auto at = [&](int row, int column) -> cv::Point2d {
    return corners[static_cast<std::size_t>(row * board.columns + column)];
  };
  const cv::Point2d a = at(0, 0), b = at(0, board.columns - 1), c = at(board.rows - 1, board.columns - 1),
                    d = at(board.rows - 1, 0);
  const cv::Point2d p = c - a, q = d - b;
  const double area = 0.5 * std::abs(p.x * q.y - p.y * q.x);
  const cv::Point2d middle = 0.25 * (a + b + c + d);
  // A board that is slanted has opposite edges of different length.
  const auto ratio = [](double one, double other) { return std::abs(one - other) / std::max({one, other, 1e-9}); };
  return {middle.x / picture.width, middle.y / picture.height, std::sqrt(area / picture.area()),
          2.0 * std::max(ratio(cv::norm(a - b), cv::norm(d - c)), ratio(cv::norm(a - d), cv::norm(b - c)))};
}

double difference(const Pose2& a, const Pose2& b) {
  return std::abs(a.x - b.x) + std::abs(a.y - b.y) + std::abs(a.size - b.size) + std::abs(a.slant - b.slant);
}

}  // namespace constrictor::camera_setup
