// How the attempts with one object differ, and what of them reaches navigation.
#include <cmath>
#include <set>
#include <tuple>
#include <vector>

#include "planner/attempts.hpp"
#include "scripted_planner.hpp"

namespace constrictor {
namespace {

using enum MissionState;

TEST(AttemptsTest, NoTwoOfThirtyAreEqual) {
  std::set<std::tuple<int, double, double, int>> ways;
  Attempts attempts;
  for (; attempts.failures < 30; ++attempts.failures) {
    const Way way = next_way(attempts);
    const std::uint8_t side = way.direction == msg::kDirectionNone ? msg::kDirectionLeft : way.direction;
    EXPECT_NE(side, attempts.side) << "the other side each time";
    attempts.side = side;
    ways.insert({side, way.clearance_m, way.wrap_scale, next_departure(attempts)});
  }
  EXPECT_EQ(ways.size(), 30u);
}

TEST(AttemptsTest, TheFirstLeavesEverythingToNavigation) {
  const Way way = next_way({});
  EXPECT_EQ(way.direction, msg::kDirectionNone);
  EXPECT_EQ(way.clearance_m, 0.0);
  EXPECT_EQ(way.wrap_scale, 0.0);
}

class AttemptPlanner : public PlannerTest {
 protected:
  /// From the search of the object to its grasp, which is lost.
  void lose_grasp() {
    if (memory_.state == kApproachAnew) succeed(msg::kEventNone);
    succeed(msg::kEventObjectFound);
    succeed(msg::kEventObjectReached);
    ASSERT_EQ(memory_.state, kPregrasp);
    passed_ = last_;
    status_.parameters.direction = msg::kDirectionLeft;
    steps(5);  // until navigation has taken the goal
    succeed(msg::kEventObjectPregrasped);
    ASSERT_EQ(memory_.state, kGrasp);
    grasped_ = last_;
    abort(msg::kEventObjectGraspLost);
  }
  WantedTask passed_, grasped_;
};

TEST_F(AttemptPlanner, TheThirdAttemptPassesNearerAndWrapsWider) {
  find_line();
  drive(4.0);
  succeed(msg::kEventEndOfLine);
  ASSERT_EQ(memory_.state, kSearchObject);
  for (int i = 0; i < 2; ++i) {
    lose_grasp();
    EXPECT_EQ(passed_.parameters.clearance_m, 0.0);
    EXPECT_EQ(grasped_.parameters.wrap_scale, 0.0);
  }
  lose_grasp();
  EXPECT_EQ(passed_.parameters.clearance_m, 0.02);
  EXPECT_EQ(passed_.parameters.wrap_scale, 0.0) << "a parameter of grasp";
  EXPECT_EQ(grasped_.parameters.wrap_scale, 1.15);
  EXPECT_EQ(grasped_.parameters.clearance_m, 0.0) << "a parameter of pregrasp";
}

// Each time the drop put the object beside its zone.
TEST_F(AttemptPlanner, AnObjectThatWasDroppedOutsideItsZoneIsRetrievedInAnotherWayEachTime) {
  find_line();
  drive(4.0);
  succeed(msg::kEventEndOfLine);
  std::set<std::tuple<std::uint8_t, std::uint8_t, double, double>> ways;
  std::uint8_t side = msg::kDirectionLeft;  // on which navigation passes if the planner leaves it the choice
  for (int i = 0; i < config_.attempts; ++i) {
    const std::uint8_t departure = memory_.state == kApproachAnew ? last_.parameters.direction : msg::kDirectionNone;
    EXPECT_EQ(departure == msg::kDirectionNone, i < 2) << i;
    if (memory_.state == kApproachAnew) succeed(msg::kEventNone);
    succeed(msg::kEventObjectFound);
    succeed(msg::kEventObjectReached);
    ASSERT_EQ(memory_.state, kPregrasp) << i;
    if (i > 0) {
      EXPECT_NE(last_.parameters.direction, side) << "the other side";
      side = last_.parameters.direction;
    }
    status_.parameters.direction = side;
    const double clearance_m = last_.parameters.clearance_m;
    steps(5);  // until navigation has taken the goal
    succeed(msg::kEventObjectPregrasped);
    ways.insert({departure, side, clearance_m, last_.parameters.wrap_scale});
    status_.carrying = true;
    succeed(msg::kEventObjectGrasped);
    ASSERT_EQ(memory_.state, kSearchLine);
    release(msg::kColourGreen);
    succeed(msg::kEventDroppingDone);
    steps(20);
    map_dropped(msg::kColourGreen, 0.45);
    step();
  }
  EXPECT_EQ(ways.size(), static_cast<std::size_t>(config_.attempts));
  EXPECT_EQ(memory_.object_index, 1) << "it is put aside";
}

// The zone stays in view, and the robot would begin the same drop at once.
TEST_F(AttemptPlanner, ADropThatDidNotReachTheZoneIsRepeatedFromElsewhere) {
  find_line();
  fetch(msg::kColourGreen);
  carry();
  see_zone(msg::kColourGreen, 0.8);
  steps(4);
  for (const std::uint8_t side : {msg::kDirectionRight, msg::kDirectionLeft}) {
    ASSERT_EQ(memory_.state, kDrop);
    steps(5);
    abort(msg::kEventNone);
    std::vector<std::uint8_t> directions{last_.parameters.direction};
    for (int i = 0; i < 3000 && memory_.state == kSearchLine; ++i) {
      if (const auto wanted = step(); wanted && memory_.state == kSearchLine)
        directions.push_back(wanted->parameters.direction);
    }
    EXPECT_EQ(directions, (std::vector<std::uint8_t>{msg::kDirectionBackwards, msg::kDirectionBackwards, side,
                                                     msg::kDirectionForwards}));
  }
  EXPECT_EQ(memory_.recoveries, 2);
}

// An object stood far away where no search came. The robot searched for it until the mission's time was over, and left
// the other object beside the line untouched.
TEST_F(AttemptPlanner, AnObjectThatIsNotFoundIsPutAsideForTheOthers) {
  find_line();
  drive(4.0);
  succeed(msg::kEventEndOfLine);
  const auto search_in_vain = [&](std::uint8_t sought) {
    ASSERT_EQ(memory_.state, kSearchObject);
    ASSERT_EQ(last_.parameters.object_colour, sought);
    see_nothing();
    const double from_s = time_s_;
    while (memory_.state == kSearchObject && time_s_ < from_s + 1000.0) step();
    EXPECT_NEAR(time_s_ - from_s, config_.find_timeout_s, 0.1);
  };
  const auto at_the_end_again = [&] {
    ASSERT_EQ(memory_.state, kSearchLineOrObject);
    memory_.state = kSearchObject;  // by the line and its end
    memory_.entered_s = memory_.active_s;
    memory_.requested = false;
    step();
  };
  search_in_vain(msg::kColourGreen);
  at_the_end_again();
  search_in_vain(msg::kColourRed);
  at_the_end_again();  // the second pass
  search_in_vain(msg::kColourGreen);
  while (memory_.state != kFailed && time_s_ < 1000.0) {  // there is no other object left
    at_the_end_again();
    search_in_vain(msg::kColourRed);
  }
  EXPECT_EQ(memory_.state, kFailed);
  EXPECT_EQ(memory_.reason,
            "not delivered: green (2 attempts failed, the last in search object: not found within 90 s); "
            "red (6 attempts failed, the last in search object: not found within 90 s)");
}

TEST_F(AttemptPlanner, TheOnlyObjectIsSearchedForSeveralTimes) {
  config_.sequence = {msg::kColourGreen};
  find_line();
  for (int i = 0; i < 10 && memory_.state != kFailed; ++i) {
    memory_.state = kSearchObject;
    memory_.entered_s = memory_.active_s;
    memory_.requested = false;
    see_nothing();
    step();
    for (int k = 0; k < 5000 && memory_.state == kSearchObject; ++k) step();
  }
  EXPECT_EQ(memory_.state, kFailed);
  EXPECT_EQ(memory_.attempts.at(0).failures, config_.attempts + 1);
}

TEST_F(AttemptPlanner, ADoubtfulObjectIsNotApproached) {
  find_line();
  drive(4.0);
  see(msg::kColourGreen, msg::kBlobObject, 1.2);
  objects_.blobs[0].object_probability = 0.4;
  steps(10);
  EXPECT_EQ(memory_.state, kFollowLine);
  objects_.blobs[0].object_probability = 0.6;
  steps(4);
  EXPECT_EQ(memory_.state, kTrackObject);
}

class ZonesAnywhere : public PlannerTest {
 protected:
  ZonesAnywhere() { config_.zones_at = kZonesAnywhere; }
};

TEST_F(ZonesAnywhere, AnObjectIsCarriedOnInTheDirectionThatIsNotExploredYet) {
  find_line();
  fetch(msg::kColourGreen);
  face(0.0);  // the line goes on ahead
  see_line(true);
  steps(4);
  EXPECT_EQ(memory_.state, kTransport);
  succeed(msg::kEventEndOfLine);
  EXPECT_EQ(memory_.state, kTurnBack) << "no zone here: to the other end";
  turn();
  EXPECT_EQ(memory_.state, kTransport);
  EXPECT_LT(std::cos(pose_.yaw_rad), -0.5);
}

TEST_F(ZonesAnywhere, AnObjectIsCarriedBackToAZoneThatTheMapHasThere) {
  find_line();
  map_.object_count = 1;
  map_.objects[0] = {1, msg::kColourGreen, msg::kBlobZone, 0.0, 0.0, 0.4, 0.0, 0.03, false, false, 0, 0.0};
  fetch(msg::kColourGreen);
  see_line(true);
  steps(4);
  EXPECT_EQ(memory_.state, kTransport) << "the head faces back already";
}

TEST_F(ZonesAnywhere, AnEndOfTheLineAmongZonesMayHaveObjects) {
  find_line();
  drive(2.0);
  see_zone(msg::kColourRed, 1.5);
  step();
  succeed(msg::kEventEndOfLine);
  EXPECT_EQ(memory_.state, kSearchObject);
  see_nothing();
  for (int i = 0; i < 1600 && memory_.state == kSearchObject; ++i) step();  // end_search_s is 30 s
  EXPECT_EQ(memory_.state, kSearchLineOrObject);
  for (int i = 0; i < 4000 && memory_.state == kSearchLineOrObject; ++i) {
    face(pose_.yaw_rad + (last_.parameters.direction == msg::kDirectionRight ? -0.02 : 0.02));
    see_line(std::abs(std::cos(pose_.yaw_rad)) > 0.8);
    step();
  }
  EXPECT_EQ(memory_.state, kFollowLine);
  EXPECT_LT(std::cos(pose_.body_yaw_rad), 0.0) << "now the other way";
}

}  // namespace
}  // namespace constrictor
