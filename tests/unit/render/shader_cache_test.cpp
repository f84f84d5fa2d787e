// Frames are the same with compiled shaders from the cache and without, also if the cache is damaged or was filled with
// other settings. What other users could have written is not used.
#include "sim/render/shader_cache.hpp"

#include <gtest/gtest.h>

#include <fstream>

#include "support/process.hpp"
#include "support/project.hpp"
#include "support/temporary_folder.hpp"

namespace constrictor {
namespace {

namespace fs = std::filesystem;
using namespace std::chrono_literals;
using Environment = std::map<std::string, std::string>;

class ShaderCache : public ::testing::Test {
 protected:
  /// The bytes of a frame that a process of its own draws.
  std::string frame(Environment environment) {
    environment.try_emplace("CACHE_DIRECTORY", "");
    environment.try_emplace("XDG_CACHE_HOME", cache_.path().string());
    const fs::path file = frames_.path() / std::to_string(++number_);
    testing::Process process({testing::program("draw_frame"), file.string()}, environment);
    EXPECT_EQ(process.wait(60s), 0) << process.errors();
    EXPECT_EQ(process.errors(), "");
    return frames_.contents()[file.filename().string()];
  }
  std::string uncached_frame() { return frame({{"MESA_SHADER_CACHE_DISABLE", "true"}}); }

  testing::TemporaryFolder cache_;
  testing::TemporaryFolder frames_;
  int number_ = 0;
};

TEST_F(ShaderCache, GivesTheSameFrame) {
  const std::string expected = uncached_frame();
  ASSERT_EQ(expected.size(), 160U * 120U * 3U);
  EXPECT_TRUE(cache_.contents().empty());
  EXPECT_EQ(frame({}), expected) << "while the cache is filled";
  auto filled = cache_.contents();
  EXPECT_GT(filled.size(), 4U);
  // Mesa writes in a thread of its own, which may be behind when its process ends. Then the next one adds what is
  // missing.
  bool complete = false;
  for (int run = 0; run < 10 && !complete; ++run) {
    EXPECT_EQ(frame({}), expected) << "with shaders from the cache";
    complete = cache_.contents() == filled;
    filled = cache_.contents();
  }
  EXPECT_TRUE(complete) << "shaders that are in the cache are compiled again";
}

TEST_F(ShaderCache, KeepsTheCodeOfOtherSettingsApart) {
  const std::string expected = uncached_frame();
  EXPECT_EQ(frame({{"LP_NATIVE_VECTOR_WIDTH", "128"}}), expected);
  EXPECT_EQ(frame({}), expected);
  EXPECT_EQ(frame({{"LP_NATIVE_VECTOR_WIDTH", "128"}}), expected);
}

TEST_F(ShaderCache, SurvivesDamagedFiles) {
  const std::string expected = uncached_frame();
  frame({});
  std::size_t damaged = 0;
  for (const auto& [name, content] : cache_.contents()) {
    std::string changed = content;
    if (damaged % 3 == 0) changed.resize(content.size() / 2);
    if (damaged % 3 == 1) changed[content.size() / 2] = static_cast<char>(~changed[content.size() / 2]);
    if (damaged % 3 == 2) changed.clear();
    std::ofstream(cache_.path() / name, std::ios::binary | std::ios::trunc) << changed;
    ++damaged;
  }
  ASSERT_GT(damaged, 4U);
  EXPECT_EQ(frame({}), expected);
}

TEST_F(ShaderCache, IsNotUsedWhereItCannotBeWritten) {
  const std::string expected = uncached_frame();
  EXPECT_EQ(frame({{"XDG_CACHE_HOME", "/proc"}}), expected);
  EXPECT_EQ(frame({{"XDG_CACHE_HOME", ""}, {"HOME", ""}}), expected);
}

TEST_F(ShaderCache, UsesTheFirstRootThatIsAnAbsolutePath) {
  const std::string expected = uncached_frame();
  const testing::TemporaryFolder service;
  EXPECT_EQ(frame({{"CACHE_DIRECTORY", service.path().string() + ":/other"}}), expected);
  EXPECT_FALSE(service.contents().empty());
  EXPECT_EQ(frame({{"XDG_CACHE_HOME", "relative"}, {"HOME", cache_.path().string()}}), expected);
  EXPECT_TRUE(fs::exists(cache_.path() / ".cache/constrictor"));
}

TEST_F(ShaderCache, HasAPrivateFolderForEachSetting) {
  const auto folder = shader_cache_folder(cache_.path(), "one");
  ASSERT_TRUE(folder);
  EXPECT_EQ(fs::status(*folder).permissions(), fs::perms::owner_all);
  EXPECT_EQ(shader_cache_folder(cache_.path(), "one"), folder);
  EXPECT_NE(shader_cache_folder(cache_.path(), "two"), folder);
}

TEST_F(ShaderCache, RefusesAFolderIntoWhichOthersCanWrite) {
  const auto folder = shader_cache_folder(cache_.path(), "one");
  ASSERT_TRUE(folder);
  fs::permissions(*folder, fs::perms::owner_all | fs::perms::others_write);
  EXPECT_FALSE(shader_cache_folder(cache_.path(), "one"));
  fs::remove(*folder);
  fs::create_directory_symlink(frames_.path(), *folder);
  EXPECT_FALSE(shader_cache_folder(cache_.path(), "one")) << "a link may lead to another user's folder";
  fs::remove(*folder);
  std::ofstream(folder->string()) << "a file";
  EXPECT_FALSE(shader_cache_folder(cache_.path(), "one"));
}

TEST(CpuFeatures, AreThoseThatDecideWhichInstructionsCanRun) {
  const std::string cpu =
      "processor\t: 0\nvendor_id\t: AuthenticAMD\nmodel\t\t: 1\nmodel name\t: EPYC\ncpu MHz\t\t: 2445.4\n"
      "flags\t\t: fpu sse4_1 avx\nbogomips\t: 4890.8\n";
  const std::string features = "vendor_id\t: AuthenticAMD\nmodel\t\t: 1\nflags\t\t: fpu sse4_1 avx\n";
  EXPECT_EQ(cpu_features(cpu), features);
  EXPECT_EQ(cpu_features(cpu + "\nprocessor\t: 1\nvendor_id\t: Other\n"), features) << "of the first CPU";
}

}  // namespace
}  // namespace constrictor
