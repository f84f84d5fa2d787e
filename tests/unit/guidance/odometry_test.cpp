// The pose compared with motions that are known analytically.
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <numbers>

#include "guidance/guidance_config.hpp"
#include "guidance/odometry.hpp"
#include "guidance/pose_filter.hpp"
#include "robot/kinematics.hpp"
#include "robot/planar.hpp"
#include "snake.hpp"

namespace constrictor {
namespace {

using namespace guidance;
using testing::snake;

const OdometryConfig kConfig = GuidanceConfig{}.odometry;

/// The same with other guesses of the coefficients of friction. Without measured forces of the ground they stay.
OdometryConfig with_friction(double along, double across) {
  OdometryConfig config = kConfig;
  config.friction_along = along;
  config.friction_across = across;
  return config;
}

/// A body whose links are so short that it is nearly a curve.
RobotModel fine_snake() {
  RobotModel model;
  model.module_count = 48;
  model.module_length_m = 0.0445;
  model.module_mass_kg = 1e-3;  // almost no inertia
  model.joints.resize(47);
  return model;
}

/// A body of short links whose joints all lie on one path and slide along it: the ideal gait without lateral slip.
class SlidingBody {
 public:
  /// `heading`: of the path at a length.
  explicit SlidingBody(const std::function<double(double)>& heading) {
    points_.push_back({0.0, 0.0});
    for (int i = 1; i < 120000; ++i) {
      const double h = heading((i - 0.5) * kStep);
      points_.push_back(points_.back() + kStep * Eigen::Vector2d(std::cos(h), std::sin(h)));
    }
  }

  struct Snapshot {
    PlanarPose head;  // in the path's frame
    std::array<double, 47> q{};
  };

  /// With the head's joint at length `s`.
  [[nodiscard]] Snapshot at(double s) const {
    const double l = fine_snake().module_length_m;
    const Eigen::Vector2d nose = point(partner(s, l, 1.0));
    Eigen::Vector2d ahead = nose, here = point(s);
    Snapshot snapshot;
    const double head = angle(nose - here);
    double heading = head;
    for (double& q : snapshot.q) {
      s = partner(s, l, -1.0);
      ahead = here;
      here = point(s);
      const double next = angle(ahead - here);
      q = wrap_angle(heading - next);
      heading = next;
    }
    const Eigen::Vector2d centre = nose - 0.5 * l * along(head);
    snapshot.head = {centre, head};
    return snapshot;
  }

