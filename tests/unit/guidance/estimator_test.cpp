// Pose and map against motions and scenes that are known analytically.
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>
#include <numbers>

#include "guidance/field_mapper.hpp"
#include "guidance/odometry.hpp"
#include "guidance/planar.hpp"

namespace constrictor {
namespace {

using namespace guidance;

constexpr double kPi = std::numbers::pi;
constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

RobotModel snake() {
  RobotModel model;
  model.module_count = 24;
  model.module_length_m = 0.089;
  model.module_radius_m = 0.035;
  model.module_mass_kg = 0.3;
  model.joints.resize(23);
  for (std::size_t i = 0; i < 23; ++i) model.joints[i].axis = i % 2 == 0 ? JointAxis::kYaw : JointAxis::kPitch;
  return model;
}

/// A body with so short links that it nearly is a curve.
RobotModel fine_snake() {
  RobotModel model;
  model.module_count = 48;
  model.module_length_m = 0.0445;
  model.module_mass_kg = 1e-3;  // next to no inertia
  model.friction_along = 0.0;   // the ideal skin, on which a body slides along its own track
  model.joints.resize(47);
  return model;
}

/// A fine body whose joints all lie on one path and slide along it: the ideal gait without lateral slip.
class SlidingBody {
 public:
  /// `heading`: of the path at a length.
  explicit SlidingBody(std::function<double(double)> heading) {
    points_.push_back({0.0, 0.0});
    for (int i = 1; i < 120000; ++i) {
      const double h = heading((i - 0.5) * kStep);
      points_.push_back(points_.back() + kStep * Eigen::Vector2d(std::cos(h), std::sin(h)));
    }
  }

  struct Snapshot {
    Pose2 head;  // in the path's frame
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
      q = wrapped(heading - next);
      heading = next;
    }
    const Eigen::Vector2d centre = nose - 0.5 * l * along(head);
    snapshot.head = {centre.x(), centre.y(), head};
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
    const HeadStep step = advance_odometry(state, model, {}, input);
    filter.predict(step.step_m, step.turn_rad, Eigen::Matrix3d::Zero());
  }
  const Eigen::Vector2d truth = from_parent(start.head, now.head.position());
  const Pose2 estimate = filter.pose();
  return {length_m, (estimate.position() - truth).norm(),
          std::abs(wrapped(estimate.yaw_rad - (now.head.yaw_rad - start.head.yaw_rad)))};
}

/// Runs the odometry over shapes q(t) of the snake at rest at first; returns the head's path's end in its first frame.
Pose2 run_shapes(const RobotModel& model, int ticks, const std::function<double(std::size_t, double)>& joint,
                 const std::function<double(double)>& yaw, std::vector<double> load_n = {}) {
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
    const HeadStep step = advance_odometry(state, model, {}, input);
    filter.predict(step.step_m, step.turn_rad, Eigen::Matrix3d::Zero());
  }
  return filter.pose();
}

TEST(Odometry, FollowsASlidingBodyStraightCurvedAndBackwards) {
  struct Case { double amplitude, wavelength, curvature; };
  for (const Case& c : {Case{0.5, 1.07, 0.0}, Case{0.5, 1.07, 0.5}, Case{0.35, 1.07, -0.8}, Case{0.6, 0.8, 0.0}}) {
    const SlidingBody body([&](double s) { return c.amplitude * std::sin(2.0 * kPi * s / c.wavelength) + c.curvature * s; });
    for (const double speed : {0.6, -0.4}) {
      const Travel t = travel(body, speed > 0 ? 3.0 : 9.0, 5.0, speed);
      EXPECT_LT(t.position_error_m, 0.03 * t.length_m) << "amplitude " << c.amplitude << ", curvature " << c.curvature
                                                       << ", speed " << speed;
      EXPECT_LT(t.yaw_error_rad, 1e-6);
    }
  }
}

