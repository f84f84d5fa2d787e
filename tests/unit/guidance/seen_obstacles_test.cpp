// Obstacles that the camera sees, in the map.
#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "mapping.hpp"

namespace constrictor {
namespace {

using namespace guidance;
using testing::Mapping;
using Points = std::vector<Eigen::Vector2d>;

struct Looking : Mapping {
  /// Images that show these obstacles, in the head's frame.
  void look_at(const Points& points, int images, const std::vector<msg::Blob>& blobs = {}) {
    msg::ObjectPercepts percepts{};
    for (const msg::Blob& b : blobs) percepts.blobs[percepts.blob_count++] = b;
    for (const Eigen::Vector2d& p : points) {
      percepts.obstacle_x_m[percepts.obstacle_count] = p.x();
      percepts.obstacle_y_m[percepts.obstacle_count++] = p.y();
    }
    for (int i = 0; i < images; ++i) {
      tick += 5;
      mapper.objects(percepts, {}, tick);
      mapper.obstacles(percepts, {}, chain(), level, tick);
    }
  }
  [[nodiscard]] Points obstacles() const {
    const msg::FieldMap m = map();
    Points points;
    for (int i = 0; i < m.obstacle_count; ++i) points.emplace_back(m.obstacle_x_m[i], m.obstacle_y_m[i]);
    return points;
  }
};

TEST(SeenObstacles, AreBelievedAfterSomeImages) {
  Looking m;
  m.look_at({{0.6, 0.2}}, m.config.obstacle_confirm - 1);
  EXPECT_TRUE(m.obstacles().empty());
  m.look_at({{0.6, 0.2}}, 1);
  ASSERT_EQ(m.obstacles().size(), 1U);
  EXPECT_NEAR(m.obstacles()[0].x(), 0.6, 1e-9);
  EXPECT_NEAR(m.obstacles()[0].y(), 0.2, 1e-9);
  EXPECT_FALSE(m.map().obstacle_felt[0]);
}

// Distant ranges are inaccurate: the nearer view corrects the place, and makes no second obstacle.
TEST(SeenObstacles, TheNearerViewCounts) {
  Looking m;
  m.look_at({{1.1, 0.0}}, 5);
  m.filter.predict({0.6, 0.0}, 0.0, Eigen::Matrix3d::Zero());
  m.look_at({{0.42, 0.0}}, 20);  // it stands at 1.02 m
  ASSERT_EQ(m.obstacles().size(), 1U);
  EXPECT_NEAR(m.obstacles()[0].x(), 1.02, 0.01);
}

TEST(SeenObstacles, PointsOfAWallStayApart) {
  Looking m;
  Points wall;
  for (int i = 0; i < 10; ++i) wall.emplace_back(0.4 + 0.05 * i, 0.4);
  m.look_at(wall, 10);
  const Points points = m.obstacles();
  ASSERT_GE(points.size(), 4U) << "points in one line of sight may be one";
  for (const auto& p : points) EXPECT_NEAR(p.y(), 0.4, 0.03);
}

TEST(SeenObstacles, BodyAndObjectsAreNone) {
  Looking m;
  for (int joint = 0; joint < 10; ++joint) m.q[static_cast<std::size_t>(joint)] = joint % 2 == 0 ? 0.7 : 0.0;
  const BodyChain chain = m.chain();
  m.look_at({chain[8].p, chain[9].p + Eigen::Vector2d(0.0, 0.06)}, 20);
  EXPECT_TRUE(m.obstacles().empty());
  m.q.fill(0.0);
  const auto green = Mapping::blob(msg::kColourGreen, msg::kBlobObject, 0.8, 0.3, 0.08);
  m.look_at({}, 5, {green});
  m.look_at({{0.8, 0.45}, {0.8, 0.7}}, 20, {green});
  ASSERT_EQ(m.obstacles().size(), 1U) << "a dark side of the object is none, what stands behind it is";
  EXPECT_NEAR(m.obstacles()[0].y(), 0.7, 1e-6);
}

TEST(SeenObstacles, AreForgottenWhenTheImagesShowNothingThere) {
  Looking m;
  m.look_at({{0.6, 0.1}, {0.7, -0.4}}, 10);
  ASSERT_EQ(m.obstacles().size(), 2U);
  m.look_at({{0.7, -0.4}}, m.config.obstacle_misses - 1);
  EXPECT_EQ(m.obstacles().size(), 2U);
  m.look_at({{0.7, -0.4}}, 1);
  ASSERT_EQ(m.obstacles().size(), 1U);
  EXPECT_NEAR(m.obstacles()[0].y(), -0.4, 1e-9);
}

TEST(SeenObstacles, RemainWhileTheyAreHiddenOrOutOfView) {
  Looking m;
  m.look_at({{0.7, 0.0}, {0.6, 0.55}}, 10);
  // An object in front of the first, and the second at the border of the image.
  m.look_at({}, 100, {Mapping::blob(msg::kColourRed, msg::kBlobObject, 0.45, 0.0, 0.08)});
  EXPECT_EQ(m.obstacles().size(), 2U);
  // Something else that is seen in front.
  Looking n;
  n.look_at({{0.7, 0.0}}, 10);
  n.look_at({{0.4, 0.0}}, 100);
  EXPECT_EQ(n.obstacles().size(), 2U);
  // A head that is tilted sees nothing reliably.
  Looking tilted;
  tilted.look_at({{0.6, 0.0}}, 10);
  tilted.level = false;
  tilted.look_at({}, 100);
  EXPECT_EQ(tilted.obstacles().size(), 1U);
}

TEST(SeenObstacles, ATouchConfirmsThePlaceForGood) {
  Looking m;
  m.look_at({{-0.267, 0.07}, {0.6, 0.1}}, 10);  // the first is too close to the body to be seen as an obstacle
  msg::ContactState contacts{};
  contacts.module_count = 24;
  contacts.contact_count = 1;
  contacts.contacts[0].module_index = 3;
  contacts.contacts[0].position_m = {0.0, 0.035, 0.0};
  contacts.contacts[0].normal = {0.0, -1.0, 0.0};
  contacts.contacts[0].force_n = {0.0, -2.0, 0.0};
  m.mapper.touch(contacts, m.chain(), m.tick++, 0.02);
  const msg::FieldMap map = m.map();
  ASSERT_EQ(map.obstacle_count, 2);
  EXPECT_FALSE(map.obstacle_felt[0]);
  EXPECT_TRUE(map.obstacle_felt[1]);
  m.look_at({}, 200);
  ASSERT_EQ(m.obstacles().size(), 1U) << "the felt one remains";
  EXPECT_LT(m.obstacles()[0].x(), 0.0);
}

TEST(SeenObstacles, TheMapHoldsAsManyAsTheMessage) {
  Looking m;
  for (int row = 0; row < 20; ++row) {
    Points points;
    for (int i = 0; i < 20; ++i) points.emplace_back(0.3 + 0.03 * row, -1.0 + 0.1 * i);
    m.filter.predict({0.3, 0.0}, 0.0, Eigen::Matrix3d::Zero());
    m.look_at(points, 6);
  }
  EXPECT_EQ(m.map().obstacle_count, msg::kMaxMapObstacles);
}

// A landmark behind a wall need not be in view.
TEST(SeenObstacles, HideLandmarks) {
  const auto given_up = [](bool wall) {
    Looking m;
    const auto green = Mapping::blob(msg::kColourGreen, msg::kBlobObject, 1.0, 0.0, 0.08);
    m.look({green}, 10);
    if (wall) {
      Points points;
      for (int i = 0; i < 10; ++i) points.emplace_back(0.6, -0.25 + 0.05 * i);
      m.look_at(points, 10);
    }
    m.look({}, 200);
    return m.map().object_count == 0;
  };
  EXPECT_TRUE(given_up(false));
  EXPECT_FALSE(given_up(true));
}

}  // namespace
}  // namespace constrictor
