#include "sim/scenario_loader/scenario_draft.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <tuple>

#include "component/mission.hpp"
#include "constrictor/constants.hpp"
#include "sim/scenario_loader/contrast_check.hpp"

namespace constrictor {
namespace {

constexpr double kFar_m = 50.0;  // greatest distance from the origin
constexpr std::size_t kMostSegments = 64;
constexpr std::size_t kMostRandomObjects = 3;  // one behind the other, beyond the end of the line
constexpr double kNever = std::numeric_limits<double>::quiet_NaN();
static_assert(kUsualLineColour == msg::kColourBlue);

const std::vector<std::string>& colours() {
  static const std::vector<std::string> names = names_of(constants::kColour, msg::kColourGreen);
  return names;
}

std::uint8_t colour_number(const std::string& name) { return *value_of(constants::kColour, name); }

std::uint8_t read_colour(Configuration& from) { return colour_number(from.text("colour", colours())); }

Placement read_placement(Configuration& from, bool has_line) {
  Placement placement;
  placement.frame = from.text("frame", {"world", "line_begin", "line_end"}, "world");
  if (!has_line && placement.frame != "world") {
    throw from.error("frame",
                     fmt::format("found {}, accepted world, because the scenario has no line", placement.frame));
  }
  const std::vector<double> position = from.numbers("position_m", {-kFar_m, kFar_m}, 2, 2);
  placement.position_m = {position[0], position[1]};
  placement.yaw_rad = from.number("yaw_rad", {-2.0 * std::numbers::pi, 2.0 * std::numbers::pi}, 0.0);
  return placement;
}

/// Reads shape and size of an object or obstacle.
std::pair<BodyShape, Eigen::Vector3d> read_shape(Configuration& from, double largest_m) {
  if (from.text("shape", {"cylinder", "box"}, "cylinder") == "cylinder") {
    const double radius = from.number("radius_m", {0.005, largest_m});
    return {BodyShape::kCylinder, {radius, radius, from.number("height_m", {0.01, 3.0})}};
  }
  const std::vector<double> size = from.numbers("size_m", {0.01, 2.0 * largest_m}, 3, 3);
  return {BodyShape::kBox, {size[0], size[1], size[2]}};
}

void read_line(Configuration line, ScenarioDraft& draft) {
  draft.fixed.line_colour = read_colour(line);
  draft.fixed.line_width_m = line.number("width_m", {0.005, 0.5});
  const std::vector<double> begin = line.numbers("begin_m", {-kFar_m, kFar_m}, 2, 2);
  draft.fixed.line_begin.p = {begin[0], begin[1]};
  draft.fixed.line_begin.yaw_rad = line.number("begin_yaw_rad", {-2.0 * std::numbers::pi, 2.0 * std::numbers::pi}, 0.0);
  for (Configuration& segment : line.list("segments")) {
    draft.fixed.line_segments.push_back(
        {segment.number("length_m", {0.02, 50.0}), segment.number("curvature_1_m", {-5.0, 5.0}, 0.0)});
    segment.finish();
  }
  if (draft.fixed.line_segments.empty() || draft.fixed.line_segments.size() > kMostSegments) {
    throw line.error("segments", fmt::format("found a list of {}, accepted a list of 1 to {} maps",
                                             draft.fixed.line_segments.size(), kMostSegments));
  }
  line.finish();
}

/// Reads a list of bodies, each with its placement. `read` reads what else a body has.
template <class Body>
void read_list(Configuration& root, const char* key, void (*read)(Configuration& from, Body& body), bool has_line,
               std::vector<Body>& bodies, std::vector<Placement>& placements) {
  for (Configuration& from : root.list(key, false)) {
    read(from, bodies.emplace_back());
    placements.push_back(read_placement(from, has_line));
    from.finish();
  }
}

void read_object(Configuration& from, ScenarioObject& object) {
  object.colour = read_colour(from);
  std::tie(object.shape, object.size_m) = read_shape(from, 0.5);
  object.mass_kg = from.number("mass_kg", {0.02, 20.0});
}

void read_zone(Configuration& from, ScenarioZone& zone) {
  zone.colour = read_colour(from);
  zone.radius_m = from.number("radius_m", kZoneRadiusBounds_m);
}

void read_obstacle(Configuration& from, ScenarioObstacle& obstacle) {
  std::tie(obstacle.shape, obstacle.size_m) = read_shape(from, 20.0);
}

void read_bodies(Configuration& root, bool has_line, ScenarioDraft& draft) {
  read_list(root, "objects", read_object, has_line, draft.fixed.objects, draft.objects);
  read_list(root, "zones", read_zone, has_line, draft.fixed.zones, draft.zones);
  read_list(root, "obstacles", read_obstacle, has_line, draft.fixed.obstacles, draft.obstacles);
  const auto limit = [&](const char* key, std::size_t found, std::size_t most) {
    if (found > most) throw root.error(key, fmt::format("found a list of {}, accepted a list of 0 to {}", found, most));
  };
  limit("objects", draft.objects.size(), msg::kMaxSceneObjects);
  limit("zones", draft.zones.size(), msg::kMaxZones);
  limit("obstacles", draft.obstacles.size(), msg::kMaxObstacles);
}

/// Checks that the mission can be carried out in this scene. This check is the only use of the mission here: the
/// launcher passes this section of the file to the components. Returns the mission.
Mission check_mission(const Configuration& section, const Scenario& scenario) {
  Mission mission = read_mission(section);
  const std::vector<std::uint8_t>& sequence = mission.sequence;
  for (const std::uint8_t colour : sequence) {
    const auto has_colour = [colour](const auto& body) { return body.colour == colour; };
    const auto wanted = std::count(sequence.begin(), sequence.end(), colour);
    const auto found = std::count_if(scenario.objects.begin(), scenario.objects.end(), has_colour);
    const char* name = name_of(constants::kColour, colour);
    if (found < wanted) {
      throw section.error("sequence", fmt::format("found {} {} times, accepted at most the number of {} objects, {}",
                                                  name, wanted, name, found));
    }
    if (std::none_of(scenario.zones.begin(), scenario.zones.end(), has_colour)) {
      throw section.error("sequence", fmt::format("found {}, accepted colours for which there is a zone", name));
    }
  }
  if (mission.line_colour != scenario.line_colour) {
    throw section.error("line_colour", fmt::format("found {}, accepted the colour of the line, {}",
                                                   name_of(constants::kColour, mission.line_colour),
                                                   name_of(constants::kColour, scenario.line_colour)));
  }
  return mission;
}

void read_perturbations(Configuration& root, Scenario& scenario) {
  for (Configuration& from : root.list("perturbations", false)) {
    ScenarioPerturbation perturbation;
    const auto last = static_cast<std::int64_t>(scenario.objects.size()) - 1;
    if (last < 0)
      throw from.error("object", "found a force on an object, accepted no force because the scenario has no objects");
    perturbation.object = static_cast<std::size_t>(from.integer("object", 0, last));
    const bool timed = from.has("at_s");
    if (timed == from.has("when_displaced_m")) {
      throw from.error("at_s", "found both or neither of at_s and when_displaced_m, accepted one of them");
    }
    perturbation.at_s = timed ? from.number("at_s", {0.0, 1e5}) : kNever;
    perturbation.displaced_m = timed ? kNever : from.number("when_displaced_m", {0.001, 100.0});
    if (from.has("moved_m")) {
      if (from.has("force_n")) throw from.error("moved_m", "found also force_n, accepted one of them");
      const std::vector<double> moved = from.numbers("moved_m", {-100.0, 100.0}, 2, 2);
      perturbation.moved_m = {moved[0], moved[1]};
    } else {
      perturbation.duration_s = from.number("duration_s", {0.02, 1e4});
      const std::vector<double> force = from.numbers("force_n", {-500.0, 500.0}, 3, 3);
      perturbation.force_n = {force[0], force[1], force[2]};
    }
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

  Configuration body = root.section("body", false);
  scenario.body.mass_scale = body.number("mass_scale", {0.2, 5.0}, scenario.body.mass_scale);
  body.finish();

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

  Configuration slope = root.section("slope", false);
  const double angle_rad = std::atan(slope.number("grade", {0.0, 0.2}, 0.0));
  const double uphill_rad = slope.number("uphill_rad", {-std::numbers::pi, std::numbers::pi}, 0.0);
  slope.finish();
  if (angle_rad > 0.0) {
    const Eigen::Vector3d down(-std::sin(angle_rad) * std::cos(uphill_rad), -std::sin(angle_rad) * std::sin(uphill_rad),
                               -std::cos(angle_rad));
    scenario.gravity_m_s2 = scenario.gravity_m_s2.norm() * down;
  }

  if (root.has("ground_colour")) {
    const std::vector<double> colour = root.numbers("ground_colour", {0.0, 1.0}, 3, 3);
    scenario.ground_colour = {colour[0], colour[1], colour[2]};
  }
  scenario.ground_gloss = root.number("ground_gloss", {0.0, 4.0}, scenario.ground_gloss);
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
  variation.height = from.number("height", {0.0, 0.9}, 0.0);
  variation.mass = from.number("mass", {0.0, 0.9}, 0.0);
  variation.friction = from.number("friction", {0.0, 0.9}, 0.0);
  variation.light_intensity = from.number("light_intensity", {0.0, 0.9}, 0.0);
  variation.light_direction_rad = from.number("light_direction_rad", {0.0, 1.0}, 0.0);
  variation.camera_noise = from.number("camera_noise", {0.0, 1.0}, 0.0);
  from.finish();
  return variation;
}

/// The mission of a random scene, for which the scene is made.
Mission read_random_mission(const Configuration& section) {
  Mission mission = read_mission(section);
  std::vector<std::uint8_t> distinct = mission.sequence;
  std::sort(distinct.begin(), distinct.end());
  distinct.erase(std::unique(distinct.begin(), distinct.end()), distinct.end());
  if (distinct.empty() || mission.sequence.size() > kMostRandomObjects || distinct.size() > kMostRandomZones) {
    throw section.error("sequence",
                        fmt::format("found {} colours, {} of them different, accepted 1 to {} colours, at "
                                    "most {} of them different",
                                    mission.sequence.size(), distinct.size(), kMostRandomObjects, kMostRandomZones));
  }
  return mission;
}

void read_random(Configuration& root, ScenarioDraft& draft) {
  for (const char* key : {"line", "objects", "zones", "obstacles", "perturbations", "start", "variation"}) {
    if (root.has(key))
      throw root.error(key, "found a section that the random scene replaces, accepted either this section or `random`");
  }
  draft.random = read_random_scene(root.section("random"));
  draft.mission = read_random_mission(root.section("mission"));
  read_surroundings(root, draft.fixed);
  check_contrast(root, draft.fixed.ground_colour, true, draft.mission);
  root.finish();
}

}  // namespace

ScenarioDraft read_scenario_draft(Configuration root) {
  ScenarioDraft draft;
  draft.fixed.name = root.text("name");
  if (draft.fixed.name.empty() || draft.fixed.name.size() > 63) {
    throw root.error("name", fmt::format("found {} letters, accepted 1 to 63", draft.fixed.name.size()));
  }
  if (root.has("random")) {
    read_random(root, draft);
    return draft;
  }
  if (root.has("line")) read_line(root.section("line"), draft);
  const bool has_line = !draft.fixed.line_segments.empty();
  read_bodies(root, has_line, draft);
  if (root.has("mission")) draft.mission = check_mission(root.section("mission"), draft.fixed);
  read_perturbations(root, draft.fixed);
  read_surroundings(root, draft.fixed);
  if (root.has("mission")) check_contrast(root, draft.fixed.ground_colour, has_line, draft.mission);
  Configuration start = root.section("start");
  draft.start = read_placement(start, has_line);
  start.finish();
  draft.variation = read_variation(root.section("variation", false));
  root.finish();
  return draft;
}

}  // namespace constrictor
