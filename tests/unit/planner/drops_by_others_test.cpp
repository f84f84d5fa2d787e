// Objects that an operator or external planner drops: the planner looks at them once it may command again.
#include <gtest/gtest.h>

#include "scripted_planner.hpp"

namespace constrictor {
namespace {

using enum MissionState;

class DropByOthers : public PlannerTest {
 protected:
  DropByOthers() { find_line(); }
  /// Another source takes authority.
  void take(std::uint8_t level = msg::kAuthorityOperator) {
    authority_.level = level;
    step();
  }
  /// It drops an object of this colour.
  void drop_by_other(std::uint8_t colour, std::uint16_t handle = 0) {
    msg::TaskEvent event{};
    event.goal_id = (std::uint64_t{authority_.level} << 48) + 7;
    event.event = msg::kEventDroppingDone;
    event.goal_state = msg::kGoalRunning;
    event.colour = colour;
    event.object_handle = handle;
    step({event});
  }
  /// It hands authority back.
  void hand_back() {
    authority_.level = msg::kAuthorityNone;
    step();
  }
  void expect_look_at(std::uint8_t colour) const {
    EXPECT_EQ(memory_.state, kInspect);
    EXPECT_EQ(last_.task, msg::kTaskSearchObject);
    EXPECT_EQ(last_.parameters.object_colour, colour);
  }
  /// Images show the object of this colour, at this distance from its zone's centre, until the look has ended.
  void look(std::uint8_t colour, double offset_m) {
    for (int i = 0; i < 80 && memory_.state == kInspect && last_.parameters.object_colour == colour; ++i) {
      map_dropped(colour, offset_m);
      step();
    }
  }
};

TEST_F(DropByOthers, CountsAsDeliveredWhenItIsSeenOnItsZone) {
  take(msg::kAuthorityExternal);
  drop_by_other(msg::kColourRed);
  hand_back();
  expect_look_at(msg::kColourRed);
  steps(20);
  expect_look_at(msg::kColourRed);
  look(msg::kColourRed, 0.1);
  EXPECT_EQ(memory_.state, kTurnRound);
  EXPECT_EQ(memory_.object_index, 0) << "green comes first";
  take();
  drop_by_other(msg::kColourGreen);
  hand_back();
  expect_look_at(msg::kColourGreen);
  look(msg::kColourGreen, 0.1);
  EXPECT_EQ(memory_.state, kDone);
  EXPECT_EQ(memory_.recoveries, 0);
}

TEST_F(DropByOthers, OutsideItsZoneIsRetrieved) {
  take();
  drop_by_other(msg::kColourGreen, 2);
  hand_back();
  expect_look_at(msg::kColourGreen);
  look(msg::kColourGreen, 0.8);
  EXPECT_EQ(memory_.state, kSearchObject);
  EXPECT_EQ(memory_.object_index, 0);
  EXPECT_EQ(memory_.delivered, 0u);
  EXPECT_EQ(memory_.recoveries, 1);
}

// The mission was called a success although nobody had seen the object since the drop.
TEST_F(DropByOthers, ThatNoImageShowsIsSearchedFor) {
  config_.sequence = {msg::kColourGreen};
  take();
  map_dropped(msg::kColourGreen, 0.1);  // where the map expects it when the body lets it go
  drop_by_other(msg::kColourGreen, 2);
  hand_back();
  const double from_s = time_s_;
  while (memory_.state == kInspect && time_s_ < from_s + 100.0) step();
  EXPECT_NEAR(time_s_ - from_s, config_.inspect_s, 0.1);
  EXPECT_EQ(memory_.state, kSearchObject);
  map_dropped(msg::kColourGreen, 0.1);
  step();
  EXPECT_EQ(memory_.state, kDone) << "it is seen on its zone after all";
}

TEST_F(DropByOthers, ASightingSinceTheDropCountsBeforeTheHandBack) {
  config_.sequence = {msg::kColourGreen};
  take();
  drop_by_other(msg::kColourGreen, 2);
  steps(50);
  map_dropped(msg::kColourGreen, 0.1);
  steps(500);
  hand_back();
  step();
  EXPECT_EQ(memory_.state, kDone);
}

TEST_F(DropByOthers, EachOfSeveralIsLookedAt) {
  config_.sequence = {msg::kColourGreen, msg::kColourRed, msg::kColourYellow};
  take();
  drop_by_other(msg::kColourYellow, 4);
  drop_by_other(msg::kColourGreen, 2);
  hand_back();
  expect_look_at(msg::kColourYellow);
  object_ = 4;
  look(msg::kColourYellow, 0.1);
  expect_look_at(msg::kColourGreen);
  object_ = 2;
  look(msg::kColourGreen, 0.1);
  EXPECT_EQ(memory_.state, kTurnRound);
  EXPECT_EQ(memory_.object_index, 1) << "red is left";
}

TEST_F(DropByOthers, IsLookedAtAfterTheObjectThatTheRobotCarriesAtTheHandBack) {
  take();
  drop_by_other(msg::kColourGreen, 2);
  see_nothing();
  status_.carrying = true;  // and takes the next one
  hand_back();
  EXPECT_EQ(memory_.state, kSearchLine);
  EXPECT_EQ(memory_.object_index, 1);
  object_ = 3;
  release(msg::kColourRed);
  map_dropped(msg::kColourRed, 0.1);
  succeed(msg::kEventDroppingDone);
  look(msg::kColourRed, 0.1);
  expect_look_at(msg::kColourGreen);
  object_ = 2;
  look(msg::kColourGreen, 0.1);
  EXPECT_EQ(memory_.state, kDone);
}

// The object that the robot holds at the hand-back is one of those that were dropped before.
TEST_F(DropByOthers, ThatIsTakenUpAgainIsDelivered) {
  config_.sequence = {msg::kColourGreen};
  take();
  drop_by_other(msg::kColourGreen, 2);
  see_nothing();
  status_.carrying = true;
  hand_back();
  EXPECT_EQ(memory_.state, kSearchLine);
  drop(msg::kColourGreen);
  EXPECT_EQ(memory_.state, kDone);
}

// The planner drops the object, and another source drops it again before the planner has looked.
TEST_F(DropByOthers, OfAnObjectThatThePlannerDroppedBeforeStandsForIt) {
  config_.sequence = {msg::kColourGreen};
  fetch(msg::kColourGreen);
  carry();
  release(msg::kColourGreen);
  succeed(msg::kEventDroppingDone);
  expect_look_at(msg::kColourGreen);
  take();
  map_dropped(msg::kColourGreen, 0.1);  // before the other source takes it up again
  steps(20);
  drop_by_other(msg::kColourGreen, 2);
  hand_back();
  steps(5);
  expect_look_at(msg::kColourGreen);
  look(msg::kColourGreen, 0.8);
  EXPECT_EQ(memory_.state, kSearchObject);
}

TEST_F(DropByOthers, IsNotRetrievedOnceItIsSeenOnItsZone) {
  take(msg::kAuthorityExternal);
  drop_by_other(msg::kColourRed);
  hand_back();
  look(msg::kColourRed, 0.1);
  find_line();
  fetch(msg::kColourGreen);
  carry();
  drop(msg::kColourGreen);
  EXPECT_EQ(memory_.state, kDone);
}

}  // namespace
}  // namespace constrictor
