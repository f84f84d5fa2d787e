// The plant as a member of a run: its measurements, the commands that it obeys, and equal runs.
#include "sim/physics/physics.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <fstream>
#include <functional>
#include <limits>
#include <memory>

#include "barrier/local_run.hpp"
#include "configuration/configuration.hpp"
#include "unit/physics/physics_run.hpp"

namespace constrictor {
namespace {

using testing::CommandAt;

using testing::hash_of;

std::unique_ptr<LocalRun> make_run(CommandAt command_at, const char* scenario = "line.yaml", std::uint64_t seed = 1) {
  return testing::make_run(std::move(command_at),
                           testing::setup_of(testing::source_path("sim/scenarios") / scenario, seed));
}

CommandAt silence() {
  return [](std::int64_t, msg::JointCommand&) { return false; };
}

/// Bends and swings the yaw joints.
CommandAt swing() {
  return [](std::int64_t tick, msg::JointCommand& command) {
    for (std::size_t i = 0; i < 23; i += 2) {
      command.position_rad[i] = 0.3 * std::sin(0.05 * static_cast<double>(tick) + 0.4 * static_cast<double>(i));
    }
    return true;
  };
}

GateMode mode_of(LocalRun& run) { return dynamic_cast<Physics&>(run.component("physics")).gate().mode; }

TEST(Physics, DescribesTheSceneOnce) {
  auto run = make_run(silence());
  int scenes = 0;
  run->subscribe<msg::SceneDescription>(topics::kSceneDescription, [&](const msg::SceneDescription&) { ++scenes; });
  run->advance(20);
  EXPECT_EQ(scenes, 1);
}

TEST(Physics, RestsOnTheGround) {
  auto run = make_run(silence());
  run->advance(100);
  const msg::ContactState& felt = *run->latest(topics::kContactState);
  double weight = 0.0;
  for (int i = 0; i < felt.module_count; ++i) weight += felt.force_n[i].z;
  // 24 modules of 0.3 kg; the noise of each contact is 0.05 N.
  EXPECT_NEAR(weight, 24 * 0.3 * 9.81, 2.0);
  const msg::ImuState& imu = *run->latest(topics::kImuState);
  EXPECT_NEAR(imu.linear_acceleration_m_s2.z, 9.81, 0.3);
  EXPECT_NEAR(imu.linear_acceleration_m_s2.x, 0.0, 0.3);
  EXPECT_NEAR(imu.orientation.w, 1.0, 1e-3);  // the yaw is relative to the pose at the start
  const msg::TouchedState& touched = *run->latest(topics::kTouchedState);
  EXPECT_EQ(touched.contact_count, felt.contact_count);
  for (int i = 0; i < touched.contact_count; ++i) EXPECT_EQ(touched.kind[i], msg::kTouchedGround);
}

TEST(Physics, HoldsItsPostureWithoutACommand) {
  auto run = make_run(silence());
  run->advance(50);
  EXPECT_EQ(mode_of(*run), GateMode::kHolding);
  for (int i = 0; i < 23; ++i) EXPECT_NEAR(run->latest(topics::kJointState)->position_rad[i], 0.0, 0.01);
}

TEST(Physics, FollowsACommand) {
  auto run = make_run([](std::int64_t, msg::JointCommand& command) {
    command.position_rad[2] = 0.4;
    return true;
  });
  run->advance(100);
  EXPECT_EQ(mode_of(*run), GateMode::kObeying);
  EXPECT_NEAR(run->latest(topics::kJointState)->position_rad[2], 0.4, 0.02);
}

TEST(Physics, HoldsPostureWhenTheCommandIsStaleAndRelaxesLater) {
  auto run = make_run([](std::int64_t tick, msg::JointCommand& command) {
    command.position_rad[2] = 0.4;
    return tick < 60;
  });
  run->advance(64);
  EXPECT_EQ(mode_of(*run), GateMode::kObeying);
  run->advance(20);
  EXPECT_EQ(mode_of(*run), GateMode::kHolding);
  EXPECT_NEAR(run->latest(topics::kJointState)->position_rad[2], 0.4, 0.02);
  run->advance(260);
  EXPECT_EQ(mode_of(*run), GateMode::kRelaxed);
}

/// Spoils a good command in every tick, and expects that the robot holds its posture.
void expect_refused(const std::function<void(msg::JointCommand&)>& spoil) {
  auto run = make_run([spoil](std::int64_t, msg::JointCommand& command) {
    command.position_rad[0] = 0.5;
    spoil(command);
    return true;
  });
  run->advance(50);
  EXPECT_EQ(mode_of(*run), GateMode::kHolding);
  EXPECT_NEAR(run->latest(topics::kJointState)->position_rad[0], 0.0, 0.01);
}

TEST(Physics, DoesNotObeyACommandWithNaNOrBeyondTheLimits) {
  for (const double bad : {std::numeric_limits<double>::quiet_NaN(), 2.5}) {
    expect_refused([bad](msg::JointCommand& command) { command.position_rad[4] = bad; });
  }
}

TEST(Physics, DoesNotObeyACommandOfTheWrongSize) {
  expect_refused([](msg::JointCommand& command) { command.joint_count = 22; });
}

TEST(Physics, EqualRunsHaveEqualHashes) {
  auto first = make_run(swing());
  auto second = make_run(swing());
  for (int i = 0; i < 5; ++i) {  // the runs take turns in one process
    first->advance(20);
    second->advance(20);
  }
  EXPECT_EQ(hash_of(*first), hash_of(*second));
  EXPECT_EQ(first->output_hashes(), second->output_hashes());
}

TEST(Physics, OneUlpInOneCommandChangesTheHash) {
  auto first = make_run(swing());
  auto second = make_run([plain = swing()](std::int64_t tick, msg::JointCommand& command) {
    const bool written = plain(tick, command);
    if (tick == 40) command.position_rad[6] = std::nextafter(command.position_rad[6], 10.0);
    return written;
  });
  first->advance(40);
  second->advance(40);
  EXPECT_EQ(hash_of(*first), hash_of(*second));
  first->advance(20);
  second->advance(20);
  EXPECT_NE(hash_of(*first), hash_of(*second));
}

TEST(Physics, DifferentSeedsGiveDifferentRuns) {
  auto first = make_run(swing(), "line.yaml", 1);
  auto second = make_run(swing(), "line.yaml", 2);
  first->advance(10);
  second->advance(10);
  EXPECT_NE(hash_of(*first), hash_of(*second));
}

TEST(Physics, NoiseHasTheStandardDeviationOfTheRobotFile) {
  auto run = make_run(silence());
  double squares = 0.0;
  int count = 0;
  run->subscribe<msg::JointState>(topics::kJointState, [&](const msg::JointState& state) {
    const World& world = dynamic_cast<Physics&>(run->component("physics")).world();
    for (std::size_t i = 0; i < state.joint_count; ++i, ++count) {
      squares += std::pow(state.position_rad[i] - world.joint_angle_rad(i), 2);
    }
  });
  run->advance(100);
  EXPECT_NEAR(std::sqrt(squares / count), 0.001, 0.0001);
}

TEST(Physics, AScenarioCanSwitchNoiseOff) {
  const std::filesystem::path file = std::filesystem::path(::testing::TempDir()) / "quiet.yaml";
  std::ofstream(file) << "name: quiet\nstart: {position_m: [1, 2], yaw_rad: 0.7}\nnoise: {sensors: false}\n";
  auto run = testing::make_run(silence(), testing::setup_of(file));
  run->advance(100);
  const World& world = dynamic_cast<Physics&>(run->component("physics")).world();
  const msg::WorldState& truth = *run->latest(topics::kWorldState);
  EXPECT_NEAR(truth.module_poses[0].position_m.x, 1.0, 1e-3);
  EXPECT_NEAR(2.0 * std::asin(truth.module_poses[0].orientation.z), 0.7, 1e-3);
  EXPECT_NEAR(run->latest(topics::kImuState)->orientation.z, 0.0, 1e-3);
  for (std::size_t i = 0; i < 23; ++i) {  // one step apart, at rest
    EXPECT_NEAR(run->latest(topics::kJointState)->position_rad[i], world.joint_angle_rad(i), 1e-4);
  }
}

TEST(Physics, RejectsAPeriodThatIsNoMultipleOfTheStep) {
  const std::filesystem::path file = std::filesystem::path(::testing::TempDir()) / "physics.yaml";
  std::ofstream(file) << "period_s: 0.02\nsolver: {step_s: 0.003, iterations: 20}\n";
  try {
    (void)load_parameters<PhysicsConfig>(file);
    FAIL();
  } catch (const ConfigurationError& error) {
    EXPECT_NE(
        std::string(error.what())
            .find("physics.yaml:1: period_s: found a period that is no multiple of solver.step_s, accepted a multiple"),
        std::string::npos);
  }
}

TEST(Physics, TellsACheckTheObjectsOfTheMission) {
  const std::filesystem::path file = std::filesystem::path(::testing::TempDir()) / "demanded.yaml";
  std::ofstream(file) << "name: demanded\n"
                         "objects:\n"
                         "  - {colour: red, position_m: [2, 0], radius_m: 0.1, height_m: 0.2, mass_kg: 0.4}\n"
                         "  - {colour: green, position_m: [3, 0], shape: box, size_m: [0.2, 0.1, 0.3], mass_kg: 0.4}\n"
                         "zones:\n"
                         "  - {colour: green, position_m: [-4, 0], radius_m: 0.2}\n"
                         "  - {colour: red, position_m: [-5, 0], radius_m: 0.5}\n"
                         "  - {colour: green, position_m: [-6, 0], radius_m: 0.3}\n"
                         "start: {position_m: [0, 0]}\n";
  LocalRun run({make_physics_factory()}, testing::setup_of(file));
  const auto& source = dynamic_cast<const ObjectSource&>(run.component("physics"));
  const auto red = source.demanded_objects({msg::kColourRed});
  ASSERT_EQ(red.size(), 1u);
  EXPECT_EQ(red[0].size_key(), "objects[0].radius_m");
  EXPECT_DOUBLE_EQ(red[0].radius_m(), 0.1);
  EXPECT_DOUBLE_EQ(red[0].height_m, 0.2);
  EXPECT_EQ(red[0].zone_key, "zones[1]");
  const auto both = source.demanded_objects({msg::kColourGreen, msg::kColourRed});
  ASSERT_EQ(both.size(), 2u);
  const DemandedObject& box = both[1];
  EXPECT_EQ(box.size_key(), "objects[1].size_m");
  EXPECT_DOUBLE_EQ(box.width_m, 0.1);
  EXPECT_DOUBLE_EQ(box.length_m, 0.2);
  EXPECT_DOUBLE_EQ(box.radius_m(), std::hypot(0.05, 0.1));
  EXPECT_EQ(box.zone_key, "zones[2]") << "the largest of its colour";
  EXPECT_DOUBLE_EQ(box.zone_radius_m, 0.3);
  EXPECT_TRUE(source.demanded_objects({}).empty());
}

}  // namespace
}  // namespace constrictor
