// How the cost of a tick or an image grows with the size of the task. bench_table fits exponents to these times.
#include <benchmark/benchmark.h>

#include "barrier/local_run.hpp"
#include "component/data_path.hpp"
#include "sim/camera/camera.hpp"
#include "sim/render/renderer.hpp"
#include "support/scripted_members.hpp"
#include "unit/world/open_loop_gait.hpp"

namespace constrictor {
namespace {

constexpr double kPeriod_s = 0.02;

RobotModel robot_of(std::size_t modules) {
  RobotModel robot = load_robot(data_path("components/lib/robot/mamba.yaml"));
  const auto joints = robot.joints;
  robot.module_count = modules;
  robot.joints.resize(modules - 1);
  for (std::size_t i = 0; i < robot.joints.size(); ++i) robot.joints[i] = joints[i % 2];
  return robot;
}

void undulate(benchmark::State& state, const RobotModel& robot, const Scenario& scenario) {
  World world(robot, scenario);
  const OpenLoopGait gait;
  int tick = 0;
  for (; tick < 50; ++tick) gait.drive(world, tick * kPeriod_s, kPeriod_s);
  for (auto _ : state) gait.drive(world, tick++ * kPeriod_s, kPeriod_s);
}

/// One tick of the physics with this number of modules.
void modules(benchmark::State& state) { undulate(state, robot_of(static_cast<std::size_t>(state.range(0))), {}); }
BENCHMARK(modules)->Arg(10)->Arg(20)->Arg(40)->Arg(60)->Unit(benchmark::kMillisecond)->Iterations(150);

/// One tick of the physics with this number of objects that stand on the ground, out of the robot's reach.
void objects(benchmark::State& state) {
  Scenario scenario;
  for (int i = 0; i < state.range(0); ++i) {
    ScenarioObject object;
    const int column = i % 10, row = i / 10;
    object.position_m = {2.0 + 0.4 * column, 3.0 + 0.4 * row};
    scenario.objects.push_back(object);
  }
  undulate(state, robot_of(24), scenario);
}
BENCHMARK(objects)->Arg(1)->Arg(5)->Arg(20)->Arg(50)->Unit(benchmark::kMillisecond)->Iterations(150);

/// One tick of the barrier with this number of members in one process, each of which reads the joints and writes
/// nothing.
void members(benchmark::State& state) {
  std::vector<ComponentFactory> factories{testing::still_robot()};
  for (int i = 1; i < state.range(0); ++i) {
    factories.push_back(testing::scripted_member("member_" + std::to_string(i), [](Wiring& wiring) {
      const auto joints = wiring.latest(topics::kJointState);
      return [joints](const Tick&) { benchmark::DoNotOptimize(joints.get()); };
    }));
  }
  LocalRun run(std::move(factories), {});
  run.advance(10);
  for (auto _ : state) run.advance(1);
}
BENCHMARK(members)->Arg(2)->Arg(8)->Arg(16)->Arg(32)->Unit(benchmark::kMillisecond)->Iterations(300);

/// One image with this number of columns; with three quarters as many rows.
void columns(benchmark::State& state) {
  Scene scene;
  scene.objects = {{SolidShape::kCylinder, {0.08, 0.08, 0.15}, colour_reflectance(msg::kColourGreen)}};
  scene.light.direction = Eigen::Vector3d(0.3, -0.4, 0.85).normalized();
  ScenePoses poses;
  poses.X_WObject = {Eigen::Isometry3d(Eigen::Translation3d(1.5, 0.3, 0.075))};
  poses.X_WModule = {Eigen::Isometry3d(Eigen::Translation3d(0.0, 0.0, 0.035))};
  CameraModel model = load_robot(data_path("components/lib/robot/mamba.yaml")).camera;
  model.width = static_cast<int>(state.range(0));
  model.height = model.width * 3 / 4;
  PinholeCamera camera = camera_intrinsics(model);
  camera.X_WC = poses.X_WModule[0] * camera_mount(model);
  const ShadowRegion region{{0.6, 0.0}, 1.0};
  Renderer renderer(scene, {});
  (void)renderer.draw(poses, camera, region);  // compiles the shaders
  for (auto _ : state) benchmark::DoNotOptimize(renderer.draw(poses, camera, region).data());
}
BENCHMARK(columns)->Arg(160)->Arg(320)->Arg(640)->Arg(1280)->Unit(benchmark::kMillisecond)->Iterations(30);

}  // namespace
}  // namespace constrictor
