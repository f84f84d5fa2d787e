// Two objects of one colour, for one zone.
#include "scripted_planner.hpp"

namespace constrictor {
namespace {

using enum MissionState;

/// Two green objects for one green zone of 0.4 m radius.
class TwinsTest : public PlannerTest {
 protected:
  TwinsTest() { config_.sequence = {msg::kColourGreen, msg::kColourGreen}; }
  void add_twin(std::uint16_t handle, double x_m, double sd_m) {
    map_.object_count = 3;
    map_.objects[2] = map_.objects[1];
    map_.objects[2].handle = handle;
    map_.objects[2].x_m = x_m;
    map_.objects[2].sd_m = sd_m;
  }
  void deliver_first() {
    find_line();
    fetch(msg::kColourGreen);
    carry();
    drop(msg::kColourGreen);
    ASSERT_EQ(memory_.delivered, 1u);
    ASSERT_EQ(memory_.placed.at(0).handle, 2);
  }
};

// The search turned to the delivered object, which was nearer, and the robot stayed among the zones for two minutes.
TEST_F(TwinsTest, TheSearchForTheSecondObjectIgnoresTheFirstOnItsZone) {
  deliver_first();
  map_dropped(msg::kColourGreen, 0.1);  // beside the robot
  add_twin(3, pose_.x_m + 2.0, 0.05);
  map_.objects[1].y_m = pose_.y_m + 1.0;
  map_.objects[0].y_m = pose_.y_m + 1.0;
  face(0.0);
  see_nothing();
  memory_.state = kSearchLineOrObject;
  memory_.requested = false;
  memory_.searches = 0;
  step();
  EXPECT_EQ(last_.task, msg::kTaskExplore) << "straight ahead, where the second object stands";
  EXPECT_EQ(last_.parameters.direction, msg::kDirectionForwards);
  memory_.state = kSearchObject;
  memory_.requested = false;
  step();
  EXPECT_EQ(last_.task, msg::kTaskSearchObject);
  EXPECT_EQ(last_.parameters.object_handle, 3) << "not the one that is delivered";
}

// The second object was lost on the way. The robot then took the first one off its zone under the new handle that the
// map had given it, dropped it there again, and believed that both were delivered.
TEST_F(TwinsTest, ADeliveredObjectThatIsReachedInsteadOfTheOtherStays) {
  deliver_first();
  map_dropped(msg::kColourGreen, 0.1);
  add_twin(3, pose_.x_m + 2.0, 0.05);
  map_.objects[1].handle = 5;
  for (const std::uint16_t handle : {std::uint16_t{5}, std::uint16_t{3}}) {
    memory_.state = kTrackObject;
    memory_.requested = false;
    see_nothing();
    step();
    auto reached = event(msg::kEventObjectReached, msg::kGoalSucceeded);
    reached.object_handle = handle;
    step({reached});
    EXPECT_EQ(memory_.state == kPregrasp, handle == 3) << name_of(memory_.state);
  }
  EXPECT_EQ(memory_.delivered, 1u);
}

// The robot pushed the first object off the zone while it carried the second one there.
TEST_F(TwinsTest, TheFirstOneIsLookedAtOnceMoreIfItWasTouched) {
  for (const double offset_m : {0.2, 0.7}) {
    forget();
    deliver_first();
    face(0.0);
    find_line();
    fetch(msg::kColourGreen);
    carry();
    release(msg::kColourGreen);
    const auto map_both = [&](double first_m, double sd_m) {
      map_dropped(msg::kColourGreen, first_m, sd_m);
      map_.objects[0].sd_m = 0.03;
      add_twin(3, pose_.x_m, 0.03);  // the second one, in the middle of the zone
    };
    memory_.dropped_handle = 3;
    map_both(0.2, 0.2);
    auto done = event(msg::kEventDroppingDone, msg::kGoalSucceeded);
    done.object_handle = 3;
    step({done});
    expect_second_look(0.2, offset_m, 2, map_both);
  }
}

}  // namespace
}  // namespace constrictor
