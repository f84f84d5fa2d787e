// What the inertial unit measures on a slope, against the direction of gravity.
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>

#include "sim/physics/sensors.hpp"
#include "support/project.hpp"

namespace constrictor {
namespace {

using Eigen::Vector3d;

Scenario slope(double angle_rad, double uphill_rad) {
  Scenario scenario;
  scenario.gravity_m_s2 = -9.81 * Vector3d(std::sin(angle_rad) * std::cos(uphill_rad),
                                           std::sin(angle_rad) * std::sin(uphill_rad), std::cos(angle_rad));
  return scenario;
}

TEST(Slope, TheInertialUnitMeasuresItsAttitudeRelativeToGravity) {
  const RobotModel robot = load_robot(testing::robot_path("mamba"));
  for (const double uphill_rad : {0.0, 1.2, -2.5}) {
    const double angle_rad = 0.04;  // the robot does not slide: the skin holds 0.05
    World world(robot, slope(angle_rad, uphill_rad));
    Sensors sensors(robot, 1, false);
    msg::ImuState imu{};
    for (int tick = 0; tick < 100; ++tick) {
      world.advance(0.02);
      imu = sensors.imu(world, 0.02);
    }
    const Eigen::Quaterniond q(imu.orientation.w, imu.orientation.x, imu.orientation.y, imu.orientation.z);
    const auto& a = imu.linear_acceleration_m_s2;
    EXPECT_NEAR((q * Vector3d(a.x, a.y, a.z) - Vector3d(0.0, 0.0, 9.81)).norm(), 0.0, 0.02)
        << "at rest, orientation and acceleration agree about what is up";
    const Eigen::Matrix3d R_WHead = world.module_pose(0).linear();
    const Vector3d up = -slope(angle_rad, uphill_rad).gravity_m_s2.normalized();
    for (int axis = 0; axis < 3; ++axis)
      EXPECT_NEAR((q * Vector3d::Unit(axis)).z(), R_WHead.col(axis).dot(up), 1e-9) << "how far each axis points up";
    EXPECT_NEAR(std::acos((q * Vector3d::UnitZ()).z()), angle_rad, 5e-3) << "the head lies on the slope";
    EXPECT_NEAR(q.norm(), 1.0, 1e-12);
    // The head looks along the x axis of W: it looks up if the slope rises there.
    EXPECT_NEAR(std::asin((q * Vector3d::UnitX()).z()), angle_rad * std::cos(uphill_rad), 5e-3);
  }
}

}  // namespace
}  // namespace constrictor
