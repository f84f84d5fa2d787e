// The room between obstacles of the map, compared with the distances of many points of the way.
#include "planner/free_way.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "component/random.hpp"

namespace constrictor {
namespace {

msg::FieldMap with_obstacle(const Eigen::Vector2d& p) {
  msg::FieldMap map{};
  map.obstacle_count = 1;
  map.obstacle_x_m[0] = p.x();
  map.obstacle_y_m[0] = p.y();
  return map;
}

/// [m] from a point to the nearest of the points of a straight way that lie at least `begin_m` from its beginning.
double sampled_m(const Eigen::Vector2d& p, const Eigen::Vector2d& from, const Eigen::Vector2d& to, double begin_m) {
  double least_m = std::numeric_limits<double>::infinity();
  const double length_m = std::hypot(to.x() - from.x(), to.y() - from.y());
  for (double s_m = begin_m; s_m <= length_m; s_m += 1e-3) {
    const double share = s_m / length_m;
    const double x_m = from.x() + share * (to.x() - from.x()), y_m = from.y() + share * (to.y() - from.y());
    least_m = std::min(least_m, std::hypot(p.x() - x_m, p.y() - y_m));
  }
  return least_m;
}

TEST(FreeWay, IsFreeIfEveryPointOfItIsFarFromTheObstacle) {
  Random random(7);
  const auto coordinate_m = [&] { return 4.0 * random.uniform() - 2.0; };
  int free = 0, blocked = 0;
  for (int i = 0; i < 2000; ++i) {
    const Eigen::Vector2d from{coordinate_m(), coordinate_m()}, to{coordinate_m(), coordinate_m()};
    const Eigen::Vector2d p{coordinate_m(), coordinate_m()};
    constexpr double kRoom_m = 0.3;
    const double away_m = sampled_m(p, from, to, 0.0);
    const bool is_free = is_free_way(with_obstacle(p), from, to, kRoom_m);
    if (away_m > kRoom_m + 0.01) {
      EXPECT_TRUE(is_free);
    }
    // An obstacle beside the beginning does not count: the way leads away from it.
    const double along_m = ((p.x() - from.x()) * (to.x() - from.x()) + (p.y() - from.y()) * (to.y() - from.y())) /
                           std::hypot(to.x() - from.x(), to.y() - from.y());
    if (away_m < kRoom_m - 0.01 && along_m > 0.11) {
      EXPECT_FALSE(is_free);
    }
    if (along_m < 0.09) {
      EXPECT_TRUE(is_free);
    }
    ++(is_free ? free : blocked);
  }
  EXPECT_GT(free, 500);
  EXPECT_GT(blocked, 100);
}

TEST(FreeWay, OtherObjectsAreInTheWayByTheirSurfaces) {
  msg::FieldMap map{};
  map.object_count = 2;
  map.objects[0].kind = msg::kBlobZone;  // one may drive over it
  map.objects[0].x_m = 0.5;
  map.objects[1].kind = msg::kBlobObject;
  map.objects[1].x_m = 0.7;
  map.objects[1].radius_m = 0.1;
  const auto is_free = [&](double y_m) {
    map.objects[1].y_m = y_m;
    return is_free_of_objects(map, {0.0, 0.0}, {1.0, 0.0}, 0.3);
  };
  EXPECT_TRUE(is_free(0.41));
  EXPECT_FALSE(is_free(0.39));
  EXPECT_FALSE(is_free(-0.39));
  map.objects[1].carried = true;
  EXPECT_TRUE(is_free(0.0)) << "the held object is in the U";
}

TEST(FreeWay, TheArmsAreCaughtByWhatStandsBetweenTheObjectAndTheHeadOrJustAhead) {
  msg::MapObject held{};
  held.x_m = 1.0;
  held.y_m = 2.0;
  const Eigen::Vector2d head{1.0, 2.8};  // the arms point along y
  const auto caught = [&](const Eigen::Vector2d& p) { return is_caught(with_obstacle(p), held, head, 0.25, 0.4); };
  EXPECT_TRUE(caught({1.2, 2.4}));
  EXPECT_TRUE(caught({0.8, 2.4}));
  EXPECT_TRUE(caught({1.0, 3.15})) << "0.35 m before the head";
  EXPECT_FALSE(caught({1.0, 3.25})) << "0.45 m before the head";
  EXPECT_FALSE(caught({1.3, 2.4}));
  EXPECT_FALSE(caught({1.0, 1.9})) << "behind the object, where the base comes from";
  EXPECT_FALSE(is_caught(msg::FieldMap{}, held, head, 0.25, 0.4));
}

}  // namespace
}  // namespace constrictor
