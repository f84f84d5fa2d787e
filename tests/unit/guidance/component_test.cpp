// The component in a run: the rate of its outputs, bad samples, restarts.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <memory>

#include "barrier/local_run.hpp"
#include "component/data_path.hpp"
#include "guidance/guidance.hpp"
#include "support/scripted_members.hpp"

namespace constrictor {
namespace {

/// Joints that undulate. Their angles are not finite between ticks 40 and 45, and impossible in ticks 50 to 52.
template <bool kImu>
class Snake : public testing::PlantBase {
 public:
  Snake(Wiring& wiring, const Setup&)
      : joints_(wiring.output(topics::kJointState)), imu_(wiring.output(topics::kImuState)) {}
  void sample(const Tick& tick) override {
    msg::JointState joints{};
    joints.joint_count = 23;
    const double phase = 2.0 * 3.14159265 * 0.7 * tick.time_s();
    for (int i = 0; i < 23; i += 2) {
      joints.position_rad[i] = 0.5 * std::sin(phase - 0.5 * i);
      joints.velocity_rad_s[i] = 0.5 * 2.0 * 3.14159265 * 0.7 * std::cos(phase - 0.5 * i);
    }
    if (tick.index >= 40 && tick.index < 45) joints.position_rad[3] = std::numeric_limits<double>::quiet_NaN();
    if (tick.index >= 50 && tick.index < 53) joints.position_rad[3] = 50.0;
    joints_.write(joints);
    msg::ImuState imu{};
    const double yaw = 0.05 * std::sin(phase);
    imu.orientation = {std::cos(0.5 * yaw), 0.0, 0.0, std::sin(0.5 * yaw)};
    imu.angular_velocity_rad_s.z = 0.05 * 2.0 * 3.14159265 * 0.7 * std::cos(phase);
    if (kImu) imu_.write(imu);
  }

 private:
  Output<msg::JointState> joints_;
  Output<msg::ImuState> imu_;
};

/// A red object at the beginning, 1 m ahead or beside the head (`kBeside`), and a line straight ahead, every 5 ticks.
template <bool kBeside>
class Eye : public StatefulComponent<std::int64_t> {
 public:
  Eye(Wiring& wiring, const Setup&)
      : line_(wiring.output(topics::kLinePercept)), objects_(wiring.output(topics::kObjectPercepts)) {}
  [[nodiscard]] Timing timing() const override { return {5, 1}; }
  void step(const Tick& tick) override {
    msg::ObjectPercepts objects{};
    objects.exposure_tick = tick.index - 2;
    objects.blob_count = tick.index < 15 ? 1 : 0;
    objects.blobs[0].colour = msg::kColourRed;
    objects.blobs[0].bearing_rad = kBeside ? 1.5 : 0.0;
    objects.blobs[0].range_m = kBeside ? 0.04 : 0.9;
    objects.blobs[0].width_m = 0.16;
    objects_.write(objects);
    msg::LinePercept line{};
    line.exposure_tick = objects.exposure_tick;
    line.visible = true;
    line.colour = msg::kColourBlue;
    line.point_count = 32;
    for (int i = 0; i < 32; ++i) line.x_m[i] = 0.1 + 0.02 * i;
    line_.write(line);
  }

