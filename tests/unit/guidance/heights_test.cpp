// Heights of objects in the map.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "mapping.hpp"

namespace constrictor {
namespace {

using testing::Mapping;

TEST(Map, HeightsAreAveragedAndThoseOfCutTopsAreLowerBounds) {
  Mapping m;
  auto green = Mapping::blob(msg::kColourGreen, msg::kBlobObject, 1.0, 0.0, 0.08);
  green.height_m = std::numeric_limits<double>::quiet_NaN();
  m.see({green}, 5);
  EXPECT_TRUE(std::isnan(m.map().objects[0].height_m)) << "no image has shown it";
  const auto see = [&](double height_m, bool cut_top, int times) {
    green.height_m = height_m;
    green.cut_top = cut_top;
    m.see({green}, times);
    return m.map().objects[0].height_m;
  };
  EXPECT_EQ(see(0.18, true, 20), 0.18);
  EXPECT_NEAR(see(0.3, false, 60), 0.3, 0.001);
  const double below_m = see(0.28, false, 1);
  EXPECT_LT(below_m, 0.3);
  EXPECT_GT(below_m, 0.29) << "one image counts little";
  EXPECT_EQ(see(0.18, true, 60), below_m) << "the nearer view says nothing against it";
  EXPECT_EQ(see(-1.0, false, 1), below_m);
  EXPECT_EQ(m.map().object_count, 1);
}

}  // namespace
}  // namespace constrictor
