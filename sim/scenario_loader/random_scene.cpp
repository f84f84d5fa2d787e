#include "sim/scenario_loader/random_scene.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "component/random.hpp"
#include "constrictor/messages.hpp"
#include "sim/scenario_loader/layout_check.hpp"
#include "sim/scenario_loader/line_path.hpp"

namespace constrictor {
namespace {

using Eigen::Vector2d;

// Where objects and zones may stand. The robot is 2.1 m long and bends with a radius of about 0.8 m.
constexpr double kFirstObject_m = 0.45;   // beyond the end of the line
constexpr double kObjectSpacing_m = 1.2;  // the body closes around one object alone
constexpr double kZoneBehind_m = 1.25;    // of the beginning of the line: the body drives on over the zone
constexpr double kObjectBeside_m = 0.18;  // of the straight continuation of the line
constexpr double kJitter_m = 0.08;
constexpr double kWay_m = 0.75;        // half of the width that the robot needs along the line
constexpr double kTurning_m = 1.0;     // around objects and zones, where it turns
constexpr double kLineApart_m = 1.6;   // between parts of the line that are not neighbours
constexpr double kNeighbours_m = 2.0;  // along the line
constexpr double kStart_m = 0.3;       // the line begins ahead of the world's origin, as in the case study
constexpr double kPegRadius_m = 0.04;
constexpr double kPegHeight_m = 0.2;

double draw(const Range& range, Random& random) { return random.uniform(range.min, range.max); }

/// A straight beginning, bends that alternate between left and right, and a straight end.
std::vector<LineSegment> draw_line(const RandomScene& ranges, Random& random) {
  constexpr double kStraight_m = 0.6;
  std::vector<LineSegment> segments{{kStraight_m, 0.0}};
  double left_m = draw(ranges.line_length_m, random) - 2.0 * kStraight_m;
  double side = random.coin() ? 1.0 : -1.0;
  while (left_m > 0.2) {
    const double radius_m = draw(ranges.bend_radius_m, random);
    const double length_m = std::min(left_m, radius_m * draw(ranges.bend_rad, random));
    segments.push_back({length_m, side / radius_m});
    left_m -= length_m;
    side = -side;
  }
  segments.push_back({kStraight_m + left_m, 0.0});  // a rest that is too short for a bend
  return segments;
}

ScenarioObject draw_object(const RandomScene& ranges, std::uint8_t colour, Random& random) {
  ScenarioObject object;
  object.colour = colour;
  const double radius_m = draw(ranges.object_radius_m, random);
  const double height_m = draw(ranges.object_height_m, random);
  object.mass_kg = draw(ranges.object_mass_kg, random);
  // A box as large as the cylinder: its half diagonal is the radius.
  const bool box = random.uniform() < ranges.box_share;
  const double side_m = std::numbers::sqrt2 * radius_m;
  object.shape = box ? BodyShape::kBox : BodyShape::kCylinder;
  object.size_m = box ? Eigen::Vector3d(side_m, side_m, height_m) : Eigen::Vector3d(radius_m, radius_m, height_m);
  return object;
}

double distance_to_line_m(const std::vector<Vector2d>& line_m, const Vector2d& point_m) {
  double nearest = INFINITY;
  for (const Vector2d& on_line : line_m) nearest = std::min(nearest, (on_line - point_m).norm());
  return nearest;
}

double distance_to_segment_m(const Vector2d& from, const Vector2d& to, const Vector2d& point_m) {
  const Vector2d along = to - from;
  const double share = std::clamp((point_m - from).dot(along) / std::max(along.squaredNorm(), 1e-12), 0.0, 1.0);
  return (from + share * along - point_m).norm();
}

/// Whether the line comes near to a part of itself.
bool line_meets_itself(const std::vector<Vector2d>& line_m) {
  std::vector<double> arc_m{0.0};
  for (std::size_t i = 1; i < line_m.size(); ++i) arc_m.push_back(arc_m.back() + (line_m[i] - line_m[i - 1]).norm());
  for (std::size_t i = 0; i < line_m.size(); ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      if (arc_m[i] - arc_m[j] > kNeighbours_m && (line_m[i] - line_m[j]).norm() < kLineApart_m) return true;
    }
  }
  return false;
}

/// The line, the objects of the mission, the zones and the start. They may stand in each other's way.
Scenario draw_scene(const RandomScene& ranges, const Mission& mission, Scenario scene, Random& random) {
  scene.line_begin = {{kStart_m, 0.0}, 0.0};
  scene.line_segments = draw_line(ranges, random);
  const LinePath path = make_line_path(scene.line_begin, scene.line_segments, msg::kMaxLinePoints);
  scene.line_m = path.points_m;
  scene.line_colour = mission.line_colour;
  scene.start_m = {0.0, 0.0};
  scene.start_yaw_rad = 0.0;
  double ahead_m = kFirstObject_m;
  for (const std::uint8_t colour : mission.sequence) {
    ScenarioObject object = draw_object(ranges, colour, random);
    const double side = random.coin() ? 1.0 : -1.0;
    const double along_m = ahead_m + random.uniform(-kJitter_m, kJitter_m);
    object.position_m = path.end.p + turned({along_m, side * (kObjectBeside_m + random.uniform(-kJitter_m, kJitter_m))},
                                            path.end.yaw_rad);
    object.yaw_rad = random.uniform(-std::numbers::pi, std::numbers::pi);
    scene.objects.push_back(object);
    ahead_m += kObjectSpacing_m;
  }
  double side = random.coin() ? 1.0 : -1.0;
  for (const std::uint8_t colour : mission.sequence) {
    if (std::any_of(scene.zones.begin(), scene.zones.end(), [&](const auto& zone) { return zone.colour == colour; }))
      continue;
    const double radius_m = draw(ranges.zone_radius_m, random);
    const double behind_m = kZoneBehind_m + random.uniform(-kJitter_m, kJitter_m);
    const double beside_m = radius_m + random.uniform(0.1, 0.2);
    scene.zones.push_back({colour, path.begin.p + turned({-behind_m, side * beside_m}, path.begin.yaw_rad), radius_m});
    side = -side;
  }
  return scene;
}

/// Whether the mission is possible as far as line, objects and zones are concerned.
bool has_room(const Scenario& scene) {
  if (line_meets_itself(scene.line_m)) return false;
  const Vector2d end = scene.line_m.back();
  for (const ScenarioObject& object : scene.objects) {
    const Vector2d at = object.position_m;
    // The end of the line must be its nearest point.
    constexpr double kNearer_m = 0.1;
    if (distance_to_line_m(scene.line_m, at) < (end - at).norm() - kNearer_m) return false;
    for (const ScenarioZone& zone : scene.zones)
      if ((zone.position_m - at).norm() < zone.radius_m + kLineApart_m) return false;
  }
  std::vector<Vector2d> beyond = scene.line_m;
  std::erase_if(beyond, [&](const Vector2d& p) { return (p - scene.line_m.front()).norm() < kNeighbours_m; });
  return std::all_of(scene.zones.begin(), scene.zones.end(), [&](const ScenarioZone& zone) {
    return distance_to_line_m(beyond, zone.position_m) >= zone.radius_m + kWay_m;
  });
}

/// Whether something at this place leaves the robot its way: along the line, around the objects of the mission, and
/// around the zones.
bool is_beside_the_way(const Scenario& scene, std::size_t mission_objects, const Vector2d& at) {
  if (distance_to_line_m(scene.line_m, at) < kWay_m) return false;
  Vector2d before = scene.line_m.back();
  for (std::size_t i = 0; i < mission_objects; ++i) {
    if (distance_to_segment_m(before, scene.objects[i].position_m, at) < kTurning_m) return false;
    before = scene.objects[i].position_m;
  }
  if (distance_to_segment_m(scene.start_m, scene.start_m - Vector2d(kDrawnBody_m, 0.0), at) < kWay_m) return false;
  return std::all_of(scene.zones.begin(), scene.zones.end(), [&](const ScenarioZone& zone) {
    return (zone.position_m - at).norm() >= zone.radius_m + kTurning_m;
  });
}

/// A free place around the scene, not next to another one of `taken`; empty: none was found.
std::optional<Vector2d> draw_place(const Scenario& scene, std::size_t mission_objects, std::vector<Vector2d>& taken,
                                   Random& random) {
  Vector2d low = scene.start_m - Vector2d(kDrawnBody_m, 0.0);
  Vector2d high = low;
  for (const Vector2d& point : scene.line_m) {
    low = low.cwiseMin(point);
    high = high.cwiseMax(point);
  }
  constexpr double kAround_m = 1.5;
  constexpr double kApart_m = 0.3;
  constexpr int kMostPlaces = 200;
  for (int i = 0; i < kMostPlaces; ++i) {
    const double x_m = random.uniform(low.x() - kAround_m, high.x() + kAround_m);
    const Vector2d at(x_m, random.uniform(low.y() - kAround_m, high.y() + kAround_m));
    const bool apart =
        std::all_of(taken.begin(), taken.end(), [&](const Vector2d& other) { return (other - at).norm() > kApart_m; });
    if (!apart || !is_beside_the_way(scene, mission_objects, at)) continue;
    taken.push_back(at);
    return at;
  }
  return std::nullopt;
}

/// A colour that neither the mission nor the line has.
std::uint8_t strange_colour(const Mission& mission) {
  std::uint8_t colour = msg::kColourGreen;
  while (colour == mission.line_colour || std::count(mission.sequence.begin(), mission.sequence.end(), colour) > 0)
    ++colour;
  return colour;
}

/// Adds strangers and pegs. Returns false if there is no room for them.
bool add_others(const RandomScene& ranges, const Mission& mission, Scenario& scene, Random& random) {
  const std::size_t mission_objects = scene.objects.size();
  std::vector<Vector2d> taken;
  for (int i = 0; i < ranges.strangers; ++i) {
    const auto at = draw_place(scene, mission_objects, taken, random);
    if (!at) return false;
    scene.objects.push_back(draw_object(ranges, strange_colour(mission), random));
    scene.objects.back().position_m = *at;
  }
  for (int i = 0; i < ranges.pegs; ++i) {
    const auto at = draw_place(scene, mission_objects, taken, random);
    if (!at) return false;
    scene.obstacles.push_back({BodyShape::kCylinder, {kPegRadius_m, kPegRadius_m, kPegHeight_m}, *at, 0.0});
  }
  return true;
}

void draw_surroundings(const RandomScene& ranges, Scenario& scene, Random& random) {
  ScenarioFriction& f = scene.friction;
  for (double* coefficient : {&f.ground_scale, &f.object_robot, &f.object_ground, &f.robot_robot})
    *coefficient *= random.factor(ranges.friction);
  const double azimuth_rad = random.uniform(-std::numbers::pi, std::numbers::pi);
  scene.light.direction = Eigen::Vector3d(0.5 * std::cos(azimuth_rad), 0.5 * std::sin(azimuth_rad), 0.85).normalized();
}

}  // namespace

