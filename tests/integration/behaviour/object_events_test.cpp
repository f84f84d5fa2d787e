// Tables III to VIII (search, track, pregrasp): objects are found, reached and lost in rendered images. Where a test
// needs a loss, a scripted force throws the object away.
#include "behaviour_run.hpp"

namespace constrictor::testing {
namespace {

constexpr double kRadius_m = 0.085;

std::string scene(const std::string& at, const std::string& more = "") {
  return "name: one\nobjects: [{colour: green, frame: world, position_m: " + at +
         ", shape: cylinder, radius_m: 0.085, height_m: 0.15, mass_kg: 0.4}]\n"
         "start: {frame: world, position_m: [0, 0]}\nnoise: {sensors: true, camera_sd: 0.01}\n" +
         more;
}
/// A force throws the object away at this time: 40 N for 0.2 s accelerate it to 20 m/s.
std::string thrown(double at_s) {
  return "perturbations: [{object: 0, at_s: " + std::to_string(at_s) + ", duration_s: 0.2, force_n: [10, 40, 15]}]\n";
}

class ObjectEvents : public Behaviour {
 protected:
  void find() {
    start_green(msg::kTaskSearchObject);
    ASSERT_EQ(until_end(20.0), msg::kGoalSucceeded);
  }
};

TEST_F(ObjectEvents, SearchFindsAnObjectAfterTheHeadHasTurnedToIt) {
  begin(scene("[0.5, 1.3]"));
  ASSERT_FALSE(in_view(head(), object(), 10.0));
  start_green(msg::kTaskSearchObject);
  ASSERT_TRUE(until_event(msg::kEventObjectFound, 20.0));
  const Happened& found = *first(msg::kEventObjectFound);
  EXPECT_EQ(found.event.colour, msg::kColourGreen);
  // At least the edge of the object is in the image: its radius is 0.085 m.
  EXPECT_LT(std::abs(found.head.bearing_rad(found.object)),
            0.25 * M_PI + kRadius_m / found.head.distance_m(found.object));
  EXPECT_GT(found.head.yaw_rad, 0.2) << "the head had to turn left";
  EXPECT_EQ(until_end(3.0), msg::kGoalSucceeded);
}

TEST_F(ObjectEvents, SearchForAHandleIgnoresANearerObjectOfTheSameColour) {
  const std::string object = ", shape: cylinder, radius_m: 0.085, height_m: 0.15, mass_kg: 0.4}";
  begin("name: two\nobjects:\n  - {colour: green, frame: world, position_m: [1.3, 0.4]" + object +
        "\n  - {colour: green, frame: world, position_m: [1.9, -0.6]" + object +
        "\nstart: {frame: world, position_m: [0, 0]}\nnoise: {sensors: true, camera_sd: 0.01}\n");
  find();
  const std::uint16_t near = mapped_near({1.3, 0.4});
  const std::uint16_t far = mapped_near({1.9, -0.6});
  ASSERT_TRUE(near > 0 && far > 0 && near != far) << "both are in view from the start";
  const std::size_t from = happened.size();
  start(msg::kTaskSearchObject, [&](msg::TaskParameters& p) {
    p.object_colour = msg::kColourGreen;
    p.object_handle = far;
  });
  ASSERT_TRUE(until([&] { return first(msg::kEventObjectFound, from) != nullptr; }, 60.0));
  const Happened& found = *first(msg::kEventObjectFound, from);
  EXPECT_EQ(found.event.object_handle, far);
  EXPECT_TRUE(in_view(found.head, place_of(world().object_poses[1]), 3.0));
}

TEST_F(ObjectEvents, SearchIgnoresAnObjectOfAnotherColour) {
  begin(scene("[1.2, 0.1]"));
  start(msg::kTaskSearchObject, &msg::TaskParameters::object_colour, msg::kColourRed);
  EXPECT_FALSE(until_event(msg::kEventObjectFound, 4.0));
  EXPECT_TRUE(in_view(head(), object(), 3.0) || std::abs(head().yaw_rad) > 0.3);
}

TEST_F(ObjectEvents, SearchReportsObjectLostWhenTheFoundObjectVanishes) {
  begin(scene("[1.2, 0.1]", thrown(0.45)));
  start_green(msg::kTaskSearchObject);
  ASSERT_TRUE(until_event(msg::kEventObjectFound, 3.0));
  EXPECT_LT(first(msg::kEventObjectFound)->time_s, 0.45);
  ASSERT_TRUE(until_event(msg::kEventObjectLost, 3.0));
  const Happened& lost = *first(msg::kEventObjectLost);
  EXPECT_FALSE(in_view(lost.head, lost.object, 3.0));
  EXPECT_NEAR(lost.time_s, 0.45 + 1.5, 0.5);  // navigation waits for 15 images without the object
  EXPECT_EQ(until_end(1.0), msg::kGoalIdle) << "the search continues";
}

TEST_F(ObjectEvents, TrackReachesTheObject) {
  begin(scene("[2.2, 0.4]"));
  find();
  start_green(msg::kTaskTrackObject);
  ASSERT_TRUE(until_event(msg::kEventObjectReached, 20.0));
  EXPECT_EQ(first(msg::kEventObjectReached)->event.object_handle, mapped_handle(msg::kColourGreen));
  const Happened& reached = *first(msg::kEventObjectReached);
  const double range_m = reached.head.distance_m(reached.object) - kRadius_m;
  std::printf("reached at %.2f m, %.2f rad\n", range_m, reached.head.bearing_rad(reached.object));
  EXPECT_NEAR(range_m, 0.9, 0.15);  // navigation's `reach_m`
  EXPECT_LT(std::abs(reached.head.bearing_rad(reached.object)),
            0.45);  // `reach_bearing_rad` is 0.3 and limits the mean bearing; the head sways about the mean
  EXPECT_EQ(until_end(1.0), msg::kGoalSucceeded);
}

TEST_F(ObjectEvents, TrackReportsObjectLostWhenTheObjectVanishes) {
  begin(scene("[2.3, 0.2]", thrown(3.0)));  // near enough for the map
  find();
  start_green(msg::kTaskTrackObject);
  ASSERT_TRUE(until_event(msg::kEventObjectLost, 8.0));
  const Happened& lost = *first(msg::kEventObjectLost);
  EXPECT_FALSE(first(msg::kEventObjectReached));
  EXPECT_FALSE(in_view(lost.head, lost.object, 3.0));
  EXPECT_NEAR(lost.time_s, 3.0 + 1.5, 0.6);
  EXPECT_EQ(until_end(1.0), msg::kGoalAborted);
}

TEST_F(ObjectEvents, PregraspReportsPregraspLostWhenTheObjectVanishes) {
  begin(scene("[1.9, 0.1]", thrown(2.5)));
  find();
  start_green(msg::kTaskPregrasp);
  ASSERT_TRUE(until_event(msg::kEventObjectPregraspLost, 90.0));
  const Happened& lost = *first(msg::kEventObjectPregraspLost);
  EXPECT_GT(lost.time_s, 2.5);
  EXPECT_GT(lost.head.distance_m(lost.object), 2.0);
  EXPECT_FALSE(first(msg::kEventObjectPregrasped));
  EXPECT_EQ(until_end(1.0), msg::kGoalAborted);
  start(msg::kTaskGrasp, [](msg::TaskParameters&) {});
  EXPECT_EQ(until_end(1.0), msg::kGoalRefused);
}

// A person takes the object and puts it down out of view. The map gives the empty place up, and the search goes on
// elsewhere and finds the object.
TEST_F(ObjectEvents, AnObjectThatWasTakenAwayLeavesTheMapAndIsFoundAtItsNewPlace) {
  const Place empty{1.2, 0.1}, there{0.6, 1.4};
  begin(scene("[1.2, 0.1]", "perturbations: [{object: 0, at_s: 3, moved_m: [-0.6, 1.3]}]\n"));
  find();
  const std::uint16_t handle = mapped_near(empty);
  ASSERT_NE(handle, 0);
  ASSERT_LT(run_->time_s(), 3.0);
  ASSERT_TRUE(until([&] { return run_->time_s() > 3.1; }, 4.0));
  ASSERT_LT(there.distance_m(object()), 0.05);
  EXPECT_EQ(mapped_near(empty), handle) << "one image is not enough to give it up";
  ASSERT_TRUE(until([&] { return mapped_near(empty) == 0; }, 4.0)) << "the place is in full view, and empty";
  find();
  EXPECT_EQ(mapped_near(empty), 0);
  EXPECT_GT(mapped_near(there), handle) << "the map cannot know that it is the same object";
}

TEST_F(ObjectEvents, AnObjectBehindAnotherOneStaysInTheMap) {
  const std::string object = ", shape: cylinder, radius_m: 0.085, height_m: 0.15, mass_kg: 0.4}";
  begin("name: two\nobjects:\n  - {colour: green, frame: world, position_m: [1.4, 0.0]" + object +
        "\n  - {colour: red, frame: world, position_m: [0.7, 2.0]" + object +
        "\nstart: {frame: world, position_m: [0, 0]}\nnoise: {sensors: true, camera_sd: 0.01}\n"
        "perturbations: [{object: 1, at_s: 3, moved_m: [0.0, -2.0]}]\n");
  find();
  ASSERT_NE(mapped_near({1.4, 0.0}), 0);
  ASSERT_TRUE(until([&] { return mapped_near({0.7, 0.0}) != 0; }, 6.0)) << "red now hides green";
  EXPECT_FALSE(until([&] { return mapped_near({1.4, 0.0}) == 0; }, 10.0));
}

}  // namespace
}  // namespace constrictor::testing
