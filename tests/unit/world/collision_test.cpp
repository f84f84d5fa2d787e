// Contact points compared with brute force and with ODE's own colliders.
#include "sim/world/collision.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "sim/world/ode_handles.hpp"

namespace constrictor {
namespace {

using Eigen::Vector3d;

struct RandomPoses {
  std::mt19937 generator{42};
  double number(double min, double max) { return std::uniform_real_distribution<double>(min, max)(generator); }
  Vector3d vector(double size) {
    const double x = number(-size, size);
    const double y = number(-size, size);
    return {x, y, number(-size, size)};
  }
  Eigen::Isometry3d pose(double size) {
    Eigen::Isometry3d result = Eigen::Isometry3d::Identity();
    result.translation() = vector(size);
    result.linear() = Eigen::AngleAxisd(number(0, 3), vector(1).normalized()).toRotationMatrix();
    return result;
  }
};

/// Distance of a point to a solid, from its definition.
double distance(const ConvexSolid& solid, const Vector3d& p_W) {
  const Vector3d p = solid.X_WS.inverse() * p_W;
  if (solid.shape == BodyShape::kBox) return (p.cwiseAbs() - 0.5 * solid.size_m).cwiseMax(0.0).norm();
  const double side = std::max(0.0, std::hypot(p.x(), p.y()) - solid.size_m.x());
  const double end = std::max(0.0, std::abs(p.z()) - 0.5 * solid.size_m.z());
  return std::hypot(side, end);
}

ConvexSolid solid_of(BodyShape shape, const Eigen::Isometry3d& pose) {
  return {shape, shape == BodyShape::kBox ? Vector3d(0.1, 0.2, 0.15) : Vector3d(0.085, 0.085, 0.15), pose};
}

TEST(Collision, CapsuleAndSolidTouchWhereSampledPointsDo) {
  RandomPoses random;
  int touched = 0;
  for (int trial = 0; trial < 4000; ++trial) {
    const ConvexSolid solid = solid_of(trial % 2 == 0 ? BodyShape::kBox : BodyShape::kCylinder, random.pose(0.1));
    const Eigen::Isometry3d X_WM = random.pose(0.15);
    const Capsule capsule{X_WM * Vector3d(0.0445, 0, 0), X_WM * Vector3d(-0.0445, 0, 0), 0.035};
    double least = 1.0;
    for (int i = 0; i <= 1000; ++i) {
      least = std::min(least, distance(solid, capsule.front + i * 1e-3 * (capsule.back - capsule.front)));
    }
    TouchPoints touches;
    touch_capsule_solid(capsule, solid, touches);
    if (least > 0.035 + 1e-6) {
      EXPECT_EQ(touches.size(), 0U);
      continue;
    }
    if (least < 1e-3) continue;  // the axis is inside the solid, which no task comes near
    ++touched;
    ASSERT_GE(touches.size(), 1U);
    double deepest = 0.0;
    for (const TouchPoint& touch : touches) {
      deepest = std::max(deepest, touch.depth_m);
      EXPECT_NEAR(touch.normal.norm(), 1.0, 1e-9);
      // The point lies on the solid. Its distance from the capsule's axis gives the depth.
      EXPECT_NEAR(distance(solid, touch.position_m), 0.0, 1e-9);
      EXPECT_NEAR(distance(solid, touch.position_m + touch.normal * (0.035 - touch.depth_m)), 0.035 - touch.depth_m,
                  1e-9);
    }
    EXPECT_NEAR(deepest, 0.035 - least, 2e-5);
  }
  EXPECT_GT(touched, 300);
}

/// Deepest contact of two geoms by ODE's colliders.
double ode_depth(const OdeGeom& first, const OdeGeom& second, Vector3d* normal = nullptr) {
  dContactGeom contacts[8];
  const int count = dCollide(first.get(), second.get(), 8, contacts, sizeof(dContactGeom));
  double deepest = 0.0;
  for (int i = 0; i < count; ++i) {
    if (contacts[i].depth <= deepest) continue;
    deepest = contacts[i].depth;
    if (normal != nullptr) *normal = Vector3d(contacts[i].normal[0], contacts[i].normal[1], contacts[i].normal[2]);
  }
  return deepest;
}

void pose_geom(const OdeGeom& geom, const Eigen::Isometry3d& pose) {
  const Eigen::Matrix3d& R = pose.linear();
  dMatrix3 rotation = {R(0, 0), R(0, 1), R(0, 2), 0, R(1, 0), R(1, 1), R(1, 2), 0, R(2, 0), R(2, 1), R(2, 2), 0};
  dGeomSetPosition(geom.get(), pose.translation().x(), pose.translation().y(), pose.translation().z());
  dGeomSetRotation(geom.get(), rotation);
}

TEST(Collision, CapsulesAgreeWithOde) {
  ensure_ode();
  RandomPoses random;
  const OdeGeom first(dCreateCapsule(nullptr, 0.035, 0.089));
  const OdeGeom second(dCreateCapsule(nullptr, 0.035, 0.089));
  int touched = 0;
  for (int trial = 0; trial < 2000; ++trial) {
    const Eigen::Isometry3d a = random.pose(0.06);
    const Eigen::Isometry3d b = random.pose(0.06);
    pose_geom(first, a);
    pose_geom(second, b);
    const auto capsule = [](const Eigen::Isometry3d& X) {
      return Capsule{X * Vector3d(0, 0, 0.0445), X * Vector3d(0, 0, -0.0445), 0.035};
    };
    TouchPoints touches;
    touch_capsules(capsule(a), capsule(b), touches);
    Vector3d normal = Vector3d::Zero();
    const double expected = ode_depth(first, second, &normal);
    if (expected < 1e-9) continue;
    ++touched;
    ASSERT_EQ(touches.size(), 1U);
    EXPECT_NEAR(touches[0].depth_m, expected, 1e-6);
    EXPECT_NEAR((touches[0].normal - normal).norm(), 0.0, 1e-3);
  }
  EXPECT_GT(touched, 500);
}

TEST(Collision, SolidsOnTheGroundAgreeWithOde) {
  ensure_ode();
  RandomPoses random;
  const OdeGeom plane(dCreatePlane(nullptr, 0, 0, 1, 0));
  const OdeGeom box(dCreateBox(nullptr, 0.1, 0.2, 0.15));
  const OdeGeom cylinder(dCreateCylinder(nullptr, 0.085, 0.15));
  for (int trial = 0; trial < 1000; ++trial) {
    const BodyShape shape = trial % 2 == 0 ? BodyShape::kBox : BodyShape::kCylinder;
    const Eigen::Isometry3d pose = random.pose(0.1);
    const OdeGeom& geom = shape == BodyShape::kBox ? box : cylinder;
    pose_geom(geom, pose);
    TouchPoints touches;
    touch_solid_ground(solid_of(shape, pose), touches);
    double deepest = 0.0;
    for (const TouchPoint& touch : touches) deepest = std::max(deepest, touch.depth_m);
    EXPECT_NEAR(deepest, ode_depth(geom, plane), 1e-9);
  }
}

TEST(Collision, AnUprightCylinderStandsOnFourPoints) {
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  pose.translation().z() = 0.0749;
  TouchPoints touches;
  touch_solid_ground(solid_of(BodyShape::kCylinder, pose), touches);
  ASSERT_EQ(touches.size(), 4U);
  Vector3d middle = Vector3d::Zero();
  for (const TouchPoint& touch : touches) middle += touch.position_m / 4;
  EXPECT_NEAR(middle.head<2>().norm(), 0.0, 1e-12);
}

TEST(Collision, ACapsuleLiesOnAWallWithBothEnds) {
  const ConvexSolid wall{BodyShape::kBox, {2.0, 0.1, 0.5}, Eigen::Isometry3d::Identity()};
  const Capsule capsule{{0.3, 0.08, 0}, {0.2, 0.08, 0}, 0.035};
  TouchPoints touches;
  touch_capsule_solid(capsule, wall, touches);
  ASSERT_EQ(touches.size(), 2U);
  EXPECT_NEAR(touches[0].depth_m, 0.005, 1e-12);
  EXPECT_NEAR(touches[1].normal.y(), 1.0, 1e-12);
}

}  // namespace
}  // namespace constrictor
