// One image of the head's camera: its passes, and the whole component with its message.
#include <benchmark/benchmark.h>

#include <cmath>

#include "barrier/local_run.hpp"
#include "component/data_path.hpp"
#include "sim/camera/camera.hpp"
#include "sim/render/pixel_noise.hpp"
#include "sim/render/renderer.hpp"
#include "unit/camera/scene_plant.hpp"

namespace constrictor {
namespace {

/// The view of the head along a line with two objects and a zone; the body undulates behind it.
struct Bench {
  Scene scene;
  ScenePoses poses;
  PinholeCamera camera;
  ShadowRegion region;

  explicit Bench(double tilt_rad = 0.3) {
    for (int i = 0; i <= 200; ++i) scene.line_m.emplace_back(0.03 * i - 3.0, 0.2 * std::sin(0.05 * i));
    scene.line_colour = colour_reflectance(msg::kColourBlue);
    scene.zones = {{{1.2, 0.7}, 0.4, colour_reflectance(msg::kColourGreen)}};
    scene.objects = {{SolidShape::kCylinder, {0.08, 0.08, 0.15}, colour_reflectance(msg::kColourGreen)},
                     {SolidShape::kBox, {0.12, 0.12, 0.15}, colour_reflectance(msg::kColourRed)}};
    scene.light.direction = Eigen::Vector3d(0.3, -0.4, 0.85).normalized();
    poses.X_WObject = {Eigen::Isometry3d(Eigen::Translation3d(1.5, 0.3, 0.075)),
                       Eigen::Isometry3d(Eigen::Translation3d(1.3, -0.4, 0.075))};
    for (int i = 0; i < 24; ++i) {
      Eigen::Isometry3d X = Eigen::Isometry3d::Identity();
      X.translate(Eigen::Vector3d(-0.085 * i, 0.1 * std::sin(0.5 * i), 0.035));
      X.rotate(Eigen::AngleAxisd(0.4 * std::cos(0.5 * i), Eigen::Vector3d::UnitZ()));
      poses.X_WModule.push_back(X);
    }
    CameraModel model = load_robot(data_path("components/lib/robot/mamba.yaml")).camera;
    model.tilt_rad = tilt_rad;
    camera = camera_intrinsics(model);
    camera.X_WC = poses.X_WModule[0] * camera_mount(model);
    const double radius_m = CameraConfig{}.shadow_radius_m;
    region = {(camera.X_WC.translation() + 0.6 * radius_m * camera.X_WC.linear().col(2)).head<2>(), radius_m};
  }
};

void draw(benchmark::State& state, const Bench& bench, const RenderOptions& options) {
  Renderer renderer(bench.scene, options);
  (void)renderer.draw(bench.poses, bench.camera, bench.region);  // compiles the shaders
  for (auto _ : state) benchmark::DoNotOptimize(renderer.draw(bench.poses, bench.camera, bench.region).data());
}

/// Shadow map, image and read-back.
void image(benchmark::State& state) { draw(state, Bench(), {}); }
/// Without the shadow map; shadows are still looked up.
void image_without_shadow_map(benchmark::State& state) {
  RenderOptions options;
  options.shadow_map_size = 0;
  draw(state, Bench(), options);
}
/// The sky: only what every frame costs, such as clearing buffers and the read-back.
void image_of_the_sky(benchmark::State& state) { draw(state, Bench(-1.4), {}); }
/// With all bodies, also those that cannot change the image.
void image_of_everything(benchmark::State& state) {
  RenderOptions options;
  options.draw_everything = true;
  draw(state, Bench(), options);
}

void noise(benchmark::State& state) {
  const PixelNoise noise(0.01, 1);
  std::vector<std::uint8_t> rgb(320 * 240 * 3, 100);
  for (auto _ : state) noise.add(rgb, 5);
}

/// Image and noise.
void frame(benchmark::State& state) {
  const Bench bench;
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
