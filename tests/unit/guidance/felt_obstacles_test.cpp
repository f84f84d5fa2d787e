// Places at which the robot touched something that is no object.
#include <gtest/gtest.h>

#include <cmath>

#include "mapping.hpp"

namespace constrictor {
namespace {

using namespace guidance;
using testing::Mapping;

// A touch where no object stands is one of an obstacle. The map keeps it until the body lies where it was.
TEST(Map, KeepsFeltObstaclesUntilTheBodyPassesThroughThem) {
  Mapping m;
  m.see({Mapping::blob(msg::kColourGreen, msg::kBlobObject, 0.6, 0.4, 0.08)}, 5);
  const auto touch_beside = [&](std::size_t module, double y_m) {
    msg::ContactState contacts{};
    contacts.module_count = 24;
    contacts.contact_count = 1;
    contacts.contacts[0].module_index = static_cast<std::uint8_t>(module);
    contacts.contacts[0].position_m = {0.0, y_m, 0.0};
    contacts.contacts[0].normal = {0.0, y_m > 0.0 ? -1.0 : 1.0, 0.0};
    contacts.contacts[0].force_n = {0.0, y_m > 0.0 ? -2.0 : 2.0, 0.0};
    m.mapper.touch(contacts, m.chain(), m.tick++, 0.02);
  };
  touch_beside(3, 0.035);
  touch_beside(3, 0.035);  // the same peg
  touch_beside(9, -0.035);
  const msg::FieldMap map = m.map();
  ASSERT_EQ(map.obstacle_count, 2);
  EXPECT_EQ(map.touches[0].handle, 0);
  const Eigen::Vector2d expected = m.chain()[3].to_parent({0.0, 0.035});  // the head stands at the origin of M
  EXPECT_NEAR(map.obstacle_x_m[0], expected.x(), 1e-9);
  EXPECT_NEAR(map.obstacle_y_m[0], expected.y(), 1e-9);
  m.mapper.touch({}, m.chain(), m.tick + 100'000, 0.02);
  EXPECT_EQ(m.map().touch_count, 0) << "touches are forgotten after a time";
  EXPECT_EQ(m.map().obstacle_count, 2) << "obstacles are not";
  // The body bends to the left, over the place of the first one.
  m.q[0] = m.q[2] = 0.12;
  const BodyChain bent = m.chain();
  const Eigen::Vector2d local = bent[3].to_local(expected);
  ASSERT_LT(std::abs(local.x()), 0.04);
  ASSERT_LT(std::abs(local.y()), 0.015);
  m.mapper.touch({}, bent, m.tick + 100'001, 0.02);
  EXPECT_EQ(m.map().obstacle_count, 1);
}

// A robot without a skin does not feel that it pushes an object. Only a new image can then show where the object is.
TEST(Map, DoubtsThePlaceOfAnObjectThatABodyWithoutASkinPasses) {
  Mapping m;
  m.see({Mapping::blob(msg::kColourGreen, msg::kBlobObject, 0.6, 0.4, 0.08),
         Mapping::blob(msg::kColourRed, msg::kBlobObject, 0.9, -0.6, 0.08)},
        20);
  const msg::FieldMap before = m.map();
  ASSERT_EQ(before.object_count, 2);
  for (int i = 0; i < 25; ++i) EXPECT_FALSE(m.mapper.brush(m.chain()));
  EXPECT_EQ(m.map().objects[0].sd_m, before.objects[0].sd_m) << "the body lies behind the head, far from both objects";

  // The robot drives on, until the middle of its body lies beside the green object: 0.08 m + 0.03 m are the two radii.
  const BodyChain chain = m.chain();
  const double back_m = chain.back().p.norm() / 2.0;
  m.filter.predict({0.6 + back_m, 0.4 - 0.11}, 0.0, Eigen::Matrix3d::Zero(), {});
  for (int i = 0; i < 25; ++i) EXPECT_TRUE(m.mapper.brush(chain));
  const msg::FieldMap passed = m.map();
  EXPECT_GT(passed.objects[0].sd_m, 0.15) << "25 ticks of 0.04 m each are 0.2 m";
  EXPECT_EQ(passed.objects[1].sd_m, before.objects[1].sd_m);
  EXPECT_EQ(passed.touch_count, 0) << "nothing was felt";

  // The next image shows it 0.3 m further on: the map follows at once, and the pose stays.
  const Eigen::Vector2d head = m.filter.pose().p, seen = Eigen::Vector2d(0.6, 0.7) - head;
  m.see({Mapping::blob(msg::kColourGreen, msg::kBlobObject, seen.x(), seen.y(), 0.08)});
  const msg::FieldMap after = m.map();
  EXPECT_NEAR(after.objects[0].y_m, 0.7, 0.02);
  EXPECT_EQ((m.filter.pose().p - head).norm(), 0.0);
}

}  // namespace
}  // namespace constrictor
