// Heights of objects in the map, and how certain it is that they are objects.
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

// Bayes' rule for independent looks multiplies odds: 0.8 and 0.8 give 16 to 1, whatever the images between them.
TEST(Map, TheProbabilityOfAnObjectFollowsFromAllLooks) {
  Mapping m;
  auto green = Mapping::blob(msg::kColourGreen, msg::kBlobObject, 1.0, 0.0, 0.08);
  green.object_probability = 0.8;
  m.config.confirm = 1;
  m.see({green});
  EXPECT_NEAR(m.map().objects[0].object_probability, 0.8, 1e-9);
  m.see({green}, 5);  // 0.5 s later: one more look
  EXPECT_NEAR(m.map().objects[0].object_probability, 16.0 / 17.0, 1e-9);
  green.object_probability = 0.5;
  m.see({green}, 50);
  EXPECT_NEAR(m.map().objects[0].object_probability, 16.0 / 17.0, 1e-9) << "such images say nothing";
  green.object_probability = 1.0;
  m.see({green}, 100);
  EXPECT_LT(m.map().objects[0].object_probability, 1.0);
  EXPECT_GT(m.map().objects[0].object_probability, 0.999);
}

}  // namespace
}  // namespace constrictor
