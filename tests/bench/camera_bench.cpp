// One image of the head's camera: its passes, and the whole component with its message.
#include <benchmark/benchmark.h>

#include "barrier/local_run.hpp"
#include "bench/camera_scene.hpp"
#include "component/data_path.hpp"
#include "sim/camera/camera.hpp"
#include "sim/render/pixel_noise.hpp"
#include "unit/camera/scene_plant.hpp"

namespace constrictor {
namespace {

using bench::CameraScene;

void draw(benchmark::State& state, const CameraScene& bench, const RenderOptions& options) {
  Renderer renderer(bench.scene, options);
  (void)renderer.draw(bench.poses, bench.camera, bench.region);  // compiles the shaders
  for (auto _ : state) benchmark::DoNotOptimize(renderer.draw(bench.poses, bench.camera, bench.region).data());
}

/// Shadow map, image and read-back.
void image(benchmark::State& state) { draw(state, CameraScene(), {}); }
/// Without the shadow map; shadows are still looked up.
void image_without_shadow_map(benchmark::State& state) {
  RenderOptions options;
  options.shadow_map_size = 0;
  draw(state, CameraScene(), options);
}
/// The sky: only what every frame costs, such as clearing buffers and the read-back.
void image_of_the_sky(benchmark::State& state) { draw(state, CameraScene(-1.4), {}); }
/// With all bodies, also those that cannot change the image.
void image_of_everything(benchmark::State& state) {
  RenderOptions options;
  options.draw_everything = true;
  draw(state, CameraScene(), options);
}

void noise(benchmark::State& state) {
  const PixelNoise noise(0.01, 1);
  std::vector<std::uint8_t> rgb(320 * 240 * 3, 100);
  for (auto _ : state) noise.add(rgb, 5);
}

/// Image and noise.
void frame(benchmark::State& state) {
  const CameraScene bench;
  Renderer renderer(bench.scene, {});
  const PixelNoise noise(0.01, 1);
  std::vector<std::uint8_t> rgb = renderer.draw(bench.poses, bench.camera, bench.region);
  for (auto _ : state) {
    rgb = renderer.draw(bench.poses, bench.camera, bench.region);
    noise.add(rgb, 5);
  }
}

/// One period of the component in one process, with a scripted plant: also the messages and their hashes.
void component_period(benchmark::State& state) {
  Setup setup;
  setup.robot_file = data_path("components/lib/robot/mamba.yaml");
  LocalRun run({testing::scene_plant_factory(), make_camera_factory()}, setup);
  run.advance(5);
  for (auto _ : state) run.advance(5);
}

BENCHMARK(image)->Unit(benchmark::kMillisecond);
BENCHMARK(image_without_shadow_map)->Unit(benchmark::kMillisecond);
BENCHMARK(image_of_the_sky)->Unit(benchmark::kMillisecond);
BENCHMARK(image_of_everything)->Unit(benchmark::kMillisecond);
BENCHMARK(noise)->Unit(benchmark::kMillisecond);
BENCHMARK(frame)->Unit(benchmark::kMillisecond);
BENCHMARK(component_period)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace constrictor
