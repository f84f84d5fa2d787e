// The line in guidance's map.
#include <gtest/gtest.h>

#include "mapping.hpp"

namespace constrictor {
namespace {

using testing::Mapping;

/// A line parallel to the x axis of the head.
msg::LinePercept line_ahead(double y_m) {
  msg::LinePercept line{};
  line.visible = true;
  line.colour = msg::kColourBlue;
  line.point_count = 32;
  for (int i = 0; i < 32; ++i) {
    line.x_m[i] = 0.1 + 0.025 * i;
    line.y_m[i] = y_m;
  }
  return line;
}

TEST(Map, LineIsMappedOnceAndCorrectsThePose) {
  Mapping m;
  const msg::LinePercept line = line_ahead(0.05);
  for (int k = 0; k < 20; ++k) m.mapper.line(line, {}, k * 5, 0.02);
  EXPECT_GE(m.map().line_point_count, 12);
  EXPECT_LE(m.map().line_point_count, 20);
  // Later the odometry has drifted sideways by 0.1 m. The camera sees the line at its old place.
  m.filter.predict({0.0, 0.1}, 0.0, Eigen::Vector3d(1e-4, 1e-2, 1e-4).asDiagonal());
  for (int k = 0; k < 20; ++k) m.mapper.line(line, {}, 2000 + k * 5, 0.02);
  EXPECT_NEAR(m.filter.pose().p.y(), 0.0, 0.03);
  EXPECT_LE(m.map().line_point_count, 24);
}

TEST(Map, ALineLongerThanTheMessageIsPublishedFromBeginToEnd) {
  Mapping m;
  const msg::LinePercept line = line_ahead(0.0);
  // The robot drives along 60 m of line, which 512 points with a spacing of 0.05 m do not cover.
  for (int k = 0; k < 120; ++k) {
    m.mapper.line(line, {}, k * 5, 0.02);
    m.filter.predict({0.5, 0.0}, 0.0, Eigen::Matrix3d::Zero());
  }
  const msg::FieldMap map = m.map();
  ASSERT_GT(map.line_point_count, 256);
  ASSERT_LE(map.line_point_count, msg::kMaxMapLinePoints);
  EXPECT_NEAR(map.line_x_m[0], 0.1, 0.05);
  EXPECT_NEAR(map.line_x_m[map.line_point_count - 1], 60.3, 0.5);
  for (int i = 1; i < map.line_point_count; ++i) EXPECT_NEAR(map.line_x_m[i] - map.line_x_m[i - 1], 0.16, 0.09);
}

}  // namespace
}  // namespace constrictor