RandomScene read_random_scene(Configuration from) {
  RandomScene scene;
  const auto range = [&](const char* key, Range accepted, Range& value) {
    const std::vector<double> ends = from.numbers(key, accepted, 2, 2, std::vector<double>{value.min, value.max});
    if (ends[0] > ends[1])
      throw from.error(key, fmt::format("found [{:g}, {:g}], accepted the smaller number first", ends[0], ends[1]));
    value = {ends[0], ends[1]};
  };
  range("line_length_m", {1.5, 40.0}, scene.line_length_m);
  range("bend_radius_m", {0.5, 20.0}, scene.bend_radius_m);
  range("bend_rad", {0.05, 3.0}, scene.bend_rad);
  range("object_radius_m", {0.03, 0.2}, scene.object_radius_m);
  range("object_height_m", {0.03, 0.5}, scene.object_height_m);
  range("object_mass_kg", {0.05, 5.0}, scene.object_mass_kg);
  scene.box_share = from.number("box_share", {0.0, 1.0}, scene.box_share);
  range("zone_radius_m", {0.15, 0.6}, scene.zone_radius_m);
  scene.pegs = static_cast<int>(from.integer("pegs", 0, 16, scene.pegs));
  scene.strangers = static_cast<int>(from.integer("strangers", 0, 4, scene.strangers));
  scene.friction = from.number("friction", {0.0, 0.9}, scene.friction);
  from.finish();
  return scene;
}

std::optional<Scenario> make_random_scene(const RandomScene& ranges, const Mission& mission, const Scenario& base,
                                          std::uint64_t seed) {
  constexpr int kMostDraws = 200;
  for (int attempt = 0; attempt < kMostDraws; ++attempt) {
    const auto stream = [&](const char* purpose) {
      return Random(seed + 0x10001ULL * static_cast<std::uint64_t>(attempt), purpose);
    };
    Random layout = stream("random layout");
    Random others = stream("random others");
    Random surroundings = stream("random surroundings");
    Scenario scene = draw_scene(ranges, mission, base, layout);
    scene.seed = seed;
    if (!has_room(scene) || !add_others(ranges, mission, scene, others) || !find_overlap(scene).empty()) continue;
    draw_surroundings(ranges, scene, surroundings);
    return scene;
  }
  return std::nullopt;
}

}  // namespace constrictor
