// A plant without physics: it publishes a scene and a world that moves by a formula.
#pragma once

#include <cmath>
#include <memory>
#include <utility>

#include "component/component.hpp"
#include "support/scripted_members.hpp"

namespace constrictor::testing {

/// Two objects 2 m ahead of the origin and a straight line along x. The robot moves along the line at 0.2 m/s and
/// swings its body.
class ScenePlant : public PlantBase {
 public:
  static constexpr std::uint16_t kModules = 12;
  static constexpr double kNoise = 0.02;

  ScenePlant(Wiring& wiring, const Setup& setup)
      : seed_(setup.seed),
        scene_out_(wiring.output(topics::kSceneDescription)),
        world_out_(wiring.output(topics::kWorldState)) {}

  static msg::SceneDescription description(std::uint64_t seed) {
    msg::SceneDescription scene{};
    scene.seed = seed;
    scene.module_count = kModules;
    scene.module_length_m = 0.089;
    scene.module_radius_m = 0.035;
    scene.object_count = 2;
    scene.objects[0] = {msg::kColourGreen, msg::kShapeCylinder, {0.08, 0.08, 0.15}, 0.4};
    scene.objects[1] = {msg::kColourRed, msg::kShapeCylinder, {0.08, 0.08, 0.15}, 0.4};
    scene.line_colour = msg::kColourBlue;
    scene.line_width_m = 0.05;
    scene.line_point_count = 2;
    scene.line_x_m[1] = 2.0;
    scene.light_direction = {0.0, 0.6, 0.8};
    scene.light_intensity = 1.0;
    scene.ambient_intensity = 0.4;
    scene.camera_noise_sd = kNoise;
    scene.ground_colour = {0.45, 0.45, 0.45};
    return scene;
  }

  static msg::Pose3 head_pose(double time_s) {
    const double yaw = 0.2 * std::sin(time_s);
    return {{0.2 * time_s, 0.02 * std::sin(3.0 * time_s), 0.035}, {std::cos(yaw / 2), 0.0, 0.0, std::sin(yaw / 2)}};
  }
  static msg::Pose3 object_pose(int i) { return {{2.0, i == 0 ? 0.4 : -0.4, 0.075}, {1.0, 0.0, 0.0, 0.0}}; }

  void sample(const Tick& tick) override {
    if (tick.index == 0) {
      const auto scene = std::make_unique<msg::SceneDescription>(description(seed_));
      scene_out_.write(*scene);
    }
    msg::WorldState world{};
    world.module_count = kModules;
    for (int i = 0; i < kModules; ++i) {
      world.module_poses[i] = head_pose(tick.time_s() - 0.1 * i);
      world.module_poses[i].position_m.x = 0.2 * tick.time_s() - 0.089 * i;
    }
    world.object_count = 2;
    for (int i = 0; i < 2; ++i) world.object_poses[i] = object_pose(i);
    world_out_.write(world);
  }

 private:
  std::uint64_t seed_;
  Output<msg::SceneDescription> scene_out_;
  Output<msg::WorldState> world_out_;
};

inline ComponentFactory scene_plant_factory() { return member_of_class<ScenePlant>("physics"); }

}  // namespace constrictor::testing
