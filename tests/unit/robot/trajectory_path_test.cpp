// The path of a trajectory, compared with arcs that are integrated in small steps.
#include "robot/trajectory_path.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <vector>

namespace constrictor {
namespace {

struct Piece {
  double length_m, curvature_1_m;
};

/// A path of such pieces that begins at `start`, with points by integration in steps of 0.1 mm.
msg::DesiredTrajectory path_of(const PlanarPose& start, const std::vector<Piece>& pieces) {
  msg::DesiredTrajectory desired{};
  PlanarPose at = start;
  double arc_m = 0.0;
  for (const Piece& piece : pieces) {
    desired.points[desired.point_count++] = {arc_m, at.p.x(), at.p.y(), at.yaw_rad, piece.curvature_1_m};
    constexpr double kStep_m = 1e-4;
    for (int i = 0; i < std::lround(piece.length_m / kStep_m); ++i) {
      at.p += kStep_m * along(at.yaw_rad + 0.5 * kStep_m * piece.curvature_1_m);
      at.yaw_rad += kStep_m * piece.curvature_1_m;
    }
    arc_m += piece.length_m;
  }
  return desired;
}

TEST(TrajectoryPath, PiecesOfArcsMeet) {
  const std::vector<Piece> pieces = {{0.3, 1.5}, {0.4, 0.0}, {0.25, -2.0}, {0.5, 0.7}};
  const msg::DesiredTrajectory desired = path_of({{0.1, -0.2}, 0.4}, pieces);
  ASSERT_TRUE(has_valid_path(desired));
  for (std::size_t i = 1; i < pieces.size(); ++i) {
    const PlanarPose before = pose_at(desired, desired.points[i].arc_m - 1e-9);
    const PlanarPose after = pose_at(desired, desired.points[i].arc_m);
    EXPECT_LT((before.p - after.p).norm(), 1e-6);
    EXPECT_NEAR(before.yaw_rad, after.yaw_rad, 1e-6);
  }
}

TEST(TrajectoryPath, TheCurvatureToAPointOfAnArcIsThatOfTheArc) {
  for (const double curvature_1_m : {-2.3, -0.5, 0.0, 1e-7, 0.8, 2.3}) {
    msg::DesiredTrajectory desired{};
    set_arc(curvature_1_m, desired);
    for (const double ahead_m : {0.05, 0.35, 1.0})
      EXPECT_NEAR(pursuit_curvature_1_m(desired, ahead_m), curvature_1_m, 1e-9) << ahead_m;
  }
  EXPECT_EQ(pursuit_curvature_1_m(msg::DesiredTrajectory{}, 0.35), 0.0) << "no path: straight ahead";
}

// A point that moves along the arc to the point ahead comes back to the path and stays there.
TEST(TrajectoryPath, PursuitLeadsBackToThePath) {
  PlanarPose at{{0.0, 0.2}, 0.3};
  for (int i = 0; i < 3000; ++i) {
    msg::DesiredTrajectory desired{};  // the x axis of the world, seen from the point
    desired.point_count = 1;
    const Eigen::Vector2d beside = at.to_local({at.p.x(), 0.0});
    desired.points[0] = {0.0, beside.x(), beside.y(), -at.yaw_rad, 0.0};
    constexpr double kStep_m = 1e-3;
    at.yaw_rad += kStep_m * pursuit_curvature_1_m(desired, 0.35);
    at.p += kStep_m * at.forward();
  }
  EXPECT_NEAR(at.p.y(), 0.0, 1e-3);
  EXPECT_NEAR(at.yaw_rad, 0.0, 1e-3);
  EXPECT_GT(at.p.x(), 2.5);
}

TEST(TrajectoryPath, RefusesWhatIsNoPath) {
  msg::DesiredTrajectory desired = path_of({}, {{0.3, 0.0}, {0.3, 1.0}});
  EXPECT_TRUE(has_valid_path(desired));
  desired.points[1].arc_m = 0.0;
  EXPECT_FALSE(has_valid_path(desired)) << "the arc lengths do not rise";
  desired.points[1].arc_m = 0.3;
  desired.points[1].heading_rad = std::numeric_limits<double>::quiet_NaN();
  EXPECT_FALSE(has_valid_path(desired));
  desired.point_count = 1;
  EXPECT_TRUE(has_valid_path(desired)) << "what lies beyond the count does not matter";
  desired.point_count = msg::kMaxTrajectoryPoints + 1;
  EXPECT_FALSE(has_valid_path(desired));
}

}  // namespace
}  // namespace constrictor
