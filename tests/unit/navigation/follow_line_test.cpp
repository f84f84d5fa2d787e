// follow_line with an object in the U: what it does while the camera does not show the line.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <memory>

#include "robot/planar.hpp"
#include "task_setting.hpp"

namespace constrictor {
namespace {

/// A robot whose head lies at the origin of M and points along x.
class LineFollower {
 public:
  explicit LineFollower(bool carries) {
    grip_.carrying = carries;
    grip_.side = 1.0;
    setting_.parameters.line_colour = setting_.map.line_colour = msg::kColourBlue;
    task_->start(setting_.input(), grip_);
  }
  /// The line of the map leaves the origin in the direction `heading_rad`.
  void map_line(double heading_rad) {
    for (int i = 0; i < 40; ++i) {
      const Eigen::Vector2d p = 0.05 * i * along(heading_rad);
      setting_.map.line_x_m[setting_.map.line_point_count] = p.x();
      setting_.map.line_y_m[setting_.map.line_point_count++] = p.y();
    }
  }
  /// [1/m] The path's curvature after `images` images, which show the line at this offset; NaN: they do not show it.
  double curvature_1_m(int images, double offset_m) {
    msg::LinePercept line{};
    line.colour = msg::kColourBlue;
    line.visible = std::isfinite(offset_m);
    line.lookahead_m = setting_.config.line.lookahead_m;
    line.offset_m = offset_m;
    line.heading_rad = line.curvature_1_m = line.visible ? 0.0 : std::numeric_limits<double>::quiet_NaN();
    double curvature = 0.0;
    for (int i = 0; i < images; ++i) {
      setting_.next_tick();
      TaskOutput output;
      task_->step(setting_.input({}, &line), grip_, output);
      curvature = output.desired.points[0].curvature_1_m;
    }
    return curvature;
  }

 private:
  TaskSetting setting_;
  const std::unique_ptr<Task> task_ = make_task(msg::kTaskFollowLine);
  Grip grip_;
};

constexpr double kUnseen = std::numeric_limits<double>::quiet_NaN();

// The head swings with the gait: in a bend it saw the line only at the end of a swing, and hardly turned.
TEST(FollowLine, WithAnObjectTheLineOfTheMapStandsForOneThatIsOutOfView) {
  for (const double side : {1.0, -1.0}) {
    for (const double heading_rad : {0.4, 1.0}) {
      LineFollower robot(true);
      robot.map_line(side * heading_rad);
      robot.curvature_1_m(5, 0.0);
      EXPECT_GT(side * robot.curvature_1_m(5, kUnseen), 0.1) << heading_rad;
    }
  }
}

TEST(FollowLine, WithoutAMappedLineTheLastCurvatureContinues) {
  LineFollower robot(true);
  const double last_1_m = robot.curvature_1_m(5, 0.1);
  EXPECT_GT(last_1_m, 0.1);
  EXPECT_EQ(robot.curvature_1_m(5, kUnseen), last_1_m);
}

TEST(FollowLine, WithoutAnObjectTheLastCurvatureContinues) {
  LineFollower robot(false);
  robot.map_line(-0.4);
  const double last_1_m = robot.curvature_1_m(5, 0.1);
  EXPECT_EQ(robot.curvature_1_m(5, kUnseen), last_1_m);
}

}  // namespace
}  // namespace constrictor