 private:
  static constexpr double kStep = 1e-4;
  static double angle(const Eigen::Vector2d& d) { return std::atan2(d.y(), d.x()); }
  [[nodiscard]] Eigen::Vector2d point(double s) const {
    const auto i = static_cast<std::size_t>(s / kStep);
    const double f = s / kStep - static_cast<double>(i);
    return (1.0 - f) * points_[i] + f * points_[i + 1];
  }
  /// Length of the point at distance `chord` before or behind.
  [[nodiscard]] double partner(double s, double chord, double sign) const {
    double a = chord, b = 1.5 * chord;
    for (int i = 0; i < 50; ++i) {
      const double m = 0.5 * (a + b);
      ((point(s + sign * m) - point(s)).norm() < chord ? a : b) = m;
    }
    return s + sign * 0.5 * (a + b);
  }
  std::vector<Eigen::Vector2d> points_;
};

struct Travel {
  double length_m, position_error_m, yaw_error_rad;
};

/// Slides the body by `length_m` at `speed_m_s` and dead-reckons with the filter's prediction.
Travel travel(const SlidingBody& body, double from, double length_m, double speed_m_s) {
  const RobotModel model = fine_snake();
  const OdometryConfig config = with_friction(0.0, 0.5);  // the ideal skin, on which a body slides along its own track
  const double dt = 0.02, h = 1e-3;
  PoseFilterState filter_state;
  PoseFilter filter(filter_state);
  OdometryState state;
  const SlidingBody::Snapshot start = body.at(from);
  SlidingBody::Snapshot now = start;
  const int ticks = static_cast<int>(length_m / (std::abs(speed_m_s) * dt));
  for (int k = 0; k <= ticks; ++k) {
    const double s = from + k * dt * speed_m_s;
    now = body.at(s);
    const auto ahead = body.at(s + h * speed_m_s), behind = body.at(s - h * speed_m_s);
    std::array<double, 47> rate{};
    for (std::size_t i = 0; i < rate.size(); ++i) rate[i] = (ahead.q[i] - behind.q[i]) / (2.0 * h);
    OdometryInput input;
    input.joint_rad = now.q.data();
    input.joint_rad_s = rate.data();
    input.yaw_rad = now.head.yaw_rad;
    const HeadStep step = advance_odometry(state, model, config, input);
    filter.predict(step.step_m, step.turn_rad, Eigen::Matrix3d::Zero());
  }
  const Eigen::Vector2d truth = start.head.to_local(now.head.p);
  const PlanarPose estimate = filter.pose();
  return {length_m, (estimate.p - truth).norm(),
          std::abs(wrap_angle(estimate.yaw_rad - (now.head.yaw_rad - start.head.yaw_rad)))};
}

/// Runs the odometry over the shapes q(t) of a snake that is at rest at first. Returns the final pose of the head in
/// its first frame.
PlanarPose run_shapes(const RobotModel& model, int ticks, const std::function<double(std::size_t, double)>& joint,
                      const std::function<double(double)>& yaw, const std::vector<double>& load_n = {},
                      const OdometryConfig& config = with_friction(0.05, 0.5)) {
  PoseFilterState filter_state;
  PoseFilter filter(filter_state);
  OdometryState state;
  const double dt = 0.02, h = 1e-5;
  for (int k = 0; k <= ticks; ++k) {
    std::array<double, 23> q{}, rate{};
    for (std::size_t i = 0; i < 23; ++i) {
      q[i] = joint(i, k * dt);
      rate[i] = (joint(i, k * dt + h) - joint(i, k * dt - h)) / (2.0 * h);
    }
    OdometryInput input;
    input.joint_rad = q.data();
    input.joint_rad_s = rate.data();
    input.yaw_rad = yaw(k * dt);
    input.load_n = load_n;
    const HeadStep step = advance_odometry(state, model, config, input);
    filter.predict(step.step_m, step.turn_rad, Eigen::Matrix3d::Zero());
  }
  return filter.pose();
}

TEST(Odometry, FollowsASlidingBodyStraightCurvedAndBackwards) {
  struct Case {
    double amplitude, wavelength, curvature;
  };
  for (const Case& c : {Case{0.5, 1.07, 0.0}, Case{0.5, 1.07, 0.5}, Case{0.35, 1.07, -0.8}, Case{0.6, 0.8, 0.0}}) {
    const SlidingBody body(
        [&](double s) { return c.amplitude * std::sin(2.0 * std::numbers::pi * s / c.wavelength) + c.curvature * s; });
    for (const double speed : {0.6, -0.4}) {
      const Travel t = travel(body, speed > 0 ? 3.0 : 9.0, 5.0, speed);
      EXPECT_LT(t.position_error_m, 0.03 * t.length_m)
          << "amplitude " << c.amplitude << ", curvature " << c.curvature << ", speed " << speed;
      EXPECT_LT(t.yaw_error_rad, 1e-6);
    }
  }
}

TEST(Odometry, StandsStillWhileTheBodyStandsStill) {
  const PlanarPose end = run_shapes(
      snake(), 200, [](std::size_t i, double) { return i % 2 == 0 ? 0.3 : 0.0; }, [](double) { return 0.4; });
  EXPECT_LT(end.p.norm(), 1e-9);
}

TEST(Odometry, BendingTheHeadMovesTheHeadNotTheBody) {
  // The other 23 modules lie straight and do not slip: the head turns about the first joint.
  const PlanarPose end = run_shapes(
      snake(), 100, [](std::size_t i, double t) { return i == 0 ? 0.3 * t : 0.0; }, [](double t) { return 0.3 * t; });
  const double half_m = 0.0445, angle = 0.6;
  EXPECT_NEAR(end.p.x(), half_m * (std::cos(angle) - 1.0), 0.004);
  EXPECT_NEAR(end.p.y(), half_m * std::sin(angle), 0.002);
  EXPECT_NEAR(end.yaw_rad, angle, 1e-9);
}

TEST(Odometry, ModulesWithoutLoadHaveNoFriction) {
  // The rear half swings. Only the front half touches the ground.
  std::vector<double> load(24, 0.0);
  for (std::size_t i = 0; i <= 10; ++i) load[i] = 6.0;
  const PlanarPose end = run_shapes(
      snake(), 100, [](std::size_t i, double t) { return i == 10 ? 0.2 * t : 0.0; }, [](double) { return 0.0; }, load);
  EXPECT_LT(end.p.norm(), 0.005);
}

TEST(Odometry, CentreOfMassStaysWithoutFriction) {
  // Momentum is conserved, whatever the joints do.
  const RobotModel ice = snake();
  const auto joint = [](std::size_t i, double t) {
    return i % 2 == 0 ? 0.4 * std::min(t, 1.0) * std::sin(4.0 * t - 0.6 * static_cast<double>(i)) : 0.0;
  };
  const auto yaw = [](double t) { return 0.3 * std::sin(2.0 * t); };
  const int ticks = 300;
  const PlanarPose end = run_shapes(ice, ticks, joint, yaw, {}, with_friction(0.0, 0.0));
  const auto centre = [&](const PlanarPose& head, double t) {
    std::array<double, 23> q{};
    for (std::size_t i = 0; i < 23; ++i) q[i] = joint(i, t);
    Eigen::Vector2d sum = Eigen::Vector2d::Zero();
    for (const PlanarPose& p : planar_module_poses(ice, q, head)) {
      sum += p.p / 24.0;
    }
    return sum;
  };
  EXPECT_LT((centre(end, 0.02 * ticks) - centre({}, 0.0)).norm(), 0.003);
}

TEST(Odometry, MeasuresTheFrictionOfTheGround) {
  // A driving body whose modules show a friction of 0.2 along themselves, and sideways 0 to 0.8 evenly spread, so that
  // the upper quartile is 0.6.
  const RobotModel model = snake();
  OdometryState state;
  std::array<double, 23> q{}, rate{};
  for (int k = 0; k < 3000; ++k) {
    OdometryInput input;
    input.joint_rad = q.data();
    input.joint_rad_s = rate.data();
    input.push_n = {12.0, 0.0};  // keeps the body driving, although it does not undulate
    for (int i = 0; i < 24; ++i) {
      const double sideways = 0.8 * ((7 * i + 5 * k) % 24 + 0.5) / 24.0;
      input.ground.push_back({i % 2 == 0 ? -0.6 : 0.6, 3.0 * sideways, 3.0});
    }
    input.ground[3].normal_n = std::nan("");  // something else touches this module, too
    input.ground[3].along_n = 100.0;
    advance_odometry(state, model, with_friction(0.05, 0.3), input);
  }
  EXPECT_NEAR(state.friction_along, 0.2, 0.01);
  EXPECT_NEAR(state.friction_across, 0.6, 0.05);
}

TEST(Odometry, ARobotAtRestMeasuresNoFriction) {
  const RobotModel model = snake();
  OdometryState state;
  std::array<double, 23> q{}, rate{};
  for (int k = 0; k < 500; ++k) {
    OdometryInput input;
    input.joint_rad = q.data();
    input.joint_rad_s = rate.data();
    input.ground.assign(24, {0.01, 0.02, 3.0});
    advance_odometry(state, model, with_friction(0.05, 0.3), input);
  }
  EXPECT_EQ(state.friction_along, 0.05);
  EXPECT_EQ(state.friction_across, 0.3);
}

}  // namespace
}  // namespace constrictor
