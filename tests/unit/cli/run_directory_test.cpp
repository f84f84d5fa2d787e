#include <gtest/gtest.h>

#include <set>
#include <thread>
#include <vector>

#include "cli/run_command.hpp"
#include "support/small_disk.hpp"
#include "support/temporary_folder.hpp"

namespace constrictor::cli {
namespace {

namespace fs = std::filesystem;

TEST(RunDirectory, IsAlwaysANewOne) {
  const testing::TemporaryFolder folder;
  const fs::path wanted = folder.path() / "runs/20261121-120000_short_seed1";
  EXPECT_EQ(make_new_directory(wanted), wanted);
  EXPECT_EQ(make_new_directory(wanted), wanted.string() + "-2");
  EXPECT_EQ(make_new_directory(wanted), wanted.string() + "-3");
  EXPECT_TRUE(fs::is_directory(wanted.string() + "-3"));
}

TEST(RunDirectory, IsANewOneForEachOfManySimultaneousCalls) {
  const testing::TemporaryFolder folder;
  std::vector<fs::path> made(16);
  std::vector<std::thread> threads;
  for (auto& path : made) threads.emplace_back([&] { path = make_new_directory(folder.path() / "runs/r"); });
  for (auto& thread : threads) thread.join();
  EXPECT_EQ(std::set<fs::path>(made.begin(), made.end()).size(), made.size());
}

TEST(RunDirectory, IsRefusedAndRemovedIfItsDiskHasNoRoom) {
  const testing::TemporaryFolder folder;
  RunOptions options;
  options.report_dir = folder.path() / "report";
  {
    const testing::SmallDisk disk(1 << 19);
    EXPECT_THROW((void)make_report_dir(options, "short.yaml"), std::runtime_error);
  }
  EXPECT_FALSE(fs::exists(options.report_dir));
  EXPECT_EQ(make_report_dir(options, "short.yaml"), options.report_dir);
  EXPECT_TRUE(fs::is_empty(options.report_dir)) << "the file that took the room is left";
}

}  // namespace
}  // namespace constrictor::cli
