#include "sim/scenario/scenario_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "sim/scenario/layout_check.hpp"
#include "sim/scenario/line_path.hpp"
#include "sim/scenario/random.hpp"

namespace constrictor {
namespace {

constexpr double kFar_m = 50.0;  // from the origin
// Array sizes of simulation.idl.
constexpr std::size_t kMostObjects = 16;
constexpr std::size_t kMostZones = 8;
constexpr std::size_t kMostObstacles = 64;
constexpr std::size_t kMostLinePoints = 512;
constexpr std::size_t kMostSegments = 64;
// The longest robot that the overlap check allows for, and its half width.
constexpr double kBody_m = 2.2;
constexpr double kHalfWidth_m = 0.06;
constexpr int kMostDraws = 200;
constexpr double kNever = std::numeric_limits<double>::quiet_NaN();

const std::vector<std::string> kColours = {"green", "red", "blue", "yellow"};  // 1 … of common.idl

/// A position relative to the world or to an end of the line.
struct Placement {
  std::string frame;
  Eigen::Vector2d position_m{0.0, 0.0};
  double yaw_rad = 0.0;
};

/// ± ranges about the file's values.
struct Variation {
  bool mirror_line = false;
  bool object_sides = false;
  bool zone_sides = false;
  double line_curvature = 0.0;
  double line_length = 0.0;
  double object_position_m = 0.0;
  double zone_position_m = 0.0;
  double start_position_m = 0.0;
  double start_yaw_rad = 0.0;
  double radius = 0.0;
  double mass = 0.0;
  double friction = 0.0;
  double light_intensity = 0.0;
  double light_direction_rad = 0.0;
  double camera_noise = 0.0;
};

/// A file as it was read; `fixed` holds what needs no frame of the line.
struct Draft {
  Scenario fixed;
  PlanarFrame line_begin;
  std::vector<LineSegment> segments;
  std::vector<Placement> objects;
  std::vector<Placement> zones;
  std::vector<Placement> obstacles;
  Placement start;
  Variation variation;
};

std::uint8_t read_colour(Configuration& from) {
  const std::string name = from.text("colour", kColours);
  return static_cast<std::uint8_t>(1 + (std::find(kColours.begin(), kColours.end(), name) - kColours.begin()));
}

Placement read_placement(Configuration& from) {
  Placement placement;
  placement.frame = from.text("frame", {"world", "line_begin", "line_end"}, "world");
  const std::vector<double> position = from.numbers("position_m", {-kFar_m, kFar_m}, 2, 2);
  placement.position_m = {position[0], position[1]};
  placement.yaw_rad = from.number("yaw_rad", {-2.0 * std::numbers::pi, 2.0 * std::numbers::pi}, 0.0);
  return placement;
}

/// Shape and size of an object or obstacle.
std::pair<BodyShape, Eigen::Vector3d> read_shape(Configuration& from, double largest_m) {
  if (from.text("shape", {"cylinder", "box"}, "cylinder") == "cylinder") {
    const double radius = from.number("radius_m", {0.005, largest_m});
    return {BodyShape::kCylinder, {radius, radius, from.number("height_m", {0.01, 3.0})}};
  }
  const std::vector<double> size = from.numbers("size_m", {0.01, 2.0 * largest_m}, 3, 3);
  return {BodyShape::kBox, {size[0], size[1], size[2]}};
}

void read_line(Configuration line, Draft& draft) {
  draft.fixed.line_colour = read_colour(line);
  draft.fixed.line_width_m = line.number("width_m", {0.005, 0.5});
  const std::vector<double> begin = line.numbers("begin_m", {-kFar_m, kFar_m}, 2, 2);
  draft.line_begin.origin_m = {begin[0], begin[1]};
  draft.line_begin.yaw_rad = line.number("begin_yaw_rad", {-2.0 * std::numbers::pi, 2.0 * std::numbers::pi}, 0.0);
  for (Configuration& segment : line.list("segments")) {
    draft.segments.push_back({segment.number("length_m", {0.02, 50.0}), segment.number("curvature_1_m", {-5.0, 5.0}, 0.0)});
    segment.finish();
  }
  if (draft.segments.empty() || draft.segments.size() > kMostSegments) {
    throw line.error("segments", fmt::format("found a list of {}, accepted a list of 1 to {} maps", draft.segments.size(),
                                             kMostSegments));
  }
  line.finish();
}

void read_bodies(Configuration& root, Draft& draft) {
  for (Configuration& from : root.list("objects", false)) {
    ScenarioObject object;
    object.colour = read_colour(from);
    std::tie(object.shape, object.size_m) = read_shape(from, 0.5);
    object.mass_kg = from.number("mass_kg", {0.02, 20.0});
    draft.objects.push_back(read_placement(from));
    draft.fixed.objects.push_back(object);
    from.finish();
  }
  for (Configuration& from : root.list("zones", false)) {
    ScenarioZone zone;
    zone.colour = read_colour(from);
    zone.radius_m = from.number("radius_m", {0.02, 5.0});
    draft.zones.push_back(read_placement(from));
    draft.fixed.zones.push_back(zone);
    from.finish();
  }
  for (Configuration& from : root.list("obstacles", false)) {
    ScenarioObstacle obstacle;
    std::tie(obstacle.shape, obstacle.size_m) = read_shape(from, 20.0);
    draft.obstacles.push_back(read_placement(from));
    draft.fixed.obstacles.push_back(obstacle);
    from.finish();
  }
  const auto limit = [&](const char* key, std::size_t found, std::size_t most) {
    if (found > most) throw root.error(key, fmt::format("found a list of {}, accepted a list of 0 to {}", found, most));
  };
  limit("objects", draft.objects.size(), kMostObjects);
  limit("zones", draft.zones.size(), kMostZones);
  limit("obstacles", draft.obstacles.size(), kMostObstacles);
}

void read_perturbations(Configuration& root, Scenario& scenario) {
  for (Configuration& from : root.list("perturbations", false)) {
    ScenarioPerturbation perturbation;
    const auto last = static_cast<std::int64_t>(scenario.objects.size()) - 1;
    if (last < 0) throw from.error("object", "found a force on an object, accepted none in a scenario without objects");
    perturbation.object = static_cast<std::size_t>(from.integer("object", 0, last));
    const bool timed = from.has("at_s");
    if (timed == from.has("when_displaced_m")) {
      throw from.error("at_s", "found both or neither of at_s and when_displaced_m, accepted one of them");
    }
    perturbation.at_s = timed ? from.number("at_s", {0.0, 1e5}) : kNever;
    perturbation.displaced_m = timed ? kNever : from.number("when_displaced_m", {0.001, 100.0});
    perturbation.duration_s = from.number("duration_s", {0.02, 1e4});
    const std::vector<double> force = from.numbers("force_n", {-500.0, 500.0}, 3, 3);
    perturbation.force_n = {force[0], force[1], force[2]};
    scenario.perturbations.push_back(perturbation);
    from.finish();
  }
}

void read_surroundings(Configuration& root, Scenario& scenario) {
  Configuration friction = root.section("friction", false);
  scenario.friction.ground_scale = friction.number("ground_scale", {0.1, 5.0}, scenario.friction.ground_scale);
  scenario.friction.object_robot = friction.number("object_robot", {0.0, 5.0}, scenario.friction.object_robot);
  scenario.friction.object_ground = friction.number("object_ground", {0.0, 5.0}, scenario.friction.object_ground);
  scenario.friction.robot_robot = friction.number("robot_robot", {0.0, 5.0}, scenario.friction.robot_robot);
  friction.finish();

  Configuration light = root.section("light", false);
  if (light.has("direction")) {
    const std::vector<double> direction = light.numbers("direction", {-1.0, 1.0}, 3, 3);
    scenario.light.direction = {direction[0], direction[1], direction[2]};
  }
  if (scenario.light.direction.z() <= 0.05) {
    throw light.error("direction", "found a light at or below the horizon, accepted a third number above 0.05");
  }
  scenario.light.intensity = light.number("intensity", {0.05, 3.0}, scenario.light.intensity);
  scenario.light.ambient = light.number("ambient", {0.0, 1.0}, scenario.light.ambient);
  light.finish();

  if (root.has("ground_colour")) {
    const std::vector<double> colour = root.numbers("ground_colour", {0.0, 1.0}, 3, 3);
    scenario.ground_colour = {colour[0], colour[1], colour[2]};
  }
  Configuration noise = root.section("noise", false);
  scenario.sensor_noise = noise.flag("sensors", true);
  scenario.camera_noise_sd = noise.number("camera_sd", {0.0, 0.3}, 0.0);
  noise.finish();
}

Variation read_variation(Configuration from) {
  Variation variation;
  variation.mirror_line = from.flag("mirror_line", false);
  variation.object_sides = from.flag("object_sides", false);
  variation.zone_sides = from.flag("zone_sides", false);
  variation.line_curvature = from.number("line_curvature", {0.0, 0.9}, 0.0);
  variation.line_length = from.number("line_length", {0.0, 0.9}, 0.0);
  variation.object_position_m = from.number("object_position_m", {0.0, 5.0}, 0.0);
  variation.zone_position_m = from.number("zone_position_m", {0.0, 5.0}, 0.0);
  variation.start_position_m = from.number("start_position_m", {0.0, 5.0}, 0.0);
  variation.start_yaw_rad = from.number("start_yaw_rad", {0.0, std::numbers::pi}, 0.0);
  variation.radius = from.number("radius", {0.0, 0.9}, 0.0);
  variation.mass = from.number("mass", {0.0, 0.9}, 0.0);
  variation.friction = from.number("friction", {0.0, 0.9}, 0.0);
  variation.light_intensity = from.number("light_intensity", {0.0, 0.9}, 0.0);
  variation.light_direction_rad = from.number("light_direction_rad", {0.0, 1.0}, 0.0);
  variation.camera_noise = from.number("camera_noise", {0.0, 1.0}, 0.0);
  from.finish();
  return variation;
}

Draft read_draft(Configuration& root) {
  Draft draft;
  draft.fixed.name = root.text("name");
  if (draft.fixed.name.empty() || draft.fixed.name.size() > 63) {
    throw root.error("name", fmt::format("found {} letters, accepted 1 to 63", draft.fixed.name.size()));
  }
  if (root.has("line")) read_line(root.section("line"), draft);
  read_bodies(root, draft);
  read_perturbations(root, draft.fixed);
  read_surroundings(root, draft.fixed);
  Configuration start = root.section("start");
  draft.start = read_placement(start);
  start.finish();
  draft.variation = read_variation(root.section("variation", false));
  root.finish();
  return draft;
}

/// The light turned about a random horizontal axis and the vertical one.
Eigen::Vector3d turned(const Eigen::Vector3d& direction, double by_rad, Random& random) {
  const Eigen::AngleAxisd tilt(random.uniform(-by_rad, by_rad), Eigen::Vector3d::UnitX());
  const Eigen::AngleAxisd turn(random.uniform(-by_rad, by_rad) * 3.0, Eigen::Vector3d::UnitZ());
  Eigen::Vector3d result = (turn * tilt * direction).normalized();
  result.z() = std::max(result.z(), 0.2);  // never a light that only grazes
  return result.normalized();
}

/// One draw of the variation. Each aspect has its own stream, each attempt its own number.
Scenario instantiate(const Draft& draft, const Variation& vary, std::uint64_t seed, int attempt) {
  const auto stream = [&](const std::string& purpose) {
    return Random(seed + 0x10001ULL * static_cast<std::uint64_t>(attempt), purpose);
  };
  Scenario scene = draft.fixed;
  scene.seed = seed;

  Random line = stream("line");
  const double line_side = vary.mirror_line && line.coin() ? -1.0 : 1.0;
  std::vector<LineSegment> segments = draft.segments;
  for (LineSegment& segment : segments) {
    segment.curvature_1_m *= line_side * line.factor(vary.line_curvature);
    segment.length_m *= line.factor(vary.line_length);
  }
  const LinePath path = make_line_path(draft.line_begin, segments, kMostLinePoints);
  scene.line_m = path.points_m;
  const auto resolve = [&](const Placement& placement, const Eigen::Vector2d& position_m) {
    const PlanarFrame frame = placement.frame == "line_begin" ? path.begin
                              : placement.frame == "line_end" ? path.end
                                                              : PlanarFrame{};
    return PlanarFrame{frame.point(position_m), frame.yaw_rad + placement.yaw_rad};
  };
  const auto jitter = [](Random& random, double by_m) {
    const double x = random.uniform(-by_m, by_m);
    return Eigen::Vector2d(x, random.uniform(-by_m, by_m));
  };

  Random objects = stream("objects");
  Random masses = stream("masses");
  for (std::size_t i = 0; i < scene.objects.size(); ++i) {
    Eigen::Vector2d at = draft.objects[i].position_m;
    if (vary.object_sides && objects.coin()) at.y() = -at.y();
    const PlanarFrame pose = resolve(draft.objects[i], at + jitter(objects, vary.object_position_m));
    scene.objects[i].position_m = pose.origin_m;
    scene.objects[i].yaw_rad = pose.yaw_rad;
    scene.objects[i].size_m.head<2>() *= objects.factor(vary.radius);
    scene.objects[i].mass_kg *= masses.factor(vary.mass);
  }
  Random zones = stream("zones");
  const double zone_side = vary.zone_sides && zones.coin() ? -1.0 : 1.0;
  for (std::size_t i = 0; i < scene.zones.size(); ++i) {
    Eigen::Vector2d at = draft.zones[i].position_m;
    at.y() *= zone_side;
    scene.zones[i].position_m = resolve(draft.zones[i], at + jitter(zones, vary.zone_position_m)).origin_m;
  }
  for (std::size_t i = 0; i < scene.obstacles.size(); ++i) {
    const PlanarFrame pose = resolve(draft.obstacles[i], draft.obstacles[i].position_m);
    scene.obstacles[i].position_m = pose.origin_m;
    scene.obstacles[i].yaw_rad = pose.yaw_rad;
  }
  Random start = stream("start");
  const PlanarFrame pose = resolve(draft.start, draft.start.position_m + jitter(start, vary.start_position_m));
  scene.start_m = pose.origin_m;
  scene.start_yaw_rad = pose.yaw_rad + start.uniform(-vary.start_yaw_rad, vary.start_yaw_rad);

  Random friction = stream("friction");
  for (double* coefficient : {&scene.friction.ground_scale, &scene.friction.object_robot, &scene.friction.object_ground,
                              &scene.friction.robot_robot}) {
    *coefficient *= friction.factor(vary.friction);
  }
  Random light = stream("light");
  scene.light.intensity *= light.factor(vary.light_intensity);
  scene.light.ambient = std::min(1.0, scene.light.ambient * light.factor(vary.light_intensity));
  scene.light.direction = turned(scene.light.direction.normalized(), vary.light_direction_rad, light);
  Random camera = stream("camera");
  scene.camera_noise_sd *= camera.factor(vary.camera_noise);
  return scene;
}

}  // namespace

Scenario read_scenario(Configuration root, std::uint64_t seed) {
  const Draft draft = read_draft(root);
  // The file's own layout must be sound whatever the seed.
  const std::string overlap = find_overlap(instantiate(draft, Variation{}, seed, 0), kBody_m, kHalfWidth_m);
  if (!overlap.empty()) throw root.error("objects", fmt::format("found that {}, accepted bodies apart", overlap));
  for (int attempt = 0; attempt < kMostDraws; ++attempt) {
    Scenario scene = instantiate(draft, draft.variation, seed, attempt);
    if (find_overlap(scene, kBody_m, kHalfWidth_m).empty()) return scene;
  }
  throw root.error("variation", fmt::format("found overlapping bodies in {} draws, accepted ranges that leave them room",
                                            kMostDraws));
}

Scenario load_scenario(const std::filesystem::path& file, std::uint64_t seed) {
  return read_scenario(Configuration::load(file), seed);
}

}  // namespace constrictor
