// The lateral place of a body in a U that passes between obstacles, compared with the gaps that are left on both sides.
#include "navigation/carrying_room.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "component/random.hpp"

namespace constrictor {
namespace {

constexpr double kRoom_m = 0.2, kAhead_m = 0.6;

/// A U in the frame of the head: one arm behind the head, the other one `aside_m` beside it.
std::vector<PlanarPose> u_beside_the_head(double aside_m) {
  std::vector<PlanarPose> body;
  for (double x_m = 0.0; x_m >= -0.8; x_m -= 0.1) body.push_back({{x_m, 0.0}, 0.0});
  for (double x_m = -0.8; x_m <= 0.0; x_m += 0.1) body.push_back({{x_m, aside_m}, M_PI});
  return body;
}

void stand(msg::FieldMap& map, double x_m, double y_m) {
  map.obstacle_x_m[map.obstacle_count] = x_m;
  map.obstacle_y_m[map.obstacle_count++] = y_m;
}

TEST(CarryingRoom, TheHeadStaysOnTheLineWhereNothingIsNear) {
  const auto body = u_beside_the_head(-0.3);
  msg::FieldMap map{};
  EXPECT_EQ(shift_from_line_m(map, {}, {}, body, kRoom_m, kAhead_m), 0.0);
  stand(map, 0.3, 0.25);   // 0.25 m beside the arm on the line
  stand(map, 0.3, -0.55);  // 0.25 m beside the other one
  stand(map, 0.7, 0.0);    // too far ahead
  stand(map, -0.9, 0.05);  // behind
  EXPECT_EQ(shift_from_line_m(map, {}, {}, body, kRoom_m, kAhead_m), 0.0);
}

TEST(CarryingRoom, BothArmsPassBetweenObstaclesWithTheRoomThatThereIs) {
  Random random(3);
  for (int i = 0; i < 500; ++i) {
    // The line passes the head at any angle and distance; the head may be anywhere in M.
    const PlanarPose X_MH{{random.uniform(-3.0, 3.0), random.uniform(-3.0, 3.0)}, random.uniform(-3.0, 3.0)};
    const double yaw_rad = random.uniform(-0.4, 0.4), offset_m = random.uniform(-0.3, 0.3);
    const PlanarPose X_HL{{0.0, offset_m}, yaw_rad};
    const double aside_m = random.uniform(-0.35, 0.35);
    const auto body = u_beside_the_head(aside_m);
    const double left_m = random.uniform(0.05, 0.9), right_m = -random.uniform(0.05, 0.9);
    msg::FieldMap map{};
    for (const double y_m : {left_m, right_m}) {
      const Eigen::Vector2d p_M = X_MH.to_parent(X_HL.to_parent({0.1, y_m}));
      stand(map, p_M.x(), p_M.y());
    }
    const double shift_m = shift_from_line_m(map, X_MH, X_HL, body, kRoom_m, kAhead_m);
    // The gaps on both sides after the whole body has moved, so that the head is `shift_m` beside the line.
    const double head_m = X_HL.to_local({0.0, 0.0}).y();
    double left_gap_m = 9.0, right_gap_m = 9.0;
    for (const PlanarPose& module : body) {
      const double y_m = X_HL.to_local(module.p).y() - head_m + shift_m;
      left_gap_m = std::min(left_gap_m, left_m - y_m);
      right_gap_m = std::min(right_gap_m, y_m - right_m);
    }
    if (left_gap_m + right_gap_m > 2.0 * kRoom_m) {
      EXPECT_GT(std::min(left_gap_m, right_gap_m), kRoom_m - 1e-9);
      const bool needed = shift_m == 0.0 || std::min(left_gap_m, right_gap_m) < kRoom_m + 1e-9;
      EXPECT_TRUE(needed) << "no farther from the line than necessary";
    } else {
      EXPECT_NEAR(left_gap_m, right_gap_m, 1e-9) << "in the middle of a narrow passage";
    }
  }
}

}  // namespace
}  // namespace constrictor
