// Tables I, II (follow line), XIII, XIV (rotate) and XV (explore): the cause of every event is simulated.
#include "behaviour_run.hpp"

namespace constrictor::testing {
namespace {

constexpr const char* kStart = "start: {frame: world, position_m: [0, 0]}\nnoise: {sensors: true, camera_sd: 0.01}\n";

TEST_F(Behaviour, FindsOnlyTheLineOfTheRequestedColour) {
  begin(std::string(
            "name: yellow\nline: {colour: yellow, width_m: 0.05, begin_m: [0.2, 0], segments: [{length_m: 2}]}\n") +
        kStart);
  start(msg::kTaskFollowLine, &msg::TaskParameters::line_colour, msg::kColourBlue);
  EXPECT_EQ(until_end(5.0), msg::kGoalAborted);
  EXPECT_TRUE(first(msg::kEventLineLost));
  EXPECT_FALSE(first(msg::kEventLineFound));
  start(msg::kTaskFollowLine, &msg::TaskParameters::line_colour, msg::kColourYellow);
  ASSERT_TRUE(until_event(msg::kEventLineFound, 2.0));
  EXPECT_EQ(first(msg::kEventLineFound)->event.colour, msg::kColourYellow);
  EXPECT_LT(line_in_view_m(), 1.0);
}

TEST_F(Behaviour, FollowsTheLineToItsEndByGroundTruth) {
  begin(std::string("name: bend\nline: {colour: blue, width_m: 0.05, begin_m: [0.2, 0], segments: [{length_m: 0.5}, "
                    "{length_m: 1.5, curvature_1_m: 0.7}, {length_m: 0.5}]}\n") +
        kStart);
  start(msg::kTaskFollowLine, &msg::TaskParameters::line_colour, msg::kColourBlue);
  double squares_m2 = 0.0;
  int count = 0;
  ASSERT_TRUE(until(
      [&] {
        double nearest_m = 1e9;
        for (const Place& point : line()) nearest_m = std::min(nearest_m, point.distance_m(head()));
        squares_m2 += nearest_m * nearest_m;
        ++count;
        return first(msg::kEventEndOfLine) != nullptr;
      },
      15.0));
  const Happened& end = *first(msg::kEventEndOfLine);
  ASSERT_TRUE(first(msg::kEventLineFound));
  EXPECT_LT(first(msg::kEventLineFound)->time_s, end.time_s);
  EXPECT_FALSE(first(msg::kEventLineLost));
  // The bounds leave room around navigation's `end_reached_m` (0.35 m), because the image is at least two ticks old
  // and the head pitches and sways.
  EXPECT_LT(line().back().distance_m(end.head), 0.45);
  EXPECT_GT(line().back().distance_m(end.head), 0.15);
  std::printf("distance from the line %.3f m rms\n", std::sqrt(squares_m2 / count));
  // Measured: 0.08 to 0.09 m. A part of it is the gait's sway and the way from the start to the line.
  EXPECT_LT(std::sqrt(squares_m2 / count), 0.12);
  EXPECT_EQ(until_end(1.0), msg::kGoalSucceeded);
}

// The line bends by 150 degrees with a radius of 0.2 m, a quarter of the smallest radius that the snake can drive.
TEST_F(Behaviour, ReportsLineLostAfterTheLineHasLeftTheView) {
  begin(std::string("name: corner\nline: {colour: blue, width_m: 0.05, begin_m: [0.2, 0], segments: [{length_m: 1.0}, "
                    "{length_m: 0.52, curvature_1_m: 5}, {length_m: 1.0}]}\n") +
        kStart);
  start(msg::kTaskFollowLine, &msg::TaskParameters::line_colour, msg::kColourBlue);
  double left_view_s = 0.0;  // when a point of the line was last in view
  ASSERT_TRUE(until(
      [&] {
        if (line_in_view_m() < 100.0) left_view_s = time_s();
        return first(msg::kEventLineLost) != nullptr;
      },
      20.0));
  ASSERT_TRUE(first(msg::kEventLineFound));
  const double lost_s = first(msg::kEventLineLost)->time_s;
  std::printf("left the view at %.2f s, lost at %.2f s\n", left_view_s, lost_s);
  // Navigation waits for ten images without the line, 0.1 s apart. The latency of camera and perception comes on top.
  EXPECT_NEAR(lost_s, left_view_s + 1.0, 0.3);
  EXPECT_FALSE(first(msg::kEventEndOfLine));
  EXPECT_EQ(until_end(1.0), msg::kGoalAborted);
}

TEST_F(Behaviour, RotateTurnsToTheRequestedSideUntilItsTimeout) {
  begin(std::string("name: nothing\n") + kStart);
  for (const bool left : {true, false}) {
    happened.clear();
    const auto turned_rad = [&, last = head().yaw_rad, sum = 0.0]() mutable {
      sum += wrap_angle(head().yaw_rad - last);
      last = head().yaw_rad;
      return sum;
    };
    auto so_far_rad = turned_rad;
    start(msg::kTaskRotate, [&](msg::TaskParameters& p) {
      p.direction = left ? msg::kDirectionLeft : msg::kDirectionRight;
      p.timeout_s = 3.0;
    });
    double rad = 0.0;
    ASSERT_TRUE(until(
        [&] {
          rad = so_far_rad();
          return first(msg::kEventTimeout) != nullptr;
        },
        5.0));
    EXPECT_EQ(until_end(1.0), msg::kGoalSucceeded);
    EXPECT_NEAR(first(msg::kEventTimeout)->time_s - happened.front().time_s, 3.0, 0.041);
    std::printf("turned by %.2f rad in 3 s\n", rad);
    EXPECT_GT(left ? rad : -rad, 1.0);  // measured at full speed: 66 to 83 degrees per second
  }
  happened.clear();
  start(msg::kTaskRotate, &msg::TaskParameters::direction, msg::kDirectionLeft);
  EXPECT_EQ(until_end(8.0), msg::kGoalIdle) << "without a timeout the task must continue";
  EXPECT_FALSE(first(msg::kEventTimeout));
}

TEST_F(Behaviour, ExploreMovesInTheRequestedDirectionAndLooksToBothSides) {
  for (const bool forwards : {true, false}) {
    begin(std::string("name: nothing\n") + kStart);
    const Place from = head();
    double leftmost_rad = 0.0, rightmost_rad = 0.0;
    start(msg::kTaskExplore, &msg::TaskParameters::direction,
          forwards ? msg::kDirectionForwards : msg::kDirectionBackwards);
    until(
        [&] {  // the heading of the head relative to module 8, which does not turn when the head looks aside
          const double look_rad = wrap_angle(head().yaw_rad - module(8).yaw_rad);
          leftmost_rad = std::max(leftmost_rad, look_rad);
          rightmost_rad = std::min(rightmost_rad, look_rad);
          return false;
        },
        20.0);
    // The motion is measured at module 12, because the head looks to both sides.
    const double ahead_m = module(12).x_m + 12 * 0.089 - from.x_m;
    std::printf("body moved %.2f m ahead, head looked from %.2f to %.2f rad\n", ahead_m, rightmost_rad, leftmost_rad);
    EXPECT_GT(forwards ? ahead_m : -ahead_m, 0.4);
    EXPECT_GT(leftmost_rad, 0.7);  // navigation's `head_turn_rad` is 0.9
    EXPECT_LT(rightmost_rad, -0.7);
    EXPECT_EQ(until_end(0.1), msg::kGoalIdle) << "it explores until it is cancelled";
  }
}

// The test measures the heading of the front of the body, because the head looks to both sides.
TEST_F(Behaviour, ExploreToASideBendsToThatSide) {
  for (const bool left : {true, false}) {
    begin(std::string("name: nothing\n") + kStart);
    start(msg::kTaskExplore, &msg::TaskParameters::direction, left ? msg::kDirectionLeft : msg::kDirectionRight);
    until([] { return false; }, 10.0);
    double yaw_rad = 0.0;  // mean over one wave of the body
    for (std::size_t m = 8; m < 20; ++m) yaw_rad += module(m).yaw_rad / 12;
    const double side = left ? 1.0 : -1.0;
    std::printf("head at (%.2f, %.2f) m, body points to %.2f rad\n", head().x_m, head().y_m, yaw_rad);
    EXPECT_GT(side * head().y_m, 0.1);
    EXPECT_GT(side * yaw_rad, 0.1);
    EXPECT_GT(head().x_m, 0.2) << "forwards";
  }
}

}  // namespace
}  // namespace constrictor::testing
