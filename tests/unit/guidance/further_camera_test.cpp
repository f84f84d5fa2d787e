// Percepts of further cameras in the map and in the pose.
#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <numbers>
#include <vector>

#include "barrier/local_run.hpp"
#include "component/data_path.hpp"
#include "guidance/guidance.hpp"
#include "mapping.hpp"
#include "still_plant.hpp"
#include "support/scripted_members.hpp"

namespace constrictor {
namespace {

using namespace guidance;
using testing::Mapping;

constexpr double kPi = std::numbers::pi;

/// A map of a robot with a camera that looks back, 0.02 m behind the centre of the head and 0.115 m above the ground.
struct RearMapping : Mapping {
  RearMapping() {
    CameraModel rear = model.camera;
    rear.name = "rear";
    rear.p_HC = {-0.02, 0.0, 0.08};
    rear.yaw_rad = kPi;
    rear.tilt_rad = 0.3;
    model.further_cameras = {rear};
  }
  /// A percept of something at a place in the head's frame.
  static msg::ObjectPercepts behind(std::uint8_t kind, double x, double y, double radius) {
    msg::ObjectPercepts percepts{};
    percepts.camera = 1;
    percepts.X_GV = {-0.02, 0.0, kPi};
    percepts.blob_count = 1;
    percepts.blobs[0] = blob(msg::kColourRed, kind, -(x + 0.02), -y, radius);
    return percepts;
  }
  void look_back(const msg::ObjectPercepts& percepts, int times) {
    for (int i = 0; i < times; ++i) {
      mapper.objects(percepts, {}, tick += 5);
      mapper.doubt(percepts, {}, chain(), level, tick, 0.02);
    }
  }
};

TEST(FurtherCameraMap, AnObjectBehindTheRobotIsWhereTheRearCameraSeesIt) {
  RearMapping m;
  m.look_back(RearMapping::behind(msg::kBlobObject, -1.0, 0.5, 0.08), 5);
  const msg::FieldMap map = m.map();
  ASSERT_EQ(map.object_count, 1);
  EXPECT_NEAR(map.objects[0].x_m, -1.0, 1e-9);
  EXPECT_NEAR(map.objects[0].y_m, 0.5, 1e-9);
  EXPECT_NEAR(map.objects[0].radius_m, 0.08, 1e-9);
}

TEST(FurtherCameraMap, BothCamerasSeeTheSameLandmark) {
  RearMapping m;
  m.look({Mapping::blob(msg::kColourRed, msg::kBlobObject, 1.0, 0.2, 0.08)}, 5);
  // The robot turns about: the object is behind it now.
  m.filter.predict({0.0, 0.0}, kPi, Eigen::Matrix3d::Zero());
  m.look_back(RearMapping::behind(msg::kBlobObject, -1.0, -0.2, 0.08), 5);
  ASSERT_EQ(m.map().object_count, 1);
  EXPECT_EQ(m.map().objects[0].handle, 1);
  EXPECT_NEAR(m.map().objects[0].x_m, 1.0, 1e-9);
}

// The range is known less well than the direction. A camera that looks to the left measures y of an object on the left
// less well than x.
TEST(FurtherCameraMap, TheUncertaintyLiesAlongTheLineOfSight) {
  Mapping m;
  m.model.further_cameras = {m.model.camera};
  msg::ObjectPercepts percepts{};
  percepts.camera = 1;
  percepts.X_GV = {0.0, 0.0, 0.5 * kPi};
  percepts.blob_count = 1;
  percepts.blobs[0] = Mapping::blob(msg::kColourRed, msg::kBlobObject, 2.0, 0.0, 0.08);
  m.mapper.objects(percepts, {}, 5);
  EXPECT_NEAR(m.filter.landmark(0).x(), 0.0, 1e-9);
  EXPECT_NEAR(m.filter.landmark(0).y(), 2.0, 1e-9);
  const Eigen::Matrix2d P = m.filter.landmark_covariance(0);
  EXPECT_GT(P(1, 1), 4.0 * P(0, 0));
}

TEST(FurtherCameraMap, ALandmarkThatTheRearCameraMissesIsGivenUp) {
  RearMapping m;
  m.look_back(RearMapping::behind(msg::kBlobObject, -1.0, 0.5, 0.08), 50);
  ASSERT_EQ(m.map().object_count, 1);
  auto nothing = RearMapping::behind(msg::kBlobObject, 0, 0, 0);
  nothing.blob_count = 0;
  nothing.blobs[0] = {};
  m.look({}, 100);  // the head's camera does not look there
  EXPECT_EQ(m.map().object_count, 1);
  m.look_back(nothing, 100);
  EXPECT_EQ(m.map().object_count, 0);
}

TEST(FurtherCameraMap, TheOwnBodyHidesWhatIsBehindIt) {
  RearMapping m;
  auto nothing = RearMapping::behind(msg::kBlobObject, 0, 0, 0);
  nothing.blob_count = 0;
  nothing.blobs[0] = {};
  m.look_back(RearMapping::behind(msg::kBlobObject, -1.5, 0.05, 0.08), 50);
  m.look_back(nothing, 200);
  EXPECT_EQ(m.map().object_count, 1) << "the straight body lies in front of it";
}

TEST(FurtherCameraMap, WhatOneCameraSeesAnotherDoesNotDoubtAtTheSameTick) {
  RearMapping m;
  m.look_back(RearMapping::behind(msg::kBlobObject, -1.0, 0.5, 0.08), 20);
  auto nothing = RearMapping::behind(msg::kBlobObject, 0, 0, 0);
  nothing.blob_count = 0;
  nothing.blobs[0] = {};
  for (int i = 0; i < 100; ++i) {
    m.look({Mapping::blob(msg::kColourRed, msg::kBlobObject, -1.0, 0.5, 0.08)}, 1);  // as if the head saw it
    m.mapper.objects(nothing, {}, m.tick);
    m.mapper.doubt(nothing, {}, m.chain(), true, m.tick, 0.02);
  }
  EXPECT_EQ(m.map().object_count, 1);
}

TEST(FurtherCameraMap, TheLineBehindTheRobotIsMapped) {
  RearMapping m;
  msg::LinePercept line{};
  line.camera = 1;
  line.X_GV = {-0.02, 0.0, kPi};
  line.visible = true;
  line.colour = msg::kColourBlue;
  line.point_count = 8;
  for (int i = 0; i < 8; ++i) {
    line.x_m[i] = 0.2 + 0.08 * i;
    line.y_m[i] = 0.1;
  }
  m.mapper.line(line, {}, 100, 0.02);
  const msg::FieldMap map = m.map();
  ASSERT_EQ(map.line_point_count, 8);
  for (int i = 0; i < 8; ++i) {
    EXPECT_NEAR(map.line_x_m[i], -0.02 - (0.2 + 0.08 * i), 1e-9);
    EXPECT_NEAR(map.line_y_m[i], -0.1, 1e-9);
  }
}

/// A still robot with two cameras; the rear one reports an object and, at some ticks, what it cannot.
std::unique_ptr<LocalRun> make_run_with_rear_camera() {
  Setup setup;
  setup.robot_file = data_path("components/lib/robot/mamba_two_cameras.yaml");
  const auto eyes =
      testing::scripted_member("perception",
                               [](Wiring& wiring) -> testing::StepFunction {
                                 return [out = wiring.output(topics::kFurtherObjectPercepts)](const Tick& tick) {
                                   auto percepts = RearMapping::behind(msg::kBlobObject, -1.0, 0.5, 0.08);
                                   percepts.exposure_tick = tick.index;
                                   if (tick.index == 30) percepts.camera = 2;
                                   if (tick.index == 40) percepts.X_GV.x_m = 1e6;
                                   out.write(percepts);
                                 };
                               },
                               {5, 1});
  return std::make_unique<LocalRun>(std::vector{testing::still_plant(), eyes, make_guidance_factory()}, setup);
}

TEST(GuidanceWithFurtherCameras, MapsWhatTheySeeAndRefusesWhatTheyCannot) {
  auto run = make_run_with_rear_camera();
  run->advance(61);
  const msg::FieldMap* map = run->latest(topics::kFieldMap);
  ASSERT_NE(map, nullptr);
  ASSERT_EQ(map->object_count, 1);
  EXPECT_NEAR(map->objects[0].x_m, -1.0, 1e-6);
  EXPECT_NEAR(map->objects[0].y_m, 0.5, 1e-6);
  EXPECT_EQ(run->member("guidance").counters().refused, 2U);
  EXPECT_EQ(run->member("guidance").counters().last_refusal,
            "perception/further/objects.X_GV: accepted -100 to 100 m and -6.3 to 6.3 rad");
}

TEST(GuidanceWithFurtherCameras, RestartChangesNothing) {
  auto whole = make_run_with_rear_camera(), broken = make_run_with_rear_camera();
  whole->advance(50);
  for (int i = 0; i < 50; ++i) {
    broken->advance(1);
    if (i == 6 || i == 21 || i == 22) broken->restart("guidance");
  }
  EXPECT_EQ(whole->output_hashes(), broken->output_hashes());
}

}  // namespace
}  // namespace constrictor
