// Scenes made from messages: counts, frames, colours.
#include "sim/render/scene_from_messages.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <memory>

namespace constrictor {
namespace {

TEST(SceneFromMessages, PoseRotatesByHamiltonQuaternion) {
  msg::Pose3 pose{};
  pose.position_m = {1, 2, 3};
  pose.orientation = {std::sqrt(0.5), 0, 0, std::sqrt(0.5)};  // 90° about z: x becomes y
  const Eigen::Vector3d p = pose_of(pose) * Eigen::Vector3d(1, 0, 0);
  EXPECT_NEAR((p - Eigen::Vector3d(1, 3, 3)).norm(), 0, 1e-12);
}

TEST(SceneFromMessages, ReadsAsManyEntriesAsTheCounts) {
  auto description = std::make_unique<msg::SceneDescription>();
  *description = {};
  description->module_length_m = 0.089;
  description->module_radius_m = 0.035;
  description->object_count = 2;
  description->objects[0] = {msg::kColourGreen, msg::kShapeCylinder, {0.08, 0.08, 0.15}, 0.4};
  description->objects[1] = {msg::kColourRed, msg::kShapeBox, {0.1, 0.2, 0.3}, 0.4};
  description->zone_count = 1;
  description->zones[0] = {msg::kColourRed, 1.0, -2.0, 0.3};
  description->obstacle_count = 1;
  description->obstacles[0].shape = msg::kShapeBox;
  description->obstacles[0].pose.orientation.w = 1;
  description->ground_gloss = 0.7;
  description->line_point_count = 3;
  description->line_x_m[2] = 5.0;
  const Scene scene = scene_of(*description);
  ASSERT_EQ(scene.objects.size(), 2U);
  EXPECT_EQ(scene.objects[0].shape, SolidShape::kCylinder);
  EXPECT_EQ(scene.objects[1].shape, SolidShape::kBox);
  EXPECT_GT(scene.objects[0].colour.g, 3 * scene.objects[0].colour.r);
  EXPECT_GT(scene.objects[1].colour.r, 3 * scene.objects[1].colour.g);
  ASSERT_EQ(scene.zones.size(), 1U);
  EXPECT_EQ(scene.zones[0].centre_m, Eigen::Vector2d(1.0, -2.0));
  EXPECT_EQ(scene.obstacles.size(), 1U);
  EXPECT_EQ(scene.X_WObstacle.size(), 1U);
  ASSERT_EQ(scene.line_m.size(), 3U);
  EXPECT_EQ(scene.line_m[2].x(), 5.0);
  EXPECT_EQ(scene.ground_gloss, 0.7);
}

}  // namespace
}  // namespace constrictor