 private:
  Output<msg::LinePercept> line_;
  Output<msg::ObjectPercepts> objects_;
};

template <bool kImu = true, bool kBeside = false>
std::unique_ptr<LocalRun> make_run() {
  Setup setup;
  setup.robot_file = data_path("components/lib/robot/mamba.yaml");
  return std::make_unique<LocalRun>(
      std::vector<ComponentFactory>{testing::member_of_class<Snake<kImu>>("physics"),
                                    testing::member_of_class<Eye<kBeside>>("perception"), make_guidance_factory()},
      setup);
}

TEST(GuidanceComponent, PublishesThePoseEveryTickAndTheMapEveryFifthTick) {
  auto run = make_run();
  int poses = 0, maps = 0;
  run->subscribe<msg::RobotPose>(topics::kRobotPose, [&](const msg::RobotPose& pose) {
    ++poses;
    EXPECT_TRUE(std::isfinite(pose.x_m) && std::isfinite(pose.y_m) && std::isfinite(pose.yaw_rad) &&
                std::isfinite(pose.speed_m_s) && std::isfinite(pose.covariance[0]));
    EXPECT_GE(pose.covariance[0], 0.0);
  });
  run->subscribe<msg::FieldMap>(topics::kFieldMap, [&](const msg::FieldMap&) { ++maps; });
  run->advance(25);
  ASSERT_EQ(run->latest(topics::kFieldMap)->object_count, 1);
  EXPECT_EQ(run->latest(topics::kFieldMap)->objects[0].handle, 1);
  run->advance(75);
  EXPECT_EQ(poses, 100);
  EXPECT_EQ(maps, 20);
  EXPECT_EQ(run->member("guidance").counters().refused, 3u);
  EXPECT_EQ(run->member("guidance").counters().last_refusal, "joint_state.position_rad: accepted -6.3 to 6.3");
  EXPECT_EQ(run->latest(topics::kFieldMap)->object_count, 0) << "the images do not show it any more";
  EXPECT_GT(run->latest(topics::kFieldMap)->line_point_count, 5);
}

TEST(GuidanceComponent, KeepsThePoseWhileJointsAreNotPlausible) {
  auto run = make_run();
  run->advance(40);
  const double x = run->latest(topics::kRobotPose)->x_m;
  run->advance(5);
  EXPECT_EQ(run->latest(topics::kRobotPose)->x_m, x);
  run->advance(10);
  EXPECT_NE(run->latest(topics::kRobotPose)->x_m, x);
}

TEST(GuidanceComponent, MovesWithoutAnInertialUnit) {
  auto run = make_run<false>();
  run->advance(150);
  EXPECT_GT(std::abs(run->latest(topics::kRobotPose)->x_m), 0.1);
  EXPECT_GT(run->latest(topics::kRobotPose)->covariance[8], 1e-4) << "the yaw is less certain";
  auto measured = make_run();
  measured->advance(150);
  EXPECT_LT(measured->latest(topics::kRobotPose)->covariance[8], 1e-4);
}

// The plant of these tests publishes no contacts. Nothing tells such a robot whether it pushes the object.
TEST(GuidanceComponent, KnowsItsPoseLessWellBesideAnObjectThatItWouldNotFeel) {
  auto alone = make_run();
  auto beside = make_run<true, true>();
  for (auto* run : {alone.get(), beside.get()}) run->advance(150);
  ASSERT_EQ(beside->latest(topics::kFieldMap)->object_count, 1);
  EXPECT_GT(beside->latest(topics::kRobotPose)->covariance[0], 4.0 * alone->latest(topics::kRobotPose)->covariance[0]);
}

/// A body at rest whose pitch joints all move at this rate, in [mrad/s].
template <int kPitchRate>
class LiftedSnake : public testing::PlantBase {
 public:
  LiftedSnake(Wiring& wiring, const Setup&)
      : joints_(wiring.output(topics::kJointState)), imu_(wiring.output(topics::kImuState)) {}
  void sample(const Tick& tick) override {
    msg::JointState joints{};
    joints.joint_count = 23;
    // Up and down for 0.1 s each. Joints with an odd index turn about the pitch axis.
    const double sign = tick.index / 5 % 2 == 0 ? 1.0 : -1.0;
    for (int i = 1; i < 23; i += 2) joints.velocity_rad_s[i] = sign * 1e-3 * kPitchRate;
    joints_.write(joints);
    msg::ImuState imu{};
    imu.orientation.w = 1.0;
    imu_.write(imu);
  }

 private:
  Output<msg::JointState> joints_;
  Output<msg::ImuState> imu_;
};

template <int kPitchRate>
double variance_after_m2(int ticks) {
  Setup setup;
  setup.robot_file = data_path("components/lib/robot/mamba.yaml");
  LocalRun run({testing::member_of_class<LiftedSnake<kPitchRate>>("physics"), make_guidance_factory()}, setup);
  run.advance(ticks);
  return run.latest(topics::kRobotPose)->covariance[0];
}

TEST(GuidanceComponent, KnowsThatItsPoseIsUncertainWhileModulesLeaveTheGround) {
  const double at_rest_m2 = variance_after_m2<0>(550);
  EXPECT_EQ(variance_after_m2<40>(550), at_rest_m2) << "the ripple of a body in the plane";
  // A random walk: the variance grows by sd^2 T dt in each tick, here for 10 s.
  const double growth_m2 = variance_after_m2<400>(550) - variance_after_m2<400>(50);
  EXPECT_NEAR(growth_m2, 0.3 * 0.3 * 10.0 * 10.0, 0.02 * growth_m2);
}

TEST(GuidanceComponent, RestartChangesNothing) {
  auto whole = make_run(), broken = make_run();
  whole->advance(200);
  for (int i = 0; i < 200; ++i) {
    broken->advance(1);
    if (i % 37 == 11) broken->restart("guidance");
  }
  EXPECT_EQ(whole->output_hashes(), broken->output_hashes());
}

}  // namespace
}  // namespace constrictor
