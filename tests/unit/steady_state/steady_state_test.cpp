// What is done in each tick, or for each image, uses its memory again.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "allocation_count.hpp"
#include "barrier/input_buffer.hpp"
#include "barrier/topic_ops.hpp"
#include "component/data_path.hpp"
#include "constrictor/sha256.hpp"
#include "perception/line_and_blob_detector.hpp"
#include "runtime/checkpoint_file.hpp"
#include "runtime/hash_log.hpp"
#include "runtime/wire.hpp"
#include "sim/world/world.hpp"
#include "support/temporary_folder.hpp"
#include "unit/perception/ray_caster.hpp"
#include "unit/physics/physics_run.hpp"
#include "unit/runtime/barrier_fixture.hpp"
#include "unit/world/open_loop_gait.hpp"

namespace constrictor::testing {
namespace {

class SteadyState : public ::testing::Test {
 protected:
  void SetUp() override {
    if (!AllocationCount::works()) GTEST_SKIP() << "sanitizers replace malloc()";
  }
};

/// More characters than a string holds in place.
std::string long_text(char c) { return std::string(100, c); }

TEST_F(SteadyState, AllocationsAreCounted) {
  // Otherwise the tests below would pass without meaning.
  const AllocationCount mine;
  const auto numbers = std::make_unique<std::vector<int>>(100);
  EXPECT_EQ(mine.own(), 2u);
  EXPECT_EQ(mine.all(), 2u);
  const AllocationCount of_library;
  EXPECT_NE(sha256({}), Sha256::Digest{});
  EXPECT_EQ(of_library.own(), 0u) << "OpenSSL allocates the state of a hash";
  EXPECT_GE(of_library.all(), 1u);
}

TEST_F(SteadyState, BytesOfAHeaderNeedNoMemory) {
  const msg::Header header{1, 2, 3, 4, 5, 6};
  const AllocationCount count;
  const HeaderBytes bytes = header_bytes(neutral_header(header));
  EXPECT_EQ(count.all(), 0u);
  EXPECT_EQ(parse_header(bytes).tick, 4);
}

TEST_F(SteadyState, ATickDoneIsSentAndReceivedInTheMemoryOfTheOneBefore) {
  TickDone done;
  done.component = "navigation";
  done.published = {{3, 10}, {17, 20}};
  done.consumed = {{0, 42}, {1, 43}, {2, 44}};
  done.state = long_text('s');
  done.written = {{17, long_text('a')}, {3, long_text('b')}};
  std::string block;
  TickDone last;
  const auto pass = [&] {
    auto received = from_wire(to_wire(done, block), std::move(last));
    ASSERT_TRUE(received);
    last = std::move(*received);
  };
  pass();
  const AllocationCount count;
  for (int i = 0; i < 10; ++i) pass();
  EXPECT_EQ(count.all(), 0u);
  EXPECT_EQ(last.written.at(1).bytes, done.written.at(1).bytes);
}

TEST_F(SteadyState, InputsAreKeptAndPresentedInTheSameMemory) {
  constexpr auto& kTopic = topics::kTaskEvent;
  InputBuffer buffer(kTopic, /*events=*/true);
  std::vector<Sample> samples;
  for (std::uint64_t number = 1; number <= 60; ++number) samples.push_back(sample_of(kTopic, number));
  std::vector<msg::Tick> ticks;
  for (std::uint64_t tick = 0; tick < 20; ++tick)
    ticks.push_back(tick_at(static_cast<std::int64_t>(tick), {{kTopic.id, 3 * tick + 3}}));
  const auto step = [&](std::uint64_t tick) {
    for (std::uint64_t number = 3 * tick + 1; number <= 3 * tick + 3; ++number) buffer.keep(samples[number - 1], true);
    buffer.present(ticks[tick]);
  };
  for (std::uint64_t tick = 0; tick < 5; ++tick) step(tick);
  const AllocationCount count;
  for (std::uint64_t tick = 5; tick < 20; ++tick) step(tick);
  EXPECT_EQ(count.all(), 0u);
  EXPECT_EQ(buffer.slot().fresh.size(), 3u);
}

TEST_F(SteadyState, CheckpointsAreStoredInTheSameMemory) {
  const TemporaryFolder folder;
  CheckpointFile file(folder.path() / "checkpoint.bin");
  // Each one has 20 blobs, of which five are new: the newest four of five topics.
  std::vector<Checkpoint> checkpoints;
  for (std::size_t i = 0; i < 60; ++i) {
    Checkpoint next{long_text('h'), {}};
    if (i > 0) next.blobs.assign(checkpoints.back().blobs.begin() + 5, checkpoints.back().blobs.end());
    while (next.blobs.size() < 20)
      next.blobs.push_back(std::make_shared<const std::string>(300 * (next.blobs.size() % 5), 'x'));
    checkpoints.push_back(std::move(next));
  }
  for (std::size_t i = 0; i < 20; ++i) file.write(checkpoints[i]);
  const AllocationCount count;
  for (std::size_t i = 20; i < checkpoints.size(); ++i) file.write(checkpoints[i]);
  EXPECT_EQ(count.all(), 0u);
}

TEST_F(SteadyState, TheHashLogUsesTheSameMemory) {
  const TemporaryFolder folder;
  HashLog log(folder.path());
  std::vector<Sample> samples;
  for (std::uint64_t number = 1; number <= 30; ++number) samples.push_back(sample_of(topics::kContactState, number));
  const auto add = [&](std::size_t i) {
    log.add(topics::kContactState, samples[i]);
    EXPECT_EQ(log.flush(), "");
  };
  for (std::size_t i = 0; i < 10; ++i) add(i);
  const AllocationCount count;
  for (std::size_t i = 10; i < samples.size(); ++i) add(i);
  EXPECT_EQ(count.all(), 0u);
}

/// A robot that crawls, with an object beside it that it does not touch: two groups of bodies, which the engine solves
/// one after the other.
Scenario quiet_scene() {
  Scenario scenario;
  ScenarioObject object;
  object.position_m = {0.0, 1.5};
  scenario.objects.push_back(object);
  return scenario;
}

TEST_F(SteadyState, TheWorldAllocatesOnceInATickForItsHash) {
  constexpr double kPeriod_s = 0.02;
  constexpr std::uint64_t kTicks = 50;
  const RobotModel robot = load_robot(robot_path("mamba"));
  World world(robot, quiet_scene(), SolverSettings{});
  const std::vector<double> torques(robot.joints.size(), 6.0);
  std::uint64_t allocated = 0;
  for (std::uint64_t tick = 0; tick < 2 * kTicks; ++tick) {
    const std::vector<double> angles = OpenLoopGait{}.angles(robot, static_cast<double>(tick) * kPeriod_s);
    const std::vector<double> rates(angles.size(), 0.0);
    const AllocationCount count;
    world.set_servo(angles, rates, torques);
    world.advance(kPeriod_s);
    if (tick >= kTicks) allocated += count.all();
  }
  // OpenSSL allocates the state of each hash.
  EXPECT_LE(allocated, kTicks);
}

TEST_F(SteadyState, APlantAllocatesForEachMessageAndItsCheckpointOnly) {
  constexpr std::int64_t kTicks = 100;
  const auto crawl = [](std::int64_t tick, msg::JointCommand& command) {
    for (std::size_t i = 0; i < command.joint_count; i += 2)
      command.position_rad[i] = 0.5 * std::sin(0.088 * static_cast<double>(tick) - 0.52 * static_cast<double>(i));
    return true;
  };
  const auto run = make_run(crawl, setup_of(data_path("sim/scenarios/line.yaml")));
  ASSERT_EQ(run->advance(kTicks), kTicks);
  const AllocationCount count;
  ASSERT_EQ(run->advance(kTicks), kTicks);
  // Six messages are written in each tick, one of them by the member that commands the joints. Each needs a block for
  // itself, two for its bytes in the conductor's history, and one of OpenSSL for its hash: 24; the command is copied
  // once more. The states of plant and member need eight blocks, the hash of the world's state, the felt contacts and
  // the ticks that LocalRun keeps one each, and the lists of samples a half: 36.6 in all.
  const double in_a_tick = static_cast<double>(count.all()) / kTicks;
  EXPECT_LE(in_a_tick, 37.0);
  std::printf("a tick of the plant and a member: %.2f allocations\n", in_a_tick);
}

TEST_F(SteadyState, PerceptionUsesTheSameMemoryForEachImage) {
  Scene scene;
  scene.line = Arc{{-0.2, 0.05}, 0.0, 0.4};
  scene.rounds = {{msg::kColourRed, {0.7, 0.25}, 0.08, 0.2}, {msg::kColourGreen, {0.8, -0.3}, 0.15}};
  const msg::CameraInfo info = camera_info();
  const Head head;
  const cv::Mat image = draw(scene, info, head);
  const perception::GroundCamera camera(info, orientation(head), head.height_m);
  perception::LineAndBlobDetector detector{perception::PerceptionConfig{}};
  constexpr std::uint64_t kImages = 5;
  perception::Percepts percepts;
  for (std::uint64_t i = 0; i < kImages; ++i) percepts = detector.detect(image, camera, msg::kColourBlue);
  ASSERT_TRUE(percepts.line.visible);
  ASSERT_EQ(percepts.objects.blob_count, 2);
  const AllocationCount count;
  for (std::uint64_t i = 0; i < kImages; ++i) percepts = detector.detect(image, camera, msg::kColourBlue);
  // The tracer of the line, whose lists belong to one image.
  EXPECT_LE(count.own(), 9 * kImages);
  std::printf("an image: %.1f allocations of perception, %.1f with those of OpenCV\n",
              static_cast<double>(count.own()) / kImages, static_cast<double>(count.all()) / kImages);
}

}  // namespace
}  // namespace constrictor::testing
