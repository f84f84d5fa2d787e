// The room beside an object, compared with the nearest of many points of the way of the head.
#include "navigation/passing_room.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "task_setting.hpp"

namespace constrictor {
namespace {

class PassingRoom : public ::testing::Test {
 protected:
  static constexpr double kPassing_m = 0.17, kRadius_m = 0.085;
  TaskSetting setting_;
  const PlanarPose X_MP_{{2.0, 1.0}, 0.5};  // the object, with the course of the passing line

  double room_m(double side) {
    setting_.parameters.object_colour = msg::kColourGreen;
    return passing_room_m(setting_.input(), X_MP_, side, kPassing_m, kRadius_m);
  }
  void stand_at(std::uint8_t colour, const Eigen::Vector2d& p_P, double radius_m) {
    Sighting& other = setting_.sightings.objects[colour];
    const Eigen::Vector2d p_M = X_MP_.to_parent(p_P);
    other.known = true;
    other.x_m = p_M.x();
    other.y_m = p_M.y();
    other.radius_m = radius_m;
  }
  void feel_at(const Eigen::Vector2d& p_P) {
    const Eigen::Vector2d p_M = X_MP_.to_parent(p_P);
    setting_.map.obstacle_x_m[setting_.map.obstacle_count] = p_M.x();
    setting_.map.obstacle_y_m[setting_.map.obstacle_count++] = p_M.y();
  }
  /// The lane beside the object from 0.9 m before it to 0.3 m beyond it, the turn 0.25 m beyond it, and on its other
  /// side the way from 0.9 to 1.8 m before it, on which the wrapping body comes back.
  static double sampled_m(double side, const Eigen::Vector2d& p_P) {
    double least_m = (p_P - Eigen::Vector2d(0.25, 0.0)).norm();
    for (double x_m = -0.9; x_m <= 0.3; x_m += 1e-4)
      least_m = std::min(least_m, (p_P - Eigen::Vector2d(x_m, -side * kPassing_m)).norm());
    for (double x_m = -1.8; x_m <= -0.9; x_m += 1e-4)
      least_m = std::min(least_m, (p_P - Eigen::Vector2d(x_m, side * kPassing_m)).norm());
    return least_m;
  }
};

TEST_F(PassingRoom, IsUnlimitedInAnEmptyField) {
  EXPECT_TRUE(std::isinf(room_m(1.0)));
  stand_at(msg::kColourGreen, {0.0, 0.0}, kRadius_m);  // the object itself
  EXPECT_TRUE(std::isinf(room_m(1.0)));
}

TEST_F(PassingRoom, IsTheLeastDistanceToOtherObjectsAndFeltObstacles) {
  for (const Eigen::Vector2d& p_P : {Eigen::Vector2d(-0.5, -0.4), {0.6, 0.1}, {-1.4, 0.3}, {0.1, 0.5}}) {
    for (const double side : {1.0, -1.0}) {
      stand_at(msg::kColourRed, p_P, 0.06);
      EXPECT_NEAR(room_m(side), sampled_m(side, p_P) - 0.06, 1e-3);
      setting_.sightings = {};
      feel_at(p_P);
      EXPECT_NEAR(room_m(side), sampled_m(side, p_P), 1e-3);
      setting_.map.obstacle_count = 0;
    }
  }
}

TEST_F(PassingRoom, AnotherObjectOfTheSameColourIsInTheWayToo) {
  const auto map_at = [&](std::size_t i, const Eigen::Vector2d& p_P, std::uint8_t kind) {
    const Eigen::Vector2d p_M = X_MP_.to_parent(p_P);
    msg::MapObject& landmark = setting_.map.objects[i];
    landmark = {};
    landmark.handle = static_cast<std::uint16_t>(i + 1);
    landmark.colour = msg::kColourGreen;
    landmark.kind = kind;
    landmark.x_m = p_M.x();
    landmark.y_m = p_M.y();
    landmark.radius_m = 0.06;
    setting_.map.object_count = static_cast<std::uint16_t>(i + 1);
  };
  map_at(0, {0.1, -0.1}, msg::kBlobObject);  // the object itself, where the map has it
  map_at(1, {0.5, 0.0}, msg::kBlobZone);
  EXPECT_TRUE(std::isinf(room_m(1.0)));
  for (const Eigen::Vector2d& p_P : {Eigen::Vector2d(-0.5, -0.4), {0.6, 0.1}}) {
    map_at(2, p_P, msg::kBlobObject);
    for (const double side : {1.0, -1.0}) EXPECT_NEAR(room_m(side), sampled_m(side, p_P) - 0.06, 1e-3);
  }
}

TEST_F(PassingRoom, WhatWasFeltAtTheObjectIsTheObject) {
  feel_at({0.05, 0.06});
  EXPECT_TRUE(std::isinf(room_m(1.0)));
  feel_at({-0.3, -0.2});
  EXPECT_LT(room_m(1.0), room_m(-1.0)) << "the obstacle stands in the lane on the right";
}

TEST_F(PassingRoom, AWallOnTheWayBackLeavesMoreRoomOnTheOtherSide) {
  feel_at({-1.6, -0.3});
  EXPECT_LT(room_m(-1.0), room_m(1.0)) << "with the object on its right, the body comes back on the right";
}

}  // namespace
}  // namespace constrictor
