// One image in perception: the whole, and its steps. The images are rendered, with noise.
#include <benchmark/benchmark.h>

#include "perception/blobs.hpp"
#include "perception/line_and_blob_detector.hpp"
#include "perception/line_tracer.hpp"
#include "perception/obstacles.hpp"
#include "perception/picture.hpp"
#include "perception/smoothing.hpp"
#include "unit/perception/rendered_scene.hpp"

namespace constrictor {
namespace {

using namespace perception;

/// A line that bends, two objects, one of them on a zone of its own colour, and another zone.
struct Bench {
  msg::CameraInfo info = testing::camera_info();
  testing::Head head{0.01, 0.02, 0.0, 0.035};
  GroundCamera camera{info, testing::orientation(head), head.height_m, {0.0445, 0.035}};
  PerceptionConfig config;
  cv::Mat rgb;

  Bench() {
    testing::Scene scene;
    scene.line = testing::Arc{{-0.2, 0.05}, -0.15, 0.7};
    scene.rounds = {{msg::kColourGreen, {1.0, 0.5}, 0.09, 0.15},
                    {msg::kColourGreen, {1.0, 0.5}, 0.3},
                    {msg::kColourRed, {1.1, -0.35}, 0.08, 0.15},
                    {msg::kColourYellow, {0.6, -0.4}, 0.12}};
    scene.noise_sd = 0.02;
    rgb = testing::RenderedScene(scene).draw(info, head);
  }
};

void detect(benchmark::State& state) {
  const Bench bench;
  LineAndBlobDetector detector(bench.config);
  int blobs = 0;
  for (auto _ : state) blobs = detector.detect(bench.rgb, bench.camera, msg::kColourBlue).objects.blob_count;
  state.counters["blobs"] = blobs;
}
BENCHMARK(detect)->Unit(benchmark::kMillisecond);

/// The results of all steps, so that each step can be repeated alone.
struct Steps : Bench {
  Smoother smoother;
  ColourClassifier classifier{config};
  cv::Mat smooth, picture;
  Labels labels;
  RegionBuffers buffers;
  Regions regions;

  Steps() {
    smoother.smooth(rgb, smooth);
    classifier.classify(smooth, labels);
    find_regions(labels, camera, config, msg::kColourBlue, {}, buffers, regions);
  }
};

void smooth(benchmark::State& state) {
  Steps steps;
  for (auto _ : state) steps.smoother.smooth(steps.rgb, steps.smooth);
}
void classify(benchmark::State& state) {
  Steps steps;
  for (auto _ : state) steps.classifier.classify(steps.smooth, steps.labels);
}
void regions(benchmark::State& state) {
  Steps steps;
  for (auto _ : state)
    find_regions(steps.labels, steps.camera, steps.config, msg::kColourBlue, {}, steps.buffers, steps.regions);
}
void line(benchmark::State& state) {
  Steps steps;
  for (auto _ : state)
    benchmark::DoNotOptimize(trace_line(steps.labels, steps.regions, steps.camera, steps.config, msg::kColourBlue));
}
void blobs(benchmark::State& state) {
  Steps steps;
  MeasuredSizes measured;
  for (auto _ : state)
    benchmark::DoNotOptimize(
        find_blobs(steps.smooth, steps.regions, steps.camera, steps.config, msg::kColourBlue, {}, measured));
}
void obstacles(benchmark::State& state) {
  Steps steps;
  for (auto _ : state)
    benchmark::DoNotOptimize(find_obstacles(steps.smooth, steps.regions, steps.camera, steps.config));
}

void picture(benchmark::State& state) {
  Steps steps;
  const Percepts percepts = LineAndBlobDetector(steps.config).detect(steps.rgb, steps.camera, msg::kColourBlue);
  for (auto _ : state)
    draw_percepts(steps.rgb, steps.labels.image, steps.camera, percepts.line, percepts.objects, steps.picture);
}
BENCHMARK(smooth)->Unit(benchmark::kMillisecond);
BENCHMARK(classify)->Unit(benchmark::kMillisecond);
BENCHMARK(regions)->Unit(benchmark::kMillisecond);
BENCHMARK(line)->Unit(benchmark::kMillisecond);
BENCHMARK(blobs)->Unit(benchmark::kMillisecond);
BENCHMARK(obstacles)->Unit(benchmark::kMillisecond);
BENCHMARK(picture)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace constrictor
