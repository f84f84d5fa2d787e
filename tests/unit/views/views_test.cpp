// What viewers see, against poses and bytes computed here.
#include "views/views.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <vector>

#include "constrictor/text.hpp"

namespace constrictor::views {
namespace {

/// A robot of two modules whose head is at (1, 2) and looks to the left, 0.5 m in front of its tail.
Newest example() {
  Newest newest;
  msg::SceneDescription scene{};
  scene.object_count = 1;
  scene.objects[0].colour = msg::kColourGreen;
  scene.objects[0].shape = msg::kShapeCylinder;
  scene.objects[0].size_m = {0.08, 0.08, 0.15};
  scene.line_point_count = 2;
  scene.line_x_m[1] = 3.0;
  scene.zone_count = 1;
  scene.zones[0].radius_m = 0.4;
  scene.module_length_m = 0.1;
  scene.module_radius_m = 0.03;
  newest.scene = scene;
  msg::WorldState world{};
  world.module_count = 2;
  world.object_count = 1;
  const double half = std::numbers::pi / 4;
  for (int i = 0; i < 2; ++i) {
    world.module_poses[i].position_m = {1.0, 2.0 - 0.5 * i, 0.03};
    world.module_poses[i].orientation = {std::cos(half), 0, 0, std::sin(half)};
  }
  world.object_poses[0].orientation.w = 1;
  world.header.tick = 10;
  newest.world = world;
  return newest;
}

TEST(Views, ContactForcesPointWhereTheyPushTheModule) {
  Newest newest = example();
  msg::ContactState contacts{};
  contacts.contact_count = 2;
  contacts.contacts[0].module_index = 1;
  contacts.contacts[0].position_m = {0, 0.03, 0};  // on the left of the tail, which looks along +y
  contacts.contacts[0].force_n = {0, -10, 0};      // to its right: +x of the world
  contacts.contacts[1].module_index = 0;
  contacts.contacts[1].force_n = {0, 0, 5};  // the ground
  newest.contacts = contacts;
  const auto robot = scene_update(newest, 5'000'000'007).at("entities").at(2);
  ASSERT_EQ(robot.at("cubes").size(), 2u);
  ASSERT_EQ(robot.at("arrows").size(), 1u);
  const auto& pose = robot.at("arrows").at(0).at("pose");
  EXPECT_NEAR(pose.at("position").at("x").get<double>(), 1.0 - 0.03, 1e-12);
  EXPECT_NEAR(pose.at("position").at("y").get<double>(), 1.5, 1e-12);
  EXPECT_NEAR(pose.at("orientation").at("w").get<double>(), 1.0, 1e-9) << "the arrow points along +x";
  EXPECT_EQ(robot.at("timestamp").at("sec"), 5);
  EXPECT_EQ(robot.at("timestamp").at("nsec"), 7);
}

TEST(Views, ThePageGetsPosesInSpaceAndContactsInTheWorld) {
  Newest newest = example();
  msg::ContactState contacts{};
  contacts.contact_count = 1;
  contacts.contacts[0].module_index = 1;
  contacts.contacts[0].position_m = {0, 0.03, 0};
  contacts.contacts[0].force_n = {1, -10, 2};
  newest.contacts = contacts;
  const auto state = page_state(newest);
  const double half = std::sqrt(0.5);  // the modules are turned by 90 degrees about z
  const std::vector<double> expected = {1.0, 1.5, std::numbers::pi / 2, 0.03, 0, 0, half, half};
  const auto tail = state.at("world").at("modules").at(1).get<std::vector<double>>();
  ASSERT_EQ(tail.size(), expected.size());
  for (std::size_t i = 0; i < expected.size(); ++i) EXPECT_NEAR(tail[i], expected[i], 1e-5) << i;
  EXPECT_EQ(state.at("world").at("objects").at(0).at("size_m"), nlohmann::json({0.08, 0.08, 0.15}));
  const std::vector<double> arrow = {1.0 - 0.03, 1.5, 0.03, 10, 1, 2};
  const auto drawn = state.at("contacts").at(0).get<std::vector<double>>();
  ASSERT_EQ(drawn.size(), arrow.size());
  for (std::size_t i = 0; i < arrow.size(); ++i) EXPECT_NEAR(drawn[i], arrow[i], 1e-5) << i;
}

TEST(Views, TheEstimateBeginsAtTheTruthAndThenShowsItsError) {
  Newest newest = example();
  msg::RobotPose pose{};
  pose.header.tick = 10;
  newest.pose = pose;
  align(newest);
  ASSERT_TRUE(newest.start);
  newest.pose->x_m = 0.5;  // the robot believes that it went straight on by 0.5 m
  const auto transforms = frame_transforms(newest, 0).at("transforms");
  const auto& estimated = transforms.at(2);
  EXPECT_EQ(estimated.at("child_frame_id"), "estimated head");
  EXPECT_NEAR(estimated.at("translation").at("x").get<double>(), 1.0, 1e-12);
  EXPECT_NEAR(estimated.at("translation").at("y").get<double>(), 2.5, 1e-12);
  newest.world->header.tick = 999;
  newest.start.reset();
  align(newest);
  EXPECT_FALSE(newest.start) << "poses of different times are not compared";
}

TEST(Views, ANewEpochShowsNothingOfTheOneBefore) {
  Newest newest;
  msg::WorldState world = *example().world;
  ASSERT_TRUE(keep_world(newest, world));
  newest.map.emplace();
  newest.line.emplace();
  newest.events.emplace_back();
  ++world.header.tick;
  ASSERT_TRUE(keep_world(newest, world));
  EXPECT_EQ(newest.heads.size(), 2u);
  EXPECT_TRUE(newest.map && newest.line && !newest.events.empty());
  ++world.header.epoch;
  ASSERT_TRUE(keep_world(newest, world));
  EXPECT_EQ(newest.heads.size(), 1u);
  EXPECT_FALSE(newest.map || newest.line || !newest.events.empty());
  world.module_poses[0].position_m.x = std::nan("");
  EXPECT_FALSE(keep_world(newest, world));
}

TEST(Views, WhatIsNotKnownIsLeftOut) {
  const Newest nothing;
  EXPECT_TRUE(scene_update(nothing, 0).at("entities").empty());
  EXPECT_TRUE(frame_transforms(nothing, 0).at("transforms").empty());
  const auto state = page_state(nothing);
  EXPECT_FALSE(state.contains("world"));
  EXPECT_TRUE(state.at("processes").empty());
}

TEST(Views, ThePageGetsNoNanAndOnlyWhatTheWorldHas) {
  Newest newest = example();
  msg::JointState joints{};
  joints.joint_count = 2;
  joints.torque_nm[1] = std::nan("");
  newest.joints = joints;
  newest.world->object_count = 5;  // more than the scene describes
  const auto state = page_state(newest);
  EXPECT_TRUE(state.at("torque_nm").at(1).is_null());
  EXPECT_EQ(state.at("world").at("objects").size(), 1u);
  EXPECT_EQ(state.dump().find("nan"), std::string::npos);
  msg::TaskEvent event{};
  event.goal_state = msg::kGoalAborted;
  set_text(event.detail, "no object");
  EXPECT_EQ(log_of(event, 0).at("level"), 3);
}

}  // namespace
}  // namespace constrictor::views
