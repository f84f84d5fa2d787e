// Which zones are large enough for the objects that a mission demands.
#include <gtest/gtest.h>

#include "planner/delivery.hpp"

namespace constrictor {
namespace {

// The centre of a delivered object lies inside its zone. The robot must see the zone around the object.
TEST(ZoneSize, AZoneThatItsObjectHidesIsRefused) {
  DemandedObject object;
  object.key = "objects[1]";
  object.width_m = object.length_m = 0.17;
  object.zone_key = "zones[2]";
  object.zone_radius_m = 0.085;
  EXPECT_TRUE(judge_zone_size(object).refusals.empty());
  object.zone_radius_m = 0.08;
  ASSERT_EQ(judge_zone_size(object).refusals.size(), 1u);
  EXPECT_EQ(judge_zone_size(object).refusals[0],
            "zones[2].radius_m: found 0.080 m, accepted at least 0.085 m for objects[1]: the object hides a smaller "
            "zone, and the robot cannot see that the object was delivered");
  object.box = true;  // its corners reach farther
  object.zone_radius_m = 0.11;
  EXPECT_EQ(judge_zone_size(object).refusals.size(), 1u);
  object.zone_radius_m = 0.121;
  EXPECT_TRUE(judge_zone_size(object).refusals.empty());
}

TEST(ZoneSize, ASmallObjectNeedsAZoneThatTheMapTellsFromItsSurroundings) {
  DemandedObject object;
  object.width_m = object.length_m = 0.06;
  object.zone_key = "zones[0]";
  object.zone_radius_m = 0.05;
  EXPECT_EQ(judge_zone_size(object).refusals.size(), 1u);
  object.zone_radius_m = 0.06;
  EXPECT_TRUE(judge_zone_size(object).refusals.empty());
}

}  // namespace
}  // namespace constrictor
