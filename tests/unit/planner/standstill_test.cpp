#include "planner/standstill.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "scripted_planner.hpp"

namespace constrictor {
namespace {

constexpr double kNear_m = 0.3, kAfter_s = 15.0;

class StandstillTest : public ::testing::Test {
 protected:
  std::optional<Move> at(double x_m, double now_s) {
    static_cast<void>(standstill_.notice(x_m, 0.0, now_s, kNear_m, kAfter_s));
    return standstill_.next();
  }
  Standstill standstill_;
};

TEST_F(StandstillTest, ARobotThatGetsOnIsLeftAlone) {
  standstill_.begin();
  for (int i = 0; i < 100; ++i) EXPECT_FALSE(at(0.31 * i, 10.0 * i)) << i;
}

TEST_F(StandstillTest, ACaughtRobotIsLedAwayToOneSideAndThenToTheOther) {
  standstill_.begin();
  double now_s = 0.0;
  for (const std::uint8_t side : {msg::kDirectionRight, msg::kDirectionLeft}) {
    for (; now_s < 14.0 || !at(0.1, now_s); now_s += 2.0) ASSERT_LT(now_s, 200.0);
    EXPECT_EQ(at(0.0, now_s)->direction, msg::kDirectionBackwards);
    const auto turn = at(-0.1, now_s += 8.0);
    ASSERT_TRUE(turn);
    EXPECT_EQ(turn->task, msg::kTaskRotate);
    EXPECT_EQ(turn->direction, side);
    EXPECT_EQ(at(-0.1, now_s += 10.0)->direction, msg::kDirectionForwards);
    EXPECT_FALSE(at(0.0, now_s += 8.0));
  }
}

TEST_F(StandstillTest, ALostObjectIsNotLedAway) {
  standstill_.begin();
  EXPECT_FALSE(standstill_.notice(0.0, 0.0, 0.0, kNear_m, kAfter_s));
  EXPECT_TRUE(standstill_.notice(0.0, 0.0, 16.0, kNear_m, kAfter_s));
  EXPECT_TRUE(standstill_.leads_away());
  standstill_.end();
  EXPECT_FALSE(standstill_.leads_away());
  EXPECT_FALSE(standstill_.next());
}

TEST_F(StandstillTest, AnotherSearchBeginsAnew) {
  standstill_.begin();
  EXPECT_FALSE(at(0.0, 0.0));
  standstill_.begin();
  EXPECT_FALSE(at(0.0, 100.0));
  EXPECT_FALSE(at(0.0, 114.0));
  EXPECT_TRUE(at(0.0, 116.0));
}

// The end of a wall stood between the arms of the U. The head swung by a metre while the robot turned to and fro, and
// no move led the robot away for 100 s.
TEST_F(PlannerTest, ARobotIsCaughtWhenItsObjectStaysWhileTheHeadSwings) {
  config_.standstill_s = 15.0;
  find_line();
  fetch(msg::kColourGreen);
  map_dropped(msg::kColourGreen, 0.5);
  map_.objects[1].carried = true;
  std::vector<double> backwards_s;
  const double from_s = time_s_;
  for (int i = 0; i < 1200; ++i) {
    pose_.y_m = 0.6 * std::sin(0.01 * i);
    const auto wanted = step();
    ASSERT_EQ(memory_.state, MissionState::kSearchLine);
    if (wanted && wanted->task == msg::kTaskExplore && wanted->parameters.direction == msg::kDirectionBackwards)
      backwards_s.push_back(time_s_ - from_s);
  }
  ASSERT_EQ(backwards_s.size(), 2u);
  EXPECT_NEAR(backwards_s[0], config_.standstill_s, 0.5) << "the long move of the search ends early";
  EXPECT_NEAR(backwards_s[1] - backwards_s[0], config_.explore_s, 0.5) << "the moves that lead away are short";
}

// A peg stood between the arms. The zone was in view, and each drop that timed out was followed by another one.
TEST_F(PlannerTest, ARobotThatIsCaughtNearAZoneIsLedAwayBeforeItDropsTheObject) {
  config_.standstill_s = 15.0;
  find_line();
  fetch(msg::kColourGreen);
  carry();
  see_zone(msg::kColourGreen, 0.8);
  steps(4);
  ASSERT_EQ(memory_.state, MissionState::kDrop);
  map_dropped(msg::kColourGreen, 0.5);
  map_.objects[1].carried = true;
  std::vector<std::uint8_t> directions;
  const double from_s = time_s_;
  for (int i = 0; i < 3000; ++i) {
    if (const auto wanted = step(); wanted && memory_.state == MissionState::kSearchLine)
      directions.push_back(wanted->parameters.direction);
    if (memory_.state == MissionState::kDrop && !directions.empty()) break;
    if (directions.empty()) {
      ASSERT_LT(time_s_ - from_s, config_.standstill_s + 1.0);
    }
  }
  EXPECT_EQ(memory_.state, MissionState::kDrop);
  EXPECT_EQ(memory_.recoveries, 1);
  ASSERT_GE(directions.size(), 4U);
  EXPECT_EQ(directions[0], msg::kDirectionBackwards);
  EXPECT_EQ(directions[1], msg::kDirectionBackwards);
  EXPECT_EQ(directions[2], msg::kDirectionRight);
  EXPECT_EQ(directions[3], msg::kDirectionForwards);
}

// The end of a wall stood between the arms of the U. The robot lost the line every 20 s and found it again at once, for
// ten minutes, and no state lasted long enough for its standing still to be noticed.
TEST_F(PlannerTest, ACaughtRobotThatLosesTheLineAndFindsItInTurnIsLedAway) {
  config_.standstill_s = 15.0;
  find_line();
  fetch(msg::kColourGreen);
  carry();
  const double from_s = time_s_;
  int losses = 0;
  last_ = {};
  for (int i = 1; i < 2000 && last_.parameters.direction != msg::kDirectionBackwards; ++i) {
    if (i % 250 == 0 && memory_.state == MissionState::kTransport) {
      abort(msg::kEventLineLost);
      ++losses;
    } else {
      step();  // the line is in view
    }
  }
  EXPECT_EQ(losses, 2);
  EXPECT_NEAR(time_s_ - from_s, 15.0, 0.5);
}

TEST_F(PlannerTest, ALongSearchOfTheLineIsNotCountedAsStandingStillWhileItIsFollowed) {
  config_.standstill_s = 15.0;
  find_line();
  fetch(msg::kColourGreen);
  carry();
  see_line(false);
  abort(msg::kEventLineLost);
  ASSERT_EQ(memory_.state, MissionState::kSearchLine);
  steps(600);  // 12 s
  ASSERT_EQ(memory_.state, MissionState::kSearchLine);
  see_line(true);
  steps(5);
  ASSERT_EQ(memory_.state, MissionState::kTransport);
  steps(700);  // 14 s
  EXPECT_EQ(memory_.state, MissionState::kTransport) << "the time of the search is not added";
}

}  // namespace
}  // namespace constrictor
