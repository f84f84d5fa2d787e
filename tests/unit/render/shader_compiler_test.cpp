// After the first frame, LLVM's code takes no memory any more. The kernel's account of this process says so.
#include "sim/render/shader_compiler.hpp"

#include <gtest/gtest.h>

#include <fstream>
#include <sstream>
#include <string>

#include "busy_scene.hpp"

namespace constrictor {
namespace {

/// [KiB] What the pages of LLVM that cannot be written take, from /proc/self/smaps (proc(5)).
long resident_compiler_kib() {
  std::ifstream smaps("/proc/self/smaps");
  long sum = 0;
  bool counts = false;
  for (std::string line; std::getline(smaps, line);) {
    std::istringstream words(line);
    std::string first, second;
    words >> first >> second;
    if (first.find('-') != std::string::npos && second.size() == 4) {
      counts = line.find("/libLLVM") != std::string::npos && second == "r-xp";
    } else if (first == "Rss:" && counts) {
      sum += std::stol(second);
    }
  }
  return sum;
}

TEST(ShaderCompiler, TakesNoMemoryAfterTheFirstFrame) {
  Renderer renderer(testing::busy_scene(), {});
  const auto draw = [&] { return renderer.draw(testing::busy_poses(), testing::scene_camera(), {}); };
  const auto first = draw();
  // Without the release it takes about 50 MiB. A thread of Mesa may still be writing its cache.
  EXPECT_LT(resident_compiler_kib(), 4096);
  EXPECT_EQ(draw(), first);
  EXPECT_LT(resident_compiler_kib(), 4096) << "a second frame needs no compiler";
}

// The robot often sees its first object long after the first frame.
TEST(ShaderCompiler, TakesNoMemoryAfterALaterFrameThatNeedsAnotherShader) {
  Renderer renderer(testing::busy_scene(), {});
  PinholeCamera sky = testing::scene_camera();
  sky.X_WC = look_at({0.5, -2.0, 1.5}, {0.6, -2.0, 30.0});
  static_cast<void>(renderer.draw(testing::busy_poses(), sky, {}));
  const auto later = renderer.draw(testing::busy_poses(), testing::scene_camera(), {});
  EXPECT_LT(resident_compiler_kib(), 4096);
  EXPECT_EQ(later, Renderer(testing::busy_scene(), {}).draw(testing::busy_poses(), testing::scene_camera(), {}));
}

// Samples and a glossy ground need other shaders.
TEST(ShaderCompiler, WorksAgainAfterItsMemoryWasGivenBack) {
  auto scene = testing::busy_scene();
  scene.ground_gloss = 0.5;
  RenderOptions options;
  options.samples = 4;
  options.shadow_taps = 3;
  const auto draw = [&] { return Renderer(scene, options).draw(testing::busy_poses(), testing::scene_camera(), {}); };
  const auto frame = draw();
  for (int i = 0; i < 3; ++i) {
    release_shader_compiler();
    EXPECT_EQ(draw(), frame);
  }
}

}  // namespace
}  // namespace constrictor