TEST(Odometry, StandsStillWhileTheBodyDoes) {
  const Pose2 end = run_shapes(snake(), 200, [](std::size_t i, double) { return i % 2 == 0 ? 0.3 : 0.0; },
                               [](double) { return 0.4; });
  EXPECT_LT(end.position().norm(), 1e-9);
}

TEST(Odometry, BendingTheHeadMovesTheHeadNotTheBody) {
  // the other 23 modules lie straight and hold the ground: the head turns about the first joint
  const Pose2 end = run_shapes(snake(), 100, [](std::size_t i, double t) { return i == 0 ? 0.3 * t : 0.0; },
                               [](double t) { return 0.3 * t; });
  const double half_m = 0.0445, angle = 0.6;
  EXPECT_NEAR(end.x_m, half_m * (std::cos(angle) - 1.0), 0.004);
  EXPECT_NEAR(end.y_m, half_m * std::sin(angle), 0.002);
  EXPECT_NEAR(end.yaw_rad, angle, 1e-9);
}

TEST(Odometry, ModulesThatBearNoLoadDoNotHold) {
  // the rear swings; only the front half touches the ground
  std::vector<double> load(24, 0.0);
  for (std::size_t i = 0; i <= 10; ++i) load[i] = 6.0;
  const Pose2 end = run_shapes(snake(), 100, [](std::size_t i, double t) { return i == 10 ? 0.2 * t : 0.0; },
                               [](double) { return 0.0; }, load);
  EXPECT_LT(end.position().norm(), 0.005);
}

TEST(Odometry, WithoutFrictionTheCentreOfMassStays) {
  // conservation of momentum: whatever the joints do
  RobotModel ice = snake();
  ice.friction_along = ice.friction_across = 0.0;
  const auto joint = [](std::size_t i, double t) {
    return i % 2 == 0 ? 0.4 * std::min(t, 1.0) * std::sin(4.0 * t - 0.6 * static_cast<double>(i)) : 0.0;
  };
  const auto yaw = [](double t) { return 0.3 * std::sin(2.0 * t); };
  const int ticks = 300;
  const Pose2 end = run_shapes(ice, ticks, joint, yaw);
  const auto centre = [&](const Pose2& head, double t) {
    std::array<double, 23> q{};
    for (std::size_t i = 0; i < 23; ++i) q[i] = joint(i, t);
    Eigen::Vector2d sum = Eigen::Vector2d::Zero();
    for (const PlanarPose& p : planar_module_poses(ice, q, {head.x_m, head.y_m, head.yaw_rad})) {
      sum += Eigen::Vector2d(p.x_m, p.y_m) / 24.0;
    }
    return sum;
  };
  EXPECT_LT((centre(end, 0.02 * ticks) - centre({}, 0.0)).norm(), 0.003);
}

TEST(PoseFilter, LandmarksSeenAgainTakeBackTheDrift) {
  // a square of 2 m with odometry that believes each step 5 % too long and turns 2 % too far
  PoseFilterState state;
  PoseFilter filter(state);
  const Eigen::Vector2d landmarks[] = {{1.0, 0.8}, {1.5, -0.6}};
  const Eigen::Matrix2d noise = 0.02 * 0.02 * Eigen::Matrix2d::Identity();
  Pose2 truth;
  filter.add(landmarks[0], noise);
  filter.add(landmarks[1], noise);
  for (int side = 0; side < 4; ++side) {
    for (int k = 0; k < 100; ++k) {
      const Eigen::Vector2d step(0.02, 0.0);
      const double turn = k < 50 ? kPi / 100.0 : 0.0;
      const Eigen::Vector2d p = to_parent(truth, turned(step, 0.5 * turn));
      truth = {p.x(), p.y(), wrapped(truth.yaw_rad + turn)};
      filter.predict(1.05 * step, 1.02 * turn, Eigen::Vector3d(1e-5, 1e-6, 1e-5).asDiagonal());
    }
  }
  const double before = (filter.pose().position() - truth.position()).norm();
  const double spread = filter.pose_covariance().trace();
  for (int k = 0; k < 5; ++k) {
    for (std::size_t i = 0; i < 2; ++i) filter.observe(i, from_parent(truth, landmarks[i]), noise);
  }
  EXPECT_GT(before, 0.1);
  EXPECT_LT((filter.pose().position() - truth.position()).norm(), 0.02);
  EXPECT_LT(std::abs(wrapped(filter.pose().yaw_rad - truth.yaw_rad)), 0.02);
  EXPECT_LT(filter.pose_covariance().trace(), spread);
  const Eigen::Vector2d second = filter.landmark(1);
  filter.remove(0);
  EXPECT_EQ(filter.landmark_count(), 1u);
  EXPECT_EQ(filter.landmark(0), second);
}

