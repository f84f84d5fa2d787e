// One image of the head's camera, drawn by sim/render and by MuJoCo's renderer: 320 x 240 pixels of a like scene, both
// on OSMesa, with the same settings of Mesa, with and without shadows.
#include <benchmark/benchmark.h>

#include <exception>

#include "bench/camera_scene.hpp"
#include "bench/engines/mujoco_picture.hpp"

namespace constrictor {
namespace {

using bench::CameraScene;

/// Share of the pixels that have a colour, those of line, zone and objects: about the same in like images.
double coloured_share(const std::vector<std::uint8_t>& rgb) {
  std::size_t coloured = 0;
  for (std::size_t i = 0; i + 2 < rgb.size(); i += 3) {
    const auto [least, most] = std::minmax({rgb[i], rgb[i + 1], rgb[i + 2]});
    if (most - least > 40) ++coloured;
  }
  return 3.0 * static_cast<double>(coloured) / static_cast<double>(rgb.size());
}

void constrictor_draws(benchmark::State& state) {
  const CameraScene bench;
  RenderOptions options;
  if (state.range(0) == 0) options.shadow_map_size = 0;
  Renderer renderer(bench.scene, options);
  state.counters["coloured"] = coloured_share(renderer.draw(bench.poses, bench.camera, bench.region));
  for (auto _ : state) benchmark::DoNotOptimize(renderer.draw(bench.poses, bench.camera, bench.region).data());
}

void mujoco_draws(benchmark::State& state) {
  const CameraScene bench;
  const int shadow_map_size = state.range(0) == 0 ? 0 : RenderOptions{}.shadow_map_size;
  try {
    MujocoPicture picture(bench.scene, bench.poses, bench.camera, bench.region, shadow_map_size);
    state.counters["coloured"] = coloured_share(picture.draw());
    for (auto _ : state) benchmark::DoNotOptimize(picture.draw().data());
  } catch (const std::exception& error) {
    state.SkipWithError(error.what());
  }
}

BENCHMARK(constrictor_draws)->Name("renderer/constrictor")->ArgName("shadows")->Arg(1)->Arg(0);
BENCHMARK(mujoco_draws)->Name("renderer/mujoco")->ArgName("shadows")->Arg(1)->Arg(0);

}  // namespace
}  // namespace constrictor
