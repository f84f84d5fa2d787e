#include "sim/emulation/shared_world.hpp"

#include <gtest/gtest.h>

#include <atomic>
#include <fstream>
#include <thread>

#include "sim/scenario_loader/scenario_file.hpp"
#include "support/project.hpp"
#include "support/temporary_folder.hpp"

namespace constrictor::emulation {
namespace {

using testing::TemporaryFolder;
World make_world() {
  return {load_robot(testing::robot_path("mamba")),
          load_scenario(testing::source_path("sim/scenarios/case_study.yaml"), 1)};
}

TEST(SharedWorld, ShowsTheNewestStateToAReader) {
  const TemporaryFolder folder;
  const auto file = folder.path() / "world.state";
  World world = make_world();
  SharedWorldReader reader(file, world.module_count(), world.object_count());
  EXPECT_FALSE(reader.read().has_value()) << "there is no file yet";
  SharedWorldWriter writer(file);
  EXPECT_FALSE(reader.read().has_value()) << "there is no state yet";
  world.advance(0.1);
  writer.write(world);
  const auto found = reader.read();
  ASSERT_TRUE(found.has_value());
  EXPECT_EQ(found->time_ns, 100'000'000);
  ASSERT_EQ(found->world.module_count, world.module_count());
  const Eigen::Vector3d head = world.module_pose(0).translation();
  EXPECT_EQ(found->world.module_poses[0].position_m.x, head.x());
  const Eigen::Vector3d object = world.object_pose(1).translation();
  EXPECT_EQ(found->world.object_poses[1].position_m.y, object.y());
}

TEST(SharedWorld, NeverShowsHalfOfAState) {
  const TemporaryFolder folder;
  const auto file = folder.path() / "world.state";
  World world = make_world();
  SharedWorldWriter writer(file);
  world.advance(0.004);
  writer.write(world);
  std::atomic<bool> stop = false;
  std::thread writes([&] {
    while (!stop) {
      world.advance(0.002);
      for (int i = 0; i < 50; ++i) writer.write(world);
    }
  });
  SharedWorldReader reader(file, world.module_count(), world.object_count());
  std::int64_t last_ns = 0;
  constexpr int kWanted = 10'000;
  int read = 0;
  for (int i = 0; i < 10'000'000 && read < kWanted; ++i) {
    const auto found = reader.read();
    if (!found) {  // the writer may have lost its processor in the middle of a state
      std::this_thread::yield();
      continue;
    }
    ++read;
    EXPECT_GE(found->time_ns, last_ns);
    last_ns = found->time_ns;
    // The state is that of a step as a whole: neighbouring modules never come apart.
    const auto& a = found->world.module_poses[0].position_m;
    const auto& b = found->world.module_poses[1].position_m;
    EXPECT_NEAR(std::hypot(a.x - b.x, a.y - b.y, a.z - b.z), 0.089, 0.003);
  }
  stop = true;
  writes.join();
  EXPECT_EQ(read, kWanted);
}

TEST(SharedWorld, RefusesFilesOfOtherWorlds) {
  const TemporaryFolder folder;
  const auto file = folder.path() / "world.state";
  std::ofstream(file) << "something else";
  EXPECT_THROW(static_cast<void>(SharedWorldReader(file, 24, 2).read()), std::runtime_error);
  World world = make_world();
  world.advance(0.002);
  SharedWorldWriter writer(file);
  writer.write(world);
  EXPECT_THROW(static_cast<void>(SharedWorldReader(file, 24, 5).read()), std::runtime_error);
}

}  // namespace
}  // namespace constrictor::emulation