/// A map with the robot standing at the origin.
struct Mapping {
  RobotModel model = snake();
  GuidanceConfig config;
  FieldState state;
  PoseFilterState filter_state;
  PoseFilter filter{filter_state};
  FieldMapper mapper{state, filter, model, config};
  std::array<double, 23> q{};
  std::int64_t tick = 0;

  static msg::Blob blob(std::uint8_t colour, std::uint8_t kind, double x, double y, double radius) {
    msg::Blob b{};
    b.colour = colour;
    b.kind = kind;
    b.bearing_rad = std::atan2(y, x);
    b.range_m = std::hypot(x, y) - radius;
    b.width_m = 2.0 * radius;
    return b;
  }
  void see(std::initializer_list<msg::Blob> blobs, int times = 1, Pose2 exposure = {}) {
    msg::ObjectPercepts percepts{};
    for (const msg::Blob& b : blobs) percepts.blobs[percepts.blob_count++] = b;
    for (int i = 0; i < times; ++i) mapper.objects(percepts, exposure, tick += 5);
  }
  [[nodiscard]] BodyChain chain() const { return planar_module_poses(model, q); }
  [[nodiscard]] msg::FieldMap map() const {
    msg::FieldMap m{};
    mapper.fill(m);
    return m;
  }
};

TEST(Map, EachThingGetsOneHandleThatItKeeps) {
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

TEST(Map, PerceptsWithoutRangeOrNonFinitePlaceNothing) {
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

TEST(Map, ALateImageIsPlacedWhereItWasTaken) {
  Mapping m;
  // the head has turned by 0.2 rad and moved by 0.1 m since the exposure
  m.filter.predict({0.1, 0.0}, 0.2, Eigen::Matrix3d::Zero());
  const Eigen::Vector2d back = from_parent(m.filter.pose(), {0.0, 0.0});
  m.see({Mapping::blob(msg::kColourRed, msg::kBlobObject, 1.0, 0.0, 0.08)}, 4, {back.x(), back.y(), -0.2});
  ASSERT_EQ(m.map().object_count, 1);
  EXPECT_NEAR(m.map().objects[0].x_m, 1.0, 0.01);
  EXPECT_NEAR(m.map().objects[0].y_m, 0.0, 0.01);
}

TEST(Map, AMovedObjectKeepsItsHandle) {
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
  EXPECT_EQ(m.map().felt_count, 0);
  EXPECT_FALSE(m.map().objects[0].felt);

  // bent into a hairpin the tail half lies beside the front half: its touch is the robot's own
  Mapping self;
  for (std::size_t i = 8; i <= 14; i += 2) self.q[i] = kPi / 4.0;
  const BodyChain chain = self.chain();
  std::size_t across = 0;
  double nearest = 1e9;
  for (std::size_t j = 15; j < 24; ++j) {
    const double apart = std::hypot(chain[j].x_m - chain[7].x_m, chain[j].y_m - chain[7].y_m);
    if (apart < nearest) {
      nearest = apart;
      across = j;
    }
  }
  const Eigen::Vector2d toward = turned(
      Eigen::Vector2d(chain[across].x_m - chain[7].x_m, chain[across].y_m - chain[7].y_m), -chain[7].yaw_rad);
  msg::ContactState own{};
  own.module_count = 24;
  own.contact_count = 1;
  own.contacts[0].module_index = 7;
  const Eigen::Vector2d at = toward - 0.03 * toward.normalized();  // on the other module's skin
  own.contacts[0].position_m = {at.x(), at.y(), 0.0};
  own.contacts[0].normal = {-toward.normalized().x(), -toward.normalized().y(), 0.0};
  own.contacts[0].force_n = {1.0, 1.0, 0.0};
  self.mapper.touch(own, chain, 100, 0.02);
  EXPECT_EQ(self.map().felt_count, 0);

  contacts = {};
  contacts.module_count = 24;
  add(0, 0.035, -1.0, 0.0);
  contacts.contacts[0].position_m = {0.1, 0.045, 0.0};  // toward the object at (0.15, 0.12)
  m.mapper.touch(contacts, m.chain(), 101, 0.02);
  EXPECT_EQ(m.map().felt_count, 1);
  EXPECT_TRUE(m.map().objects[0].felt);
  m.mapper.touch(contacts, m.chain(), 102, 0.02);
  EXPECT_EQ(m.map().felt_count, 1);  // the same contact, still
  m.mapper.touch({}, m.chain(), 102 + 1000, 0.02);
  EXPECT_EQ(m.map().felt_count, 0);  // forgotten
}

TEST(Map, APushedObjectDoesNotPushThePose) {
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
  // it slid away by 0.15 m while the head stood still
  m.see({Mapping::blob(msg::kColourGreen, msg::kBlobObject, 0.15, 0.27, 0.08)}, 20);
  ASSERT_EQ(m.map().object_count, 1);
  EXPECT_NEAR(m.map().objects[0].y_m, 0.27, 0.03);
  EXPECT_LT(m.filter.pose().position().norm(), 0.03);
}

TEST(Map, ACarriedObjectMovesWithTheBody) {
  Mapping m;
  for (const std::size_t i : {10u, 12u, 14u}) m.q[i] = kPi / 3.0;
  // the object in the bend, at the base: place it by an independent construction, the centre of the arc's circle
  const BodyChain chain = m.chain();
  const Eigen::Vector2d base(chain[13].x_m, chain[13].y_m);
  const double heading = chain[13].yaw_rad;
  const Eigen::Vector2d object = base + 0.115 * Eigen::Vector2d(-std::sin(heading), std::cos(heading));
  m.see({Mapping::blob(msg::kColourGreen, msg::kBlobObject, object.x(), object.y(), 0.08),
         Mapping::blob(msg::kColourRed, msg::kBlobObject, object.x() + 0.7, object.y(), 0.08)}, 5);
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
}

TEST(Map, TheLineIsKeptOnceAndHoldsTheRobotOnIt) {
  Mapping m;
  msg::LinePercept line{};
  line.visible = true;
  line.colour = msg::kColourBlue;
  line.point_count = 32;
  for (int i = 0; i < 32; ++i) {
    line.x_m[i] = 0.1 + 0.025 * i;
    line.y_m[i] = 0.05;
  }
  for (int k = 0; k < 20; ++k) m.mapper.line(line, {}, k * 5, 0.02);
  EXPECT_GE(m.map().line_point_count, 12);
  EXPECT_LE(m.map().line_point_count, 20);
  // later the odometry has drifted sideways by 0.1 m; the line is seen where it always was
  m.filter.predict({0.0, 0.1}, 0.0, Eigen::Vector3d(1e-4, 1e-2, 1e-4).asDiagonal());
  for (int k = 0; k < 20; ++k) m.mapper.line(line, {}, 2000 + k * 5, 0.02);
  EXPECT_NEAR(m.filter.pose().y_m, 0.0, 0.03);
  EXPECT_LE(m.map().line_point_count, 24);
}

}  // namespace
}  // namespace constrictor
