// The map compared with scenes that are known exactly.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>

#include "mapping.hpp"

namespace constrictor {
namespace {

using namespace guidance;
using testing::Mapping;

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

TEST(Map, EachLandmarkKeepsItsHandle) {
  Mapping m;
  const auto green = Mapping::blob(msg::kColourGreen, msg::kBlobObject, 1.0, 0.3, 0.08);
  const auto other = Mapping::blob(msg::kColourGreen, msg::kBlobObject, 1.0, -0.6, 0.08);
  const auto zone = Mapping::blob(msg::kColourGreen, msg::kBlobZone, 1.2, 0.4, 0.2);
  m.see({green, other, zone}, 2);
  EXPECT_EQ(m.map().object_count, 0);  // not confirmed yet
  m.see({other, zone, green}, 6);
  const msg::FieldMap map = m.map();
  ASSERT_EQ(map.object_count, 3);
  EXPECT_EQ(map.objects[0].handle, 1);
  EXPECT_EQ(map.objects[1].handle, 2);
  EXPECT_EQ(map.objects[2].handle, 3);
  EXPECT_NEAR(map.objects[0].x_m, 1.0, 1e-6);
  EXPECT_NEAR(map.objects[0].y_m, 0.3, 1e-6);
  EXPECT_NEAR(map.objects[0].radius_m, 0.08, 1e-6);
  EXPECT_EQ(map.objects[2].kind, msg::kBlobZone);
  EXPECT_GT(map.objects[0].sd_m, 0.0);
  EXPECT_LT(map.objects[0].sd_m, 0.1);
}

TEST(Map, PerceptsWithoutFiniteRangeCreateNoLandmark) {
  Mapping m;
  auto nowhere = Mapping::blob(msg::kColourRed, msg::kBlobObject, 0.5, 0.0, 0.08);
  nowhere.range_m = nowhere.width_m = kNan;
  m.see({nowhere}, 10);
  auto broken = nowhere;
  broken.bearing_rad = kNan;
  m.see({broken}, 10);
  EXPECT_EQ(m.map().object_count, 0);
  msg::LinePercept line{};
  line.visible = true;
  line.colour = msg::kColourBlue;
  line.point_count = 2;
  line.x_m[0] = line.y_m[1] = kNan;
  m.mapper.line(line, {}, 100, 0.02);
  EXPECT_EQ(m.map().line_point_count, 0);
}

TEST(Map, DelayedPerceptIsPlacedFromThePoseAtItsExposure) {
  Mapping m;
  // The head has turned by 0.2 rad and moved by 0.1 m since the exposure.
  m.filter.predict({0.1, 0.0}, 0.2, Eigen::Matrix3d::Zero());
  const Eigen::Vector2d back = m.filter.pose().to_local({0.0, 0.0});
  m.see({Mapping::blob(msg::kColourRed, msg::kBlobObject, 1.0, 0.0, 0.08)}, 4, {back, -0.2});
  ASSERT_EQ(m.map().object_count, 1);
  EXPECT_NEAR(m.map().objects[0].x_m, 1.0, 0.01);
  EXPECT_NEAR(m.map().objects[0].y_m, 0.0, 0.01);
}

// The robot has touched the object on the left, so that its place is uncertain. Only the other one is in view.
TEST(Map, AnObjectThatStandsWhereItStoodIsNotTakenForATouchedOneOfItsColour) {
  Mapping m;
  const auto touched = Mapping::blob(msg::kColourGreen, msg::kBlobObject, 1.0, 0.2, 0.08);
  const auto other = Mapping::blob(msg::kColourGreen, msg::kBlobObject, 1.0, -0.1, 0.08);
  m.see({touched, other}, 30);
  for (int i = 0; i < 200; ++i) m.filter.loosen(0, 0.04 * 0.04);
  m.see({Mapping::blob(msg::kColourGreen, msg::kBlobObject, 1.0, -0.06, 0.08)}, 10);
  const msg::FieldMap map = m.map();
  ASSERT_EQ(map.object_count, 2);
  EXPECT_LT(map.objects[0].last_seen_tick, map.objects[1].last_seen_tick);
  EXPECT_NEAR(map.objects[0].y_m, 0.2, 0.02);
  EXPECT_GT(map.objects[0].sd_m, 0.3);
}

TEST(Map, MovedObjectKeepsItsHandle) {
  Mapping m;
  m.see({Mapping::blob(msg::kColourRed, msg::kBlobObject, 0.6, 0.0, 0.08)}, 30);
  m.see({Mapping::blob(msg::kColourRed, msg::kBlobObject, 0.6, 0.35, 0.08)}, 10);
  const msg::FieldMap map = m.map();
  ASSERT_EQ(map.object_count, 1);
  EXPECT_EQ(map.objects[0].handle, 1);
  EXPECT_NEAR(map.objects[0].y_m, 0.35, 0.05);
}

TEST(Map, TouchConfirmsTheObjectAndIgnoresGroundAndSelf) {
  Mapping m;
  m.see({Mapping::blob(msg::kColourGreen, msg::kBlobObject, 0.15, 0.12, 0.08)}, 5);
  msg::ContactState contacts{};
  contacts.module_count = 24;
  const auto add = [&](std::uint8_t module, double y, double ny, double nz) {
    msg::Contact& c = contacts.contacts[contacts.contact_count++];
    c.module_index = module;
    c.position_m = {0.0, y, nz > 0.5 ? -0.035 : 0.0};
    c.normal = {0.0, ny, nz};
    c.force_n = {0.0, 2.0 * ny, 2.0 * nz};
  };
  add(5, 0.0, 0.0, 1.0);  // the ground
  m.mapper.touch(contacts, m.chain(), 100, 0.02);
  EXPECT_EQ(m.map().touch_count, 0);
  EXPECT_FALSE(m.map().objects[0].touched);

  // In a hairpin bend the tail half lies beside the front half. They touch each other.
  Mapping self;
  for (std::size_t i = 8; i <= 14; i += 2) self.q[i] = std::numbers::pi / 4.0;
  const BodyChain chain = self.chain();
  std::size_t across = 0;
  double nearest = 1e9;
  for (std::size_t j = 15; j < 24; ++j) {
    const double apart = std::hypot(chain[j].p.x() - chain[7].p.x(), chain[j].p.y() - chain[7].p.y());
    if (apart < nearest) {
      nearest = apart;
      across = j;
    }
  }
  const Eigen::Vector2d toward = turned(Eigen::Vector2d(chain[across].p - chain[7].p), -chain[7].yaw_rad);
  msg::ContactState own{};
  own.module_count = 24;
  own.contact_count = 1;
  own.contacts[0].module_index = 7;
  const Eigen::Vector2d at = toward - 0.03 * toward.normalized();  // on the skin of the other module
  own.contacts[0].position_m = {at.x(), at.y(), 0.0};
  own.contacts[0].normal = {-toward.normalized().x(), -toward.normalized().y(), 0.0};
  own.contacts[0].force_n = {1.0, 1.0, 0.0};
  self.mapper.touch(own, chain, 100, 0.02);
  EXPECT_EQ(self.map().touch_count, 0);

  contacts = {};
  contacts.module_count = 24;
  add(0, 0.035, -1.0, 0.0);
  contacts.contacts[0].position_m = {0.1, 0.045, 0.0};  // toward the object at (0.15, 0.12)
  m.mapper.touch(contacts, m.chain(), 101, 0.02);
  EXPECT_EQ(m.map().touch_count, 1);
  EXPECT_TRUE(m.map().objects[0].touched);
  EXPECT_EQ(m.map().touches[0].handle, m.map().objects[0].handle);
  EXPECT_EQ(m.map().obstacle_count, 0);
  m.mapper.touch(contacts, m.chain(), 102, 0.02);
  EXPECT_EQ(m.map().touch_count, 1);  // still the same contact
  m.mapper.touch({}, m.chain(), 102 + 1000, 0.02);
  EXPECT_EQ(m.map().touch_count, 0);  // forgotten
}

TEST(Map, APartOfAZoneAtTheImagesBorderMovesNeitherTheZoneNorThePose) {
  Mapping m;
  m.see({Mapping::blob(msg::kColourGreen, msg::kBlobZone, 1.2, 0.0, 0.4)}, 20);
  m.filter.predict({0.0, 0.0}, 0.0, Eigen::Vector3d(0.05, 0.05, 0.001).asDiagonal());
  // The head turns to the right, so that the image shows only the right half of the zone.
  auto part = Mapping::blob(msg::kColourGreen, msg::kBlobZone, 1.2, -0.2, 0.2);
  part.cut_left = true;
  m.see({part}, 20);
  const msg::FieldMap map = m.map();
  ASSERT_EQ(map.object_count, 1);
  EXPECT_NEAR(map.objects[0].x_m, 1.2, 1e-6);
  EXPECT_NEAR(map.objects[0].y_m, 0.0, 1e-6);
  EXPECT_EQ(map.objects[0].last_seen_tick, m.tick);
  EXPECT_LT(m.filter.pose().p.norm(), 1e-6);
}

// The head saw 0.04 m of the red zone between the green object and its zone, and the pose jumped by 0.4 m.
TEST(Map, APartOfAZoneBesideWhatHidesItMovesNeitherTheZoneNorThePose) {
  for (const double pose_variance_m2 : {0.05, 1e-6}) {  // the part is taken for the zone, or for a zone that has moved
    Mapping m;
    m.see({Mapping::blob(msg::kColourRed, msg::kBlobZone, 1.2, 0.0, 0.4)}, 20);
    m.filter.predict({0.0, 0.0}, 0.0, Eigen::Vector3d(pose_variance_m2, pose_variance_m2, 1e-3).asDiagonal());
    m.see({Mapping::blob(msg::kColourRed, msg::kBlobZone, 0.9, -0.2, 0.02)}, 20);
    const msg::FieldMap map = m.map();
    ASSERT_EQ(map.object_count, 1);
    EXPECT_NEAR(map.objects[0].x_m, 1.2, 1e-6);
    EXPECT_NEAR(map.objects[0].y_m, 0.0, 1e-6);
    EXPECT_NEAR(map.objects[0].radius_m, 0.4, 1e-6);
    EXPECT_LT(m.filter.pose().p.norm(), 1e-6);
  }
}

/// What the camera shows of a disc at `p` of which it sees only the azimuths below `border_rad`: the range is the one
/// of the near edge in the middle of the visible part, the width that of a disc between the visible sides.
msg::Blob cut_disc(const Eigen::Vector2d& p, double radius_m, double border_rad) {
  const double centre_rad = std::atan2(p.y(), p.x()), half_rad = std::asin(radius_m / p.norm());
  const double right_rad = centre_rad - half_rad, left_rad = std::min(centre_rad + half_rad, border_rad);
  const double middle_rad = 0.5 * (left_rad + right_rad);
  const Eigen::Vector2d sight(std::cos(middle_rad), std::sin(middle_rad));
  const double along_m = sight.dot(p), squared_m2 = radius_m * radius_m - (p.squaredNorm() - along_m * along_m);
  const double range_m = along_m - std::sqrt(squared_m2);
  const double sine = std::sin(0.5 * (left_rad - right_rad));
  msg::Blob blob{};
  blob.colour = msg::kColourGreen;
  blob.kind = msg::kBlobObject;
  blob.bearing_rad = middle_rad;
  blob.range_m = range_m;
  blob.width_m = 2.0 * range_m * sine / (1.0 - sine);
  blob.cut_left = true;
  return blob;
}

TEST(Map, APartOfAnObjectAtTheImagesBorderShowsWhereItsCentreIs) {
  for (const double visible : {0.15, 0.5, 0.9}) {  // share of the width
    Mapping s;
    const Eigen::Vector2d p(0.6, 0.35);
    const double radius_m = 0.1, half_rad = std::asin(radius_m / p.norm());
    s.filter.predict(Eigen::Vector2d(0.0, 0.0), 0.0, Eigen::Vector3d(0.01, 0.01, 1e-6).asDiagonal());
    s.see({Mapping::blob(msg::kColourGreen, msg::kBlobObject, p.x(), p.y(), radius_m)}, 10);
    s.filter.predict(Eigen::Vector2d(0.0, 0.0), 0.0, Eigen::Vector3d(0.01, 0.01, 1e-6).asDiagonal());
    const double border_rad = std::atan2(p.y(), p.x()) + (2.0 * visible - 1.0) * half_rad;
    s.see({cut_disc(p, radius_m, border_rad)}, 200);
    EXPECT_LT(s.filter.pose().p.norm(), 0.01) << "the pose stays, although it is uncertain; visible: " << visible;
    const msg::FieldMap map = s.map();
    ASSERT_EQ(map.object_count, 1);
    EXPECT_LT(std::hypot(map.objects[0].x_m - p.x(), map.objects[0].y_m - p.y()), 0.01);
    EXPECT_NEAR(map.objects[0].radius_m, radius_m, 0.005);
  }
}

TEST(Map, PushedObjectDoesNotMoveThePose) {
  Mapping m;
  m.filter.predict({0.0, 0.0}, 0.0, Eigen::Vector3d(0.01, 0.01, 0.001).asDiagonal());
  m.see({Mapping::blob(msg::kColourGreen, msg::kBlobObject, 0.15, 0.12, 0.08)}, 20);
  m.filter.predict({0.0, 0.0}, 0.0, Eigen::Vector3d(0.01, 0.01, 0.001).asDiagonal());
  msg::ContactState contacts{};
  contacts.module_count = 24;
  contacts.contact_count = 1;
  contacts.contacts[0].position_m = {0.1, 0.045, 0.0};
  contacts.contacts[0].normal = {0.0, -1.0, 0.0};
  contacts.contacts[0].force_n = {0.0, -2.0, 0.0};
  for (int k = 0; k < 30; ++k) m.mapper.touch(contacts, m.chain(), m.tick + k, 0.02);
  // The object slid by 0.15 m while the head stood still.
  m.see({Mapping::blob(msg::kColourGreen, msg::kBlobObject, 0.15, 0.27, 0.08)}, 20);
  ASSERT_EQ(m.map().object_count, 1);
  EXPECT_NEAR(m.map().objects[0].y_m, 0.27, 0.03);
  EXPECT_LT(m.filter.pose().p.norm(), 0.03);
}

TEST(Map, CarriedObjectMovesWithTheBody) {
  Mapping m;
  for (const std::size_t i : {10u, 12u, 14u}) m.q[i] = std::numbers::pi / 3.0;
  // The object lies in the bend. Its place comes from an independent construction: the centre of the arc.
  const BodyChain chain = m.chain();
  const Eigen::Vector2d base = chain[13].p;
  const double heading = chain[13].yaw_rad;
  const Eigen::Vector2d object = base + 0.115 * Eigen::Vector2d(-std::sin(heading), std::cos(heading));
  m.see({Mapping::blob(msg::kColourGreen, msg::kBlobObject, object.x(), object.y(), 0.08),
         Mapping::blob(msg::kColourRed, msg::kBlobObject, object.x() + 0.7, object.y(), 0.08)},
        5);
  msg::TaskStatus task{};
  task.parameters.object_colour = msg::kColourGreen;
  task.carrying = true;
  m.mapper.carry(task, chain, 200);
  m.filter.predict({0.5, 0.0}, 0.0, Eigen::Matrix3d::Zero());
  m.mapper.carry(task, chain, 201);
  msg::FieldMap map = m.map();
  ASSERT_EQ(map.object_count, 2);
  EXPECT_TRUE(map.objects[0].carried);
  EXPECT_FALSE(map.objects[1].carried);
  EXPECT_NEAR(map.objects[0].x_m, object.x() + 0.5, 0.08);
  EXPECT_NEAR(map.objects[0].y_m, object.y(), 0.08);
  task.carrying = false;
  m.mapper.carry(task, chain, 202);
  m.filter.predict({-0.5, 0.0}, 0.0, Eigen::Matrix3d::Zero());
  map = m.map();
  EXPECT_FALSE(map.objects[0].carried);
  EXPECT_EQ(map.objects[0].handle, 1);
  EXPECT_NEAR(map.objects[0].x_m, object.x() + 0.5, 0.08);

  // The arms have pushed the object on, which no sensor felt. The first image places it, and does not move the pose.
  m.filter.predict({0.0, 0.0}, 0.0, Eigen::Vector3d(0.02, 0.02, 1e-4).asDiagonal());
  const Eigen::Vector2d pose = m.filter.pose().p, after = object + Eigen::Vector2d(0.5, 0.3);
  m.see({Mapping::blob(msg::kColourGreen, msg::kBlobObject, after.x(), after.y(), 0.08)}, 10);
  map = m.map();
  ASSERT_EQ(map.object_count, 2);
  EXPECT_EQ(map.objects[0].handle, 1);
  EXPECT_NEAR(map.objects[0].x_m, after.x(), 0.01);
  EXPECT_NEAR(map.objects[0].y_m, after.y(), 0.01);
  EXPECT_LT((m.filter.pose().p - pose).norm(), 0.01);
}

}  // namespace
}  // namespace constrictor
