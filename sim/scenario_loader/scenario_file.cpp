#include "sim/scenario_loader/scenario_file.hpp"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>

#include "component/random.hpp"
#include "constrictor/messages.hpp"
#include "sim/scenario_loader/layout_check.hpp"
#include "sim/scenario_loader/scenario_draft.hpp"

namespace constrictor {
namespace {

constexpr int kMostDraws = 200;

/// The direction of the light, tilted about the x axis and turned about the vertical axis by random angles.
Eigen::Vector3d tilted(const Eigen::Vector3d& direction, double by_rad, Random& random) {
  const Eigen::AngleAxisd tilt(random.uniform(-by_rad, by_rad), Eigen::Vector3d::UnitX());
  const Eigen::AngleAxisd turn(random.uniform(-by_rad, by_rad) * 3.0, Eigen::Vector3d::UnitZ());
  Eigen::Vector3d result = (turn * tilt * direction).normalized();
  result.z() = std::max(result.z(), 0.2);  // otherwise the light would be nearly parallel to the ground
  return result.normalized();
}

/// Draws one scene from the variation. Each varied quantity has its own random stream, and each attempt has new
/// streams.
Scenario draw_scene(const ScenarioDraft& draft, const Variation& vary, std::uint64_t seed, int attempt) {
  const auto stream = [&](const std::string& purpose) {
    return Random(seed + 0x10001ULL * static_cast<std::uint64_t>(attempt), purpose);
  };
  Scenario scene = draft.fixed;
  scene.seed = seed;

  Random line = stream("line");
  const double line_side = vary.mirror_line && line.coin() ? -1.0 : 1.0;
  for (LineSegment& segment : scene.line_segments) {
    segment.curvature_1_m *= line_side * line.factor(vary.line_curvature);
    segment.length_m *= line.factor(vary.line_length);
  }
  const LinePath path = make_line_path(scene.line_begin, scene.line_segments, msg::kMaxLinePoints);
  scene.line_m = path.points_m;
  const auto resolve = [&](const Placement& placement, const Eigen::Vector2d& position_m) {
    const PlanarPose frame = placement.frame == "line_begin" ? path.begin
                             : placement.frame == "line_end" ? path.end
                                                             : PlanarPose{};
    return PlanarPose{frame.p + turned(position_m, frame.yaw_rad), frame.yaw_rad + placement.yaw_rad};
  };
  const auto jitter = [](Random& random, double by_m) {
    const double x = random.uniform(-by_m, by_m);
    return Eigen::Vector2d(x, random.uniform(-by_m, by_m));
  };

  Random objects = stream("objects");
  Random masses = stream("masses");
  Random heights = stream("heights");
  for (std::size_t i = 0; i < scene.objects.size(); ++i) {
    Eigen::Vector2d at = draft.objects[i].position_m;
    if (vary.object_sides && objects.coin()) at.y() = -at.y();
    const PlanarPose pose = resolve(draft.objects[i], at + jitter(objects, vary.object_position_m));
    scene.objects[i].position_m = pose.p;
    scene.objects[i].yaw_rad = pose.yaw_rad;
    scene.objects[i].size_m.head<2>() *= objects.factor(vary.radius);
    scene.objects[i].size_m.z() *= heights.factor(vary.height);
    scene.objects[i].mass_kg *= masses.factor(vary.mass);
  }
  Random zones = stream("zones");
  const double zone_side = vary.zone_sides && zones.coin() ? -1.0 : 1.0;
  for (std::size_t i = 0; i < scene.zones.size(); ++i) {
    Eigen::Vector2d at = draft.zones[i].position_m;
    at.y() *= zone_side;
    scene.zones[i].position_m = resolve(draft.zones[i], at + jitter(zones, vary.zone_position_m)).p;
  }
  for (std::size_t i = 0; i < scene.obstacles.size(); ++i) {
    const PlanarPose pose = resolve(draft.obstacles[i], draft.obstacles[i].position_m);
    scene.obstacles[i].position_m = pose.p;
    scene.obstacles[i].yaw_rad = pose.yaw_rad;
  }
  Random start = stream("start");
  const PlanarPose pose = resolve(draft.start, draft.start.position_m + jitter(start, vary.start_position_m));
  scene.start_m = pose.p;
  scene.start_yaw_rad = pose.yaw_rad + start.uniform(-vary.start_yaw_rad, vary.start_yaw_rad);

  Random friction = stream("friction");
  for (double* coefficient : {&scene.friction.ground_scale, &scene.friction.object_robot, &scene.friction.object_ground,
                              &scene.friction.robot_robot}) {
    *coefficient *= friction.factor(vary.friction);
  }
  Random light = stream("light");
  scene.light.intensity *= light.factor(vary.light_intensity);
  scene.light.ambient = std::min(1.0, scene.light.ambient * light.factor(vary.light_intensity));
  scene.light.direction = tilted(scene.light.direction.normalized(), vary.light_direction_rad, light);
  Random camera = stream("camera");
  scene.camera_noise_sd *= camera.factor(vary.camera_noise);
  return scene;
}

}  // namespace

Scenario read_scenario(const Configuration& root, std::uint64_t seed) {
  const ScenarioDraft draft = read_scenario_draft(root);
  if (draft.random) {
    if (const auto scene = make_random_scene(*draft.random, draft.mission, draft.fixed, seed)) return *scene;
    throw root.error("random", fmt::format("found no scene for seed {} in which the mission is possible, accepted "
                                           "ranges that leave more room",
                                           seed));
  }
  // The layout without variation must be free of overlaps for every seed.
  const std::string overlap = find_overlap(draw_scene(draft, Variation{}, seed, 0));
  if (!overlap.empty())
    throw root.error("objects", fmt::format("found that {}, accepted bodies that do not overlap", overlap));
  for (int attempt = 0; attempt < kMostDraws; ++attempt) {
    Scenario scene = draw_scene(draft, draft.variation, seed, attempt);
    if (find_overlap(scene).empty()) return scene;
  }
  throw root.error("variation",
                   fmt::format("found overlapping bodies in {} draws, accepted smaller ranges", kMostDraws));
}

Scenario load_scenario(const std::filesystem::path& file, std::uint64_t seed) {
  return read_scenario(Configuration::load(file), seed);
}

Scenario load_scenario(const std::filesystem::path& file, std::uint64_t seed, double body_length_m,
                       double body_half_width_m) {
  const Configuration root = Configuration::load(file);
  Scenario scene = read_scenario(root, seed);
  const std::string overlap = find_overlap(scene, body_length_m, body_half_width_m);
  if (!overlap.empty())
    throw root.error("start", fmt::format("found that {} with seed {}, accepted places beside the body of this robot, "
                                          "which reaches {:.2f} m behind its head",
                                          overlap, seed, body_length_m));
  return scene;
}

}  // namespace constrictor
