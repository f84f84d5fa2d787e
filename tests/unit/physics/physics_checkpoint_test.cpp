// The plant continues from its checkpoint, bit for bit: in a toy scene, and with objects that it pushes.
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>

#include "support/temporary_folder.hpp"
#include "unit/physics/physics_run.hpp"

namespace constrictor {
namespace {

using testing::hash_of;

/// Swings the yaw joints, so that the robot crawls; pushes them by torques; relaxes them for a while; and pauses, so
/// that commands get stale.
bool drive(std::int64_t tick, msg::JointCommand& command) {
  if (tick % 400 > 380) return false;
  command.mode = tick % 300 > 290 ? msg::kServoRelaxed : msg::kServoFollow;
  if (tick % 300 > 250 && tick % 300 <= 290) command.mode = msg::kServoTorque;
  for (std::size_t i = 0; i < command.joint_count; ++i) {
    command.torque_nm[i] = command.mode == msg::kServoTorque ? 0.8 * std::sin(0.7 * static_cast<double>(i)) : 0.0;
    if (i % 2 == 0)
      command.position_rad[i] = 0.5 * std::sin(0.088 * static_cast<double>(tick) - 0.52 * static_cast<double>(i));
  }
  return true;
}

/// A cylinder in the body's way, a box and a peg behind it, and a push on the box.
std::filesystem::path crowded_scene() {
  static const testing::TemporaryFolder folder;  // of this process alone: tests run side by side
  std::filesystem::path file = folder.path() / "crowded.yaml";
  std::ofstream(file) << R"(name: crowded
start: {position_m: [0, 0], yaw_rad: 0}
objects:
  - {colour: red, shape: cylinder, position_m: [0.20, 0.02], radius_m: 0.08, height_m: 0.15, mass_kg: 0.4}
  - {colour: green, shape: box, position_m: [0.40, 0.02], size_m: [0.1, 0.2, 0.15], mass_kg: 0.3, yaw_rad: 0.3}
perturbations:
  - {object: 1, at_s: 3.0, duration_s: 0.4, force_n: [0.5, 1.5, 0]}
)";
  return file;
}

Setup crowded_setup(const std::string& robot) { return testing::setup_of(crowded_scene(), 3, robot); }

std::unique_ptr<LocalRun> make_run(const Setup& setup) { return testing::make_run(drive, setup); }

/// Runs for 50 ticks in each part; kills the plant at some of them. Everything that the plant has published must be
/// equal. A long test does the same over a whole mission (determinism_long_test).
void expect_equal_after_restarts(const Setup& setup, int parts) {
  auto undisturbed = make_run(setup);
  auto killed = make_run(setup);
  for (int part = 0; part < parts; ++part) {
    ASSERT_EQ(undisturbed->advance(50), 50);
    ASSERT_EQ(killed->advance(13 + part % 20), 13 + part % 20);
    killed->restart("physics");
    if (part % 7 == 0) killed->restart("physics");  // and again before the next tick
    ASSERT_EQ(killed->advance(37 - part % 20), 37 - part % 20);
    ASSERT_EQ(hash_of(*undisturbed), hash_of(*killed)) << "at tick " << undisturbed->tick();
    ASSERT_EQ(undisturbed->output_hashes(), killed->output_hashes()) << "at tick " << undisturbed->tick();
  }
}

TEST(PhysicsCheckpoint, ContinuesBitForBitInACrowdedScene) { expect_equal_after_restarts(crowded_setup("mamba"), 20); }

TEST(PhysicsCheckpoint, ContinuesBitForBitWithSeriesElasticJoints) {
  expect_equal_after_restarts(crowded_setup("serpens"), 5);
}

TEST(PhysicsCheckpoint, ContinuesBitForBitWithBacklashAndEncoderSteps) {
  expect_equal_after_restarts(crowded_setup("mamba_mx106"), 5);
}

TEST(PhysicsCheckpoint, TheCrowdedSceneMovesItsObjects) {
  // Otherwise the tests above would not cover contacts with objects, nor the perturbation.
  auto run = make_run(crowded_setup("mamba"));
  run->advance(1);
  const msg::WorldState before = *run->latest(topics::kWorldState);
  run->advance(400);
  const msg::WorldState& after = *run->latest(topics::kWorldState);
  for (int i = 0; i < 2; ++i) {
    const auto& from = before.object_poses[i].position_m;
    const auto& to = after.object_poses[i].position_m;
    EXPECT_GT(std::hypot(to.x - from.x, to.y - from.y), 0.01) << "object " << i;
  }
}

TEST(PhysicsCheckpoint, IsSmall) {
  auto run = make_run(crowded_setup("mamba"));
  run->advance(300);
  EXPECT_LT(run->component("physics").save().size(), 32'768u);
  std::printf("checkpoint of the plant: %zu bytes\n", run->component("physics").save().size());
}

TEST(PhysicsCheckpoint, RefusesTheStateOfAnotherScene) {
  auto crowded = make_run(crowded_setup("mamba"));
  auto empty = make_run(testing::setup_of(testing::source_path("sim/scenarios/line.yaml"), 3));
  crowded->advance(5);
  try {
    empty->component("physics").load(crowded->component("physics").save());
    FAIL() << "it must be refused";
  } catch (const std::runtime_error& error) {
    EXPECT_NE(std::string(error.what()).find("found 24 modules and 2 objects, accepted 24 and 0"), std::string::npos)
        << error.what();
  }
}

}  // namespace
}  // namespace constrictor
