// Where a delivered object is that the robot may have pushed off its zone.
#include <gtest/gtest.h>

#include "planner/delivery.hpp"

namespace constrictor {
namespace {

constexpr double kSeenSd_m = 0.12, kZoneRadius_m = 0.3;

msg::MapObject landmark(std::uint8_t kind, std::uint16_t handle, double x_m, double sd_m, std::int64_t seen_tick) {
  msg::MapObject made{};
  made.colour = msg::kColourGreen;
  made.kind = kind;
  made.handle = handle;
  made.x_m = x_m;
  made.radius_m = kZoneRadius_m;
  made.sd_m = sd_m;
  made.last_seen_tick = seen_tick;
  return made;
}

class MovedObjectTest : public ::testing::Test {
 protected:
  MovedObjectTest() {
    map_.objects[0] = landmark(msg::kBlobZone, 1, 0.0, 0.03, 100);
    map_.objects[1] = landmark(msg::kBlobObject, 2, 0.1, 0.03, 100);  // precise, where the robot has delivered it
    map_.object_count = 3;
  }
  /// The verdict if the map also has an object at `x_m` that was seen later.
  Delivery with_another(double x_m, double sd_m) {
    map_.objects[2] = landmark(msg::kBlobObject, 5, x_m, sd_m, 200);
    return view_delivery(map_, dropped_, kSeenSd_m, kZoneRadius_m).verdict;
  }
  msg::FieldMap map_{};
  DroppedObject dropped_{msg::kColourGreen, 2, 2, -100, true};
};

TEST_F(MovedObjectTest, IsWhereItWasSeenLast) {
  EXPECT_EQ(with_another(0.9, 0.1), Delivery::kOutside);
  EXPECT_EQ(with_another(0.1, 0.1), Delivery::kOnZone);
  dropped_.may_have_moved = false;
  EXPECT_EQ(with_another(0.9, 0.1), Delivery::kOnZone) << "the more precise landmark counts";
}

TEST_F(MovedObjectTest, AGlimpseCountsOnlyIfItIsClearlyOutsideOfTheZone) {
  EXPECT_EQ(with_another(0.8, 0.2), Delivery::kOnZone) << "2.5 standard deviations outside";
  EXPECT_EQ(with_another(1.2, 0.2), Delivery::kOutside) << "4.5 standard deviations outside";
}

}  // namespace
}  // namespace constrictor
